// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/label_image.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "electrode/structure/image_header.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkLogger.h>
#include <vtkMetaImageReader.h>
#include <vtkMetaImageWriter.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkPointData.h>
#include <vtkStringOutputWindow.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>

namespace calendem {

namespace {

constexpr const char *kVoxelSizeKeys =
    "shapes.voxel_size_um in a recipe, labels_voxel_um in an experiment, --voxel-um to measure";

// What VTK complains about while this lives goes here instead of to the terminal.
class Complaints {
public:
  Complaints() : before_(vtkOutputWindow::GetInstance()) {
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    vtkOutputWindow::SetInstance(window_);
  }
  ~Complaints() {
    vtkOutputWindow::SetInstance(before_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);
  }
  Complaints(const Complaints &) = delete;
  Complaints &operator=(const Complaints &) = delete;
  std::string text() { return window_->GetOutput(); }

private:
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkNew<vtkStringOutputWindow> window_;
};

// The line of VTK's complaint that says something, without its address and class.
std::string gist(std::string text) {
  const size_t colon = text.find("): ");
  if (colon != std::string::npos)
    text = text.substr(colon + 3);
  text = text.substr(0, text.find('\n'));
  return text.empty() ? "it is cut or not of that format" : text;
}

template <class Reader> vtkSmartPointer<vtkImageData> read_with(const std::string &file) {
  Complaints complaints;
  vtkNew<Reader> reader;
  if (!reader->CanReadFile(file.c_str()))
    refuse_image(file,
                 "this is not a file of the format that its ending says, or its header is cut. "
                 "Give the file as the program that segmented it wrote it.");
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  const std::string said = complaints.text();
  if (said.find("ERR") != std::string::npos || said.find("rror") != std::string::npos ||
      reader->GetErrorCode() != 0)
    refuse_image(file,
                 "VTK cannot read it: {}. Give the whole file, and the data file that a header "
                 "names beside it.",
                 gist(said));
  return image;
}

vtkSmartPointer<vtkImageData> read_one(const std::string &file) {
  if (!std::filesystem::is_regular_file(file))
    refuse_image(file, "no such file. Give the path of a label image that exists.");
  const std::string ending = image_ending(file);
  vtkSmartPointer<vtkImageData> image;
  if (ending == ".vti") {
    check_vti(file);
    image = read_with<vtkXMLImageDataReader>(file);
  } else if (ending == ".mhd" || ending == ".mha") {
    check_meta_image(file);
    image = read_with<vtkMetaImageReader>(file);
  } else if (ending == ".nrrd" || ending == ".nhdr") {
    check_nrrd(file);
    image = read_with<vtkNrrdReader>(file);
  } else
    image = ending == ".png"                       ? read_png(file)
            : ending == ".npy" || ending == ".npz" ? read_numpy(file)
                                                   : read_tiff(file);
  if (!image || image->GetNumberOfPoints() == 0 || !image->GetPointData()->GetScalars())
    refuse_image(file,
                 "it holds no voxels. Point data with one whole number per voxel are needed.");
  return image;
}

// One number per voxel as a label; anything but a whole number is refused with its place.
void append_labels(const std::string &file, vtkImageData &image, LabelImage &out) {
  vtkDataArray &values = *image.GetPointData()->GetScalars();
  if (values.GetNumberOfComponents() != 1)
    refuse_image(file,
                 "a voxel has {} numbers (a colour picture?); a label image has one. Export the "
                 "labels, not a rendering.",
                 values.GetNumberOfComponents());
  for (vtkIdType p = 0; p < values.GetNumberOfTuples(); ++p) {
    const double v = values.GetComponent(p, 0);
    if (v != std::floor(v) || std::fabs(v) > 2147483647.0)
      refuse_image(file,
                   "voxel ({}, {}, {}) is {}; a label is a whole number up to 2147483647. Give the "
                   "label image, not grey values.",
                   p % out.n[0], p / out.n[0] % out.n[1], p / out.n[0] / out.n[1] + out.n[2], v);
    out.label.push_back(static_cast<std::int32_t>(v));
  }
}

void append(const std::string &file, LabelImage &out) {
  const vtkSmartPointer<vtkImageData> image = read_one(file);
  int n[3];
  image->GetDimensions(n);
  if (out.n[2] > 0 && (n[0] != out.n[0] || n[1] != out.n[1]))
    refuse_image(file,
                 "this slice has {} x {} voxels, those before it {} x {}. All slices of a series "
                 "must be of one size.",
                 n[0], n[1], out.n[0], out.n[1]);
  out.n[0] = n[0];
  out.n[1] = n[1];
  image->GetSpacing(out.voxel.data());
  append_labels(file, *image, out);
  out.n[2] += n[2];
}

// Sides [um] as the file states them; 0 where it does not. `of_header`: what VTK took.
Eigen::Vector3d stated_voxel(const std::string &file, const Eigen::Vector3d &of_header) {
  const bool series = files_of_series(file) != std::vector<std::string>{file};
  if (series || !is_tiff(file))
    return double(!series && states_voxel_size(file)) * of_header.cwiseAbs();
  const std::array<double, 3> v = voxel_size_of_tiff(file);
  return {v[0], v[1], v[2]};
}

std::string in_words(const Eigen::Vector3d &voxel) {
  return fmt::format("{:.4g} x {:.4g} x {:.4g} um", voxel[0], voxel[1], voxel[2]);
}

void set_voxel_size(const std::string &file, double voxel_um, LabelImage &image) {
  const Eigen::Vector3d stated = stated_voxel(file, image.voxel);
  const bool known = stated.minCoeff() > 0.0;
  std::string missing;
  for (int axis = 0; axis < 3 && stated.maxCoeff() > 0.0; ++axis)
    if (stated[axis] == 0.0)
      missing += fmt::format("{}{}", missing.empty() ? " along " : ", ", "xyz"[axis]);
  if (voxel_um <= 0.0 && !known)
    refuse_image(file, "the file states no voxel size{}. Give {}.", missing, kVoxelSizeKeys);
  image.voxel = voxel_um > 0.0 ? Eigen::Vector3d::Constant(voxel_um) : stated;
  if (image.voxel.minCoeff() < 1e-3 || image.voxel.maxCoeff() > 10.0)
    refuse_image(file,
                 "a voxel is {} by its header; allowed is 0.001 to 10 um. If the header is in mm "
                 "or m, give {}.",
                 in_words(image.voxel), kVoxelSizeKeys);
  if (voxel_um <= 0.0)
    fmt::print(
        stderr, "note: {}: voxels of {} by its header{}\n", file, in_words(stated),
        stated != Eigen::Vector3d::Ones()
            ? "."
            : fmt::format(". Some programs write that when they do not know: if so, give {}.",
                          kVoxelSizeKeys));
  else if (known && (stated - image.voxel).cwiseAbs().maxCoeff() > 0.01 * voxel_um)
    fmt::print(stderr,
               "note: {}: its header says voxels of {}; those of {:g} um are taken, as told.\n",
               file, in_words(stated), voxel_um);
}

// Images of phases have few labels; their shares show which is which.
void print_phases(const LabelImage &image) {
  constexpr size_t kMost = 4;
  std::map<std::int32_t, size_t> count;
  for (const std::int32_t label : image.label)
    if (++count[label]; count.size() > kMost)
      return;
  std::string shares;
  for (const auto &[label, voxels] : count)
    shares += fmt::format("{}{} ({:.1f} %)", shares.empty() ? "" : ", ", label,
                          100.0 * double(voxels) / double(image.label.size()));
  fmt::print(stderr, "note: {}: {}: labels {}.\n", image.file,
             count.size() == 2 ? "a binary image" : "few labels, as of phases", shares);
}

template <class Writer> bool write_with(vtkImageData *data, const std::string &file) {
  Complaints complaints;
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  writer->Write();
  return writer->GetErrorCode() == 0;
}

vtkSmartPointer<vtkImageData> image_of(const LabelImage &image) {
  const auto data = vtkSmartPointer<vtkImageData>::New();
  data->SetDimensions(image.n.data());
  data->SetSpacing(image.voxel.data());
  vtkNew<vtkIntArray> values;
  values->SetName("label");
  values->SetArray(const_cast<int *>(image.label.data()), vtkIdType(image.label.size()), 1);
  data->GetPointData()->SetScalars(values);
  return data;
}

/// VTK's writers do not always say that the disk was full.
bool write_whole(const LabelImage &image, const std::string &file) {
  if (is_tiff(file))
    return write_tiff(image, file);
  if (image_ending(file) == ".vti")
    return write_with<vtkXMLImageDataWriter>(image_of(image), file) &&
           ends_with(file, "</VTKFile>");
  try {
    const bool written = write_with<vtkMetaImageWriter>(image_of(image), file);
    check_meta_image(file);
    return written;
  } catch (const Failure &) {
    return false;
  }
}

/// Header and data are written in a folder of their own and take their place when they are whole.
void write_in_place(const LabelImage &image, const std::string &file) {
  namespace fs = std::filesystem;
  const fs::path place = place_of(file), folder = part_of(place.string());
  const std::string header = folder / place.filename();
  std::error_code error, none;
  fs::create_directory(folder, error);
  const bool whole = !error && write_whole(image, header);
  if (whole)
    for (const std::string &part : {data_file_of(header), header})
      if (!part.empty() && !error)
        fs::rename(part, place.parent_path() / fs::path(part).filename(), error);
  fs::remove_all(folder, none);
  if (!whole || error)
    refuse_image(file, "cannot be written. Check the folder, its rights and the disk. What was "
                       "there before is kept.");
}

} // namespace

LabelImage read_label_image(const std::string &file, double voxel_um) {
  if (!is_readable_image(file))
    refuse_image(file,
                 "label images with the ending '{}' are not read; allowed are {}. Convert it.",
                 image_ending(file), readable_images());
  LabelImage image;
  image.file = file;
  for (const std::string &slice : files_of_series(file))
    append(slice, image);
  set_voxel_size(file, voxel_um, image);
  print_phases(image);
  return image;
}

LabelImage turned(const LabelImage &image, const std::string &upwards) {
  const int up = upwards.back() - 'x';
  const bool down = upwards.front() == '-'; // half a turn about the new x
  const std::array<int, 3> from = {(up + 1) % 3, (up + 2) % 3, up};
  LabelImage out = image;
  for (int axis = 0; axis < 3; ++axis) {
    out.n[axis] = image.n[from[axis]];
    out.voxel[axis] = image.voxel[from[axis]];
  }
  for (int k = 0; k < out.n[2]; ++k)
    for (int j = 0; j < out.n[1]; ++j)
      for (int i = 0; i < out.n[0]; ++i) {
        std::array<int, 3> at;
        at[from[0]] = i;
        at[from[1]] = down ? out.n[1] - 1 - j : j;
        at[from[2]] = down ? out.n[2] - 1 - k : k;
        out.label[out.index(i, j, k)] = image.at(at[0], at[1], at[2]);
      }
  return out;
}

void refuse_negative_labels(const LabelImage &image,
                            const std::vector<std::optional<std::int32_t>> &known) {
  for (size_t v = 0; v < image.label.size(); ++v)
    if (const std::int32_t label = image.label[v];
        label < 0 && std::find(known.begin(), known.end(), label) == known.end())
      refuse_image(image.file,
                   "voxel ({}, {}, {}) has the label {}; a particle's is above 0. Name it if it is "
                   "the background's or CBD's (shapes.background, labels_pore, labels_cbd, "
                   "--background, --cbd-label), or save the labels as unsigned numbers.",
                   v % size_t(image.n[0]), v / size_t(image.n[0]) % size_t(image.n[1]),
                   v / size_t(image.n[0]) / size_t(image.n[1]), label);
}

void write_label_image(const LabelImage &image, const std::string &file) {
  const std::string ending = image_ending(file);
  if (ending != ".vti" && ending != ".mhd" && ending != ".mha" && !is_tiff(file))
    refuse_image(file, "'{}' is not written; give a name that ends in .mhd, .mha, .vti or .tif.",
                 ending);
  write_in_place(image, file);
}

namespace fs = std::filesystem;
namespace {

const char *const kEndings[] = {".vti", ".mhd",  ".mha", ".nrrd", ".nhdr",
                                ".tif", ".tiff", ".png", ".npy",  ".npz"};

} // namespace

std::string readable_images() { return fmt::format("{}", fmt::join(kEndings, " ")); }

bool is_readable_image(const std::string &file) {
  const std::string ending = image_ending(file);
  return std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings);
}

