// SPDX-License-Identifier: GPL-2.0-or-later
// The .npy format of NumPy (numpy.lib.format): magic, version, length of the header, the header as a
// Python dictionary, the numbers. A .npz file is a ZIP archive of them, read by minizip.
#include "base/provenance.h"
#include "electrode/structure/image_header.h"
#include "electrode/structure/particle_data.h"
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <minizip/unzip.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

namespace calendem {

namespace {

struct NpyHeader {
  std::string type;      ///< as "<u2"
  bool fortran = false;  ///< the first axis runs fastest
  std::array<long, 3> n; ///< z, y, x
  size_t length;         ///< of the header: where the numbers begin
};

// What stands in the dictionary behind 'name': up to the comma, or the bracket that closes it.
std::string entry(const std::string &dictionary, const std::string &name) {
  size_t at = dictionary.find("'" + name + "':");
  if (at == std::string::npos)
    return "";
  at = dictionary.find_first_not_of(' ', at + name.size() + 3);
  if (at == std::string::npos)
    return "";
  const size_t end = dictionary.find_first_of(dictionary[at] == '(' ? ")" : ",}", at);
  return dictionary.substr(at, end - at);
}

std::array<long, 3> axes_of(const std::string &file, const std::string &shape) {
  std::string numbers = shape;
  std::replace(numbers.begin(), numbers.end(), '(', ' ');
  std::replace(numbers.begin(), numbers.end(), ',', ' ');
  const std::vector<std::string> words = words_of(numbers);
  if (words.size() != 3)
    refuse_image(file,
                 "the array's shape is {}); a label image has three axes (z, y, x). Save one image "
                 "without channels.",
                 shape.substr(0, 60));
  return {whole_number_in(words[0]).value_or(0), whole_number_in(words[1]).value_or(0),
          whole_number_in(words[2]).value_or(0)};
}

NpyHeader header_of(const std::string &file, const std::string &bytes) {
  const auto byte = [&](size_t k) { return size_t(static_cast<unsigned char>(bytes[k])); };
  if (bytes.size() < 12 || bytes.compare(0, 6, "\x93NUMPY") != 0)
    refuse_image(file, "this is not an array of NumPy, or it is cut. Save it with numpy.save.");
  NpyHeader h;
  const bool first = byte(6) == 1; // version
  h.length = (first ? 10 : 12) + byte(8) + (byte(9) << 8) +
             (first ? 0 : (byte(10) << 16) + (byte(11) << 24));
  if (h.length > bytes.size())
    refuse_image(file, "its header does not end: the file is cut. Copy it again.");
  const std::string dictionary = bytes.substr(10, h.length - 10);
  h.fortran = entry(dictionary, "fortran_order") == "True";
  h.n = axes_of(file, entry(dictionary, "shape"));
  h.type = entry(dictionary, "descr");
  h.type.erase(std::remove(h.type.begin(), h.type.end(), '\''), h.type.end());
  return h;
}

// VTK's type, and how many bytes; 0 where a label is none of that type.
std::pair<int, int> type_of(const std::string &name) {
  static const std::pair<const char *, int> kTypes[] = {
      {"b1", VTK_UNSIGNED_CHAR}, {"u1", VTK_UNSIGNED_CHAR},
      {"i1", VTK_SIGNED_CHAR},   {"u2", VTK_UNSIGNED_SHORT},
      {"i2", VTK_SHORT},         {"u4", VTK_UNSIGNED_INT},
      {"i4", VTK_INT},           {"u8", VTK_UNSIGNED_LONG_LONG},
      {"i8", VTK_LONG_LONG},     {"f4", VTK_FLOAT},
      {"f8", VTK_DOUBLE}};
  for (const auto &[known, type] : kTypes)
    if (name.size() == 3 && name.substr(1) == known)
      return {type, known[1] - '0'};
  return {VTK_VOID, 0};
}

vtkSmartPointer<vtkImageData> image_of_npy(const std::string &file, const std::string &bytes) {
  const NpyHeader h = header_of(file, bytes);
  const auto [type, size] = type_of(h.type);
  if (size == 0)
    refuse_image(file,
                 "its numbers are of type '{}', which is not read. Save whole numbers "
                 "(labels.astype(\"uint16\")).",
                 h.type.substr(0, 40));
  check_axes(file, h.n, long(bytes.size()));
  const size_t voxels = size_t(h.n[0]) * size_t(h.n[1]) * size_t(h.n[2]);
  check_length(file, double(voxels) * size, long(bytes.size() - h.length));
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(int(h.n[2]), int(h.n[1]), int(h.n[0]));
  image->AllocateScalars(type, 1);
  char *to = static_cast<char *>(image->GetScalarPointer());
  const char *const from = bytes.data() + h.length;
  for (long z = 0, v = 0; z < h.n[0]; ++z)
    for (long y = 0; y < h.n[1]; ++y)
      for (long x = 0; x < h.n[2]; ++x, ++v, to += size) {
        const long at = h.fortran ? (x * h.n[1] + y) * h.n[0] + z : v;
        std::memcpy(to, from + at * size, size_t(size));
        if (h.type[0] == '>')
          std::reverse(to, to + size);
      }
  return image;
}

// The only array of the archive.
std::string unpacked_array(const std::string &file) {
  const std::unique_ptr<void, int (*)(void *)> zip(unzOpen64(file.c_str()), unzClose);
  unz_global_info64 all{};
  unz_file_info64 info{};
  if (!zip || unzGetGlobalInfo64(zip.get(), &all) != UNZ_OK ||
      unzGoToFirstFile(zip.get()) != UNZ_OK)
    refuse_image(file, "this is not a .npz file, or it is cut. Save it with "
                       "numpy.savez_compressed.");
  if (all.number_entry != 1)
    refuse_image(file, "it holds {} arrays; a label image is one. Save it alone.",
                 all.number_entry);
  std::string out;
  bool whole =
      unzGetCurrentFileInfo64(zip.get(), &info, nullptr, 0, nullptr, 0, nullptr, 0) == UNZ_OK;
  const double packed = double(std::filesystem::file_size(file));
  whole = whole && double(info.uncompressed_size) <= kDeflate * packed &&
          unzOpenCurrentFile(zip.get()) == UNZ_OK;
  if (whole) {
    std::vector<char> part(1 << 20);
    int read = 0;
    while ((read = unzReadCurrentFile(zip.get(), part.data(), unsigned(part.size()))) > 0 &&
           out.size() <= info.uncompressed_size)
      out.append(part.data(), size_t(read));
    whole = read == 0 && unzCloseCurrentFile(zip.get()) == UNZ_OK; // its checksum
  }
  if (!whole)
    refuse_image(file, "its array does not unpack: the file is cut or damaged. Copy it again.");
  return out;
}

} // namespace

vtkSmartPointer<vtkImageData> read_numpy(const std::string &file) {
  const bool packed = std::filesystem::path(file).extension() == ".npz";
  return image_of_npy(file, packed ? unpacked_array(file) : text_of_file(file));
}

} // namespace calendem
