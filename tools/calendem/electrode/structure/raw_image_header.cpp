// SPDX-License-Identifier: GPL-2.0-or-later
// Headers of MetaImage and NRRD files, as VTK's readers use them (vtkNrrdReader, MetaIO).
#include "electrode/structure/image_files.h"
#include "electrode/structure/image_header.h"
#include "electrode/structure/packed_data.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

// Not MET_LONG: VTK 9.1 reads every other voxel of it. Not MET_LONG_LONG: it writes past its
// memory.
const std::vector<ImageHeader::Type> kMetaTypes = {
    {"MET_CHAR", 1}, {"MET_UCHAR", 1}, {"MET_SHORT", 2}, {"MET_USHORT", 2},
    {"MET_INT", 4},  {"MET_UINT", 4},  {"MET_FLOAT", 4}, {"MET_DOUBLE", 8}};
const std::vector<ImageHeader::Type> kNrrdTypes = {{"signed char", 1},   {"int8", 1},
                                                   {"int8_t", 1},        {"uchar", 1},
                                                   {"unsigned char", 1}, {"uint8", 1},
                                                   {"uint8_t", 1},       {"short", 2},
                                                   {"short int", 2},     {"signed short", 2},
                                                   {"int16", 2},         {"int16_t", 2},
                                                   {"ushort", 2},        {"unsigned short", 2},
                                                   {"uint16", 2},        {"uint16_t", 2},
                                                   {"int", 4},           {"signed int", 4},
                                                   {"int32", 4},         {"int32_t", 4},
                                                   {"uint", 4},          {"unsigned int", 4},
                                                   {"uint32", 4},        {"uint32_t", 4},
                                                   {"float", 4},         {"double", 8},
                                                   {"longlong", 8},      {"long long", 8},
                                                   {"long long int", 8}, {"signed long long", 8},
                                                   {"int64", 8},         {"int64_t", 8},
                                                   {"ulonglong", 8},     {"unsigned long long", 8},
                                                   {"uint64", 8},        {"uint64_t", 8}};

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
                 fmt::format("the compressed voxels do not unpack to the {:.0f} bytes that the "
                             "header announces: the file is cut or damaged. Copy it again.",
                             wanted));
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
                 fmt::format("encoding: {} is not read, because VTK's reader takes wrong numbers "
                             "from it; allowed are raw and gzip. Save it anew (unu save -e gzip).",
                             encoding));
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
                 fmt::format("the first axis has {} voxels; VTK takes one below 10 for colours. "
                             "Save the image with an empty border, or as .mhd.",
                             n[0]));
  if (encoding == "raw")
    check_length(file, count(n) * double(size), there);
}

} // namespace calendem
