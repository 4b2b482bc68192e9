// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/image_header.h"
#include "base/messages.h"
#include "electrode/structure/label_image.h"
#include "electrode/structure/particle_data.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <regex>
#include <vector>
#include <vtk_zlib.h>

namespace calendem {

namespace {

std::string trimmed(const std::string &text) {
  const size_t from = text.find_first_not_of(" \t\r"), to = text.find_last_not_of(" \t\r");
  return from == std::string::npos ? "" : text.substr(from, to - from + 1);
}

} // namespace

void refuse_image(const std::string &file, const std::string &what) {
  throw Failure(kBadInput, "{}: {}", file, what);
}

ImageHeader::ImageHeader(const std::string &file, const std::string &separator)
    : file_(file), separator_(separator) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    bytes_ += long(line.size()) + 1;
    if (in.eof() || line.size() > 1000 || line.find('\0') != std::string::npos)
      break;
    if (!line.empty() && line.back() == '\r')
      line.pop_back();
    if (take(number, line))
      return;
  }
  if (!in.eof() || !line.empty() || !has("data file"))
    refuse_image(file,
                 "its header does not end: it is cut or of another format. Give the file as the "
                 "program that segmented it wrote it.");
}

// True for the last line.
bool ImageHeader::take(int number, const std::string &line) {
  const bool nrrd = separator_ != "=";
  if (nrrd && (number == 1 || line.empty() || line[0] == '#'))
    return number > 1 && line.empty();
  if (nrrd && line.find(":=") != std::string::npos)
    return false;
  const size_t at = line.find(separator_);
  const std::string name = trimmed(line.substr(0, at));
  if (at == std::string::npos || name.empty() || name.find_first_of(":=") != std::string::npos)
    refuse_image(file_,
                 "line {} of the header is not 'name{} value': '{}'; it is damaged or of another "
                 "format. Give the file as the program that segmented it wrote it.",
                 number, separator_ == "=" ? " =" : ":", line.substr(0, 60));
  if (!fields_.emplace(name, trimmed(line.substr(at + separator_.size()))).second)
    refuse_image(file_, "line {}: '{}' occurs twice in the header. Save the image again.", number,
                 name);
  return name == "ElementDataFile";
}

std::string ImageHeader::text(const std::string &name) const {
  const auto at = fields_.find(name);
  return at == fields_.end() ? "" : at->second;
}

std::array<long, 3> ImageHeader::axes(const std::string &name) const {
  const std::vector<std::string> words = words_of(text(name));
  std::array<long, 3> n = {0, 0, 0};
  for (size_t k = 0; k < 3 && words.size() == 3; ++k)
    n[k] = whole_number_in(words[k]).value_or(0);
  return n;
}

long ImageHeader::type_size(const std::string &name, const std::vector<Type> &types) const {
  for (const Type &t : types)
    if (std::regex_match(text(name), std::regex(t.names)))
      return t.bytes;
  refuse_image(file_,
               "the header's '{}' is '{}', which is not read. Save the labels as whole numbers of "
               "1, 2 or 4 bytes.",
               name, text(name).substr(0, 60));
}

void ImageHeader::check_numbers(const std::string &name, size_t wanted) const {
  const std::vector<std::string> words = words_of(text(name));
  const auto finite = [](const std::string &w) {
    return std::isfinite(number_in(w).value_or(NAN));
  };
  if (has(name) && (words.size() != wanted || !std::all_of(words.begin(), words.end(), finite)))
    refuse_image(file_, "the header's '{}' is '{}'; it must be {} numbers. Save the image again.",
                 name, text(name).substr(0, 60), wanted);
}

void ImageHeader::check_is(const std::string &name, const std::vector<std::string> &allowed) const {
  if (has(name) && std::find(allowed.begin(), allowed.end(), text(name)) == allowed.end())
    refuse_image(file_, "the header's '{}' is '{}'; allowed is {}. Save the image again.", name,
                 text(name).substr(0, 60), fmt::join(allowed, " or "));
}