std::string data_file_of(const std::string &header) {
  const std::string ending = image_ending(header);
  const bool meta = ending == ".mhd" || ending == ".mha";
  if (!meta && ending != ".nrrd" && ending != ".nhdr")
    return "";
  const ImageHeader h(header, meta ? "=" : ": ");
  const std::string name = meta                ? h.text("ElementDataFile")
                           : h.has("datafile") ? h.text("datafile")
                                               : h.text("data file");
  if (name.empty() || (meta && name == "LOCAL"))
    return "";
  if (name.find('%') != std::string::npos || name.rfind("LIST", 0) == 0)
    refuse_image(header,
                 "the voxels are spread over several files ('{}'), which is not read. Save them to "
                 "one file.",
                 name.substr(0, 60));
  const fs::path data = fs::path(header).parent_path() / name;
  std::error_code none;
  if (!fs::is_regular_file(data, none))
    refuse_image(header,
                 "the data file '{}' that the header names is not there. Put it beside the header.",
                 name.substr(0, 200));
  return data.string();
}

std::string hash_of_image(const std::string &file) {
  std::string text;
  for (const std::string &slice : files_of_series(file))
    text += hash_of_file(slice);
  const std::string data = data_file_of(file);
  return hash_of_text(text + (data.empty() ? "" : hash_of_file(data)));
}

} // namespace calendem