void ImageHeader::need(const std::string &name) const {
  if (!has(name))
    refuse_image(file_,
                 "the header has no '{}': it is cut or of another format. Save the image again.",
                 name);
}

void check_axes(const std::string &file, const std::array<long, 3> &n, long bytes,
                double most_per_byte) {
  const double voxels = double(n[0]) * double(n[1]) * double(n[2]);
  if (std::min({n[0], n[1], n[2]}) < 1 || voxels > double(kMostVoxels))
    refuse_image(file,
                 "the header announces {} x {} x {} voxels; three whole numbers from 1 are needed, "
                 "at most {} voxels in all. Save the image again, or a part of it.",
                 n[0], n[1], n[2], kMostVoxels);
  if (voxels > most_per_byte * double(bytes))
    refuse_image(file,
                 "the header announces {} x {} x {} voxels, more than {} bytes of data can hold: "
                 "the file is cut. Copy it again.",
                 n[0], n[1], n[2], bytes);
}

void check_length(const std::string &file, double announced, long there) {
  if (announced > double(there))
    refuse_image(file,
                 "the header announces {:.0f} bytes of voxels, {} are there: the file is cut. Copy "
                 "it again.",
                 announced, std::max(there, 0L));
}

// Headers of MetaImage and NRRD files, as VTK's readers use them (vtkNrrdReader, MetaIO).

namespace fs = std::filesystem;
namespace {

// Not MET_LONG: VTK 9.1 reads every other voxel of it. Not MET_LONG_LONG: it writes past its
// memory.
const std::vector<ImageHeader::Type> kMetaTypes = {
    {"MET_U?CHAR", 1}, {"MET_U?SHORT", 2}, {"MET_U?INT|MET_FLOAT", 4}, {"MET_DOUBLE", 8}};
const std::vector<ImageHeader::Type> kNrrdTypes = {
    {"(signed |unsigned |u)?char|u?int8(_t)?", 1},
    {"(signed |unsigned |u)?short( int)?|u?int16(_t)?", 2},
    {"(signed |unsigned |u)?int|u?int32(_t)?|float", 4},
    {"(signed |unsigned |u)?long ?long( int)?|u?int64(_t)?|double", 8}};

double count(const std::array<long, 3> &n) { return double(n[0]) * double(n[1]) * double(n[2]); }

// Bytes of voxels in the file, or in the one beside it.
long bytes_there(const std::string &file, const ImageHeader &h) {
  const std::string data = data_file_of(file);
  return data.empty() ? std::max(0L, long(fs::file_size(file)) - h.bytes())
                      : long(fs::file_size(data));
}

// A compressed stream of exactly as many bytes as the voxels take.
void check_packed(const std::string &file, const ImageHeader &h, double wanted, long there) {
  h.check_numbers("CompressedDataSize", 1);
  const double stated = h.has("CompressedDataSize") ? std::stod(h.text("CompressedDataSize")) : 0.0;
  check_length(file, stated, there);
  const std::string data = data_file_of(file);
  const long unpacked =
      data.empty()
          ? unpacked_bytes(file, h.bytes(), stated > 0.0 ? long(stated) : there, long(wanted))
          : unpacked_bytes(data, 0, stated > 0.0 ? long(stated) : there, long(wanted));
  if (double(unpacked) != wanted)
    refuse_image(file,
                 "the compressed voxels do not unpack to the {:.0f} bytes that the header "
                 "announces: the file is cut or damaged. Copy it again.",
                 wanted);
}

} // namespace

void check_meta_image(const std::string &file) {
  const ImageHeader h(file, "=");
  h.need("NDims");
  h.check_is("NDims", {"3"});
  h.check_is("ObjectType", {"Image"});
  h.check_is("ElementNumberOfChannels", {"1"});
  h.check_is("HeaderSize", {"0", "-1"});
  for (const char *flag :
       {"BinaryData", "CompressedData", "BinaryDataByteOrderMSB", "ElementByteOrderMSB"})
    h.check_is(flag, {"True", "False"});
  for (const char *name :
       {"ElementSpacing", "ElementSize", "Offset", "Position", "Origin", "CenterOfRotation"})
    h.check_numbers(name, 3);
  for (const char *name : {"TransformMatrix", "Rotation", "Orientation"})
    h.check_numbers(name, 9);
  const long size = h.type_size("ElementType", kMetaTypes), there = bytes_there(file, h);
  const std::array<long, 3> n = h.axes("DimSize");
  const bool packed = h.text("CompressedData") == "True";
  check_axes(file, n, there, packed ? kDeflate / double(size) : kAnyNumber);
  if (packed)
    check_packed(file, h, count(n) * double(size), there);
  if (!packed) // as text a digit and a blank each
    check_length(file,
                 h.text("BinaryData") == "False" ? 2.0 * count(n) - 1.0 : count(n) * double(size),
                 there);
}

void check_nrrd(const std::string &file) {
  const ImageHeader h(file, ": ");
  const std::string encoding = h.text("encoding");
  if (encoding == "ascii" || encoding == "text" || encoding == "txt" || encoding == "ASCII")
    refuse_image(file,
                 "encoding: {} is not read, because VTK's reader takes wrong numbers from it; "
                 "allowed are raw and gzip. Save it again (unu save -e gzip).",
                 encoding);
  h.need("encoding");
  h.need("dimension");
  h.check_is("encoding", {"raw", "gzip", "gz"});
  h.check_is("dimension", {"3"});
  h.check_is("space dimension", {"3"});
  h.check_is("endian", {"little", "big"});
  for (const char *skip : {"line skip", "lineskip", "byte skip", "byteskip"})
    h.check_is(skip, {"0"});
  h.check_numbers("spacings", 3);
  const long size = h.type_size("type", kNrrdTypes), there = bytes_there(file, h);
  const std::array<long, 3> n = h.axes("sizes");
  check_axes(file, n, there, encoding == "raw" ? kAnyNumber : kDeflate / double(size));
  if (n[0] < 10)
    refuse_image(file,
                 "the first axis has {} voxels; VTK takes fewer than 10 for colours. Save the "
                 "image with an empty border, or as .mhd.",
                 n[0]);
  if (encoding == "raw")
    check_length(file, count(n) * double(size), there);
}

bool states_voxel_size(const std::string &file) {
  const std::string ending = image_ending(file);
  if (ending == ".vti")
    return states_voxel_size_of_vti(file);
  const bool meta = ending == ".mhd" || ending == ".mha";
  if (!meta && ending != ".nrrd" && ending != ".nhdr")
    return false;
  const ImageHeader h(file, meta ? "=" : ": ");
  return meta ? h.has("ElementSpacing") || h.has("ElementSize")
              : h.has("spacings") || h.has("space directions");
}

long unpacked_bytes(const std::string &file, long offset, long length, long most) {
  constexpr int kAnyHeader = 47; // zlib's or gzip's, the largest window
  std::vector<char> in(1 << 16), out(1 << 18);
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(offset);
  z_stream z{};
  if (inflateInit2(&z, kAnyHeader) != Z_OK)
    return -1;
  long total = 0;
  int state = Z_OK;
  while (state == Z_OK && total <= most) {
    if (z.avail_in == 0) {
      stream.read(in.data(), std::min(long(in.size()), length));
      length -= long(stream.gcount());
      z.next_in = reinterpret_cast<Bytef *>(in.data());
      z.avail_in = static_cast<uInt>(stream.gcount());
    }
    z.next_out = reinterpret_cast<Bytef *>(out.data());
    z.avail_out = static_cast<uInt>(out.size());
    state = inflate(&z, Z_NO_FLUSH); // Z_BUF_ERROR once there is nothing left to read
    total += long(out.size()) - long(z.avail_out);
  }
  inflateEnd(&z);
  return state == Z_STREAM_END || total > most ? total : -1;
}

} // namespace calendem
