// SPDX-License-Identifier: GPL-2.0-or-later
// The elements of a .vti file that say how large the image is.
#include "electrode/structure/image_header.h"
#include "electrode/structure/particle_data.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

namespace calendem {

namespace {

using Extent = std::array<long, 6>;

// The first element of that name up to its '>', from `at` on; empty if there is none.
std::string element(const std::string &text, const std::string &name, size_t at = 0) {
  const size_t from = text.find("<" + name, at);
  return from == std::string::npos ? "" : text.substr(from, text.find('>', from) - from);
}

// The attribute's value; nothing if it is not there.
std::optional<std::string> attribute(const std::string &element, const std::string &name) {
  const size_t at = element.find(" " + name + "=\"");
  if (at == std::string::npos)
    return std::nullopt;
  const size_t from = at + name.size() + 3;
  return element.substr(from, element.find('"', from) - from);
}

Extent extent_of(const std::string &file, const std::string &element, const std::string &name) {
  const std::vector<std::string> words = words_of(attribute(element, name).value_or(""));
  Extent e{};
  bool good = words.size() == 6;
  for (size_t k = 0; good && k < 6; ++k) {
    e[k] = whole_number_in(words[k]).value_or(kMostVoxels + 1);
    good = std::abs(e[k]) <= kMostVoxels;
  }
  if (!good)
    refuse_image(file,
                 "its header has no {}=\"...\" of six whole numbers: it is cut or not a .vti file. "
                 "Save the image again.",
                 name);
  return e;
}

// The first three numbers of packed data: blocks, bytes of a block, bytes of the last one. As text
// four letters are three bytes, and VTK puts no blank in between.
std::array<double, 3> block_header(const std::string &data, bool base64, size_t width, bool big) {
  std::string bytes = data.substr(0, 3 * width);
  if (base64) {
    static const std::string kLetters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    bytes.clear();
    unsigned bits = 0;
    for (size_t k = 0; k < std::min(data.size(), 4 * width); ++k) {
      bits = bits << 6 | unsigned(kLetters.find(data[k]) & 63);
      if (k % 4 == 3)
        for (int shift : {16, 8, 0})
          bytes += char(bits >> shift & 255);
    }
  }
  std::array<double, 3> out = {0.0, 0.0, 0.0};
  for (size_t k = 0; k < 3 && bytes.size() >= 3 * width; ++k)
    for (size_t b = 0; b < width; ++b)
      out[k] =
          256.0 * out[k] + static_cast<unsigned char>(bytes[k * width + (big ? b : width - 1 - b)]);
  return out;
}

// VTK makes room for as many blocks and bytes as the packed data say.
void check_blocks(const std::string &file, const std::string &data, const std::string &head,
                  const std::string &encoding, double voxels) {
  const bool wide = attribute(head, "header_type").value_or("UInt32") == "UInt64";
  const bool big = attribute(head, "byte_order").value_or("LittleEndian") == "BigEndian";
  const std::array<double, 3> h = block_header(data, encoding != "raw", wide ? 8 : 4, big);
  const double bytes = (h[0] - 1.0) * h[1] + std::max(h[1], h[2]);
  if (h[0] > double(std::filesystem::file_size(file)) ||
      (h[0] > 0.0 && bytes > 8.0 * voxels + h[1]) || h[1] > 8.0 * std::max(voxels, 1e6) ||
      h[2] > h[1])
    refuse_image(file,
                 "its packed data announce {:.0f} blocks of {:.0f} bytes for {:.0f} voxels: the "
                 "file is damaged. Copy it again.",
                 h[0], h[1], voxels);
}

// The data of one array: behind its element, or where the appended data begin and the offset says.
void check_array(const std::string &file, const std::string &text, size_t at, double voxels) {
  const std::string array = element(text, "DataArray", at), head = element(text, "VTKFile");
  if (const auto n = attribute(array, "NumberOfComponents"); n && *n != "1")
    refuse_image(file,
                 "an array has {} numbers per voxel; a label image has one. Export the labels, not "
                 "a rendering.",
                 n->substr(0, 20));
  if (attribute(array, "NumberOfTuples"))
    refuse_image(
        file, "an array of an image states NumberOfTuples: it is not a .vti file. Save it again.");
  const std::string format = attribute(array, "format").value_or("ascii");
  if (!attribute(head, "compressor") || format == "ascii")
    return;
  size_t from = at + array.size() + 1;
  std::string encoding = "base64";
  if (format == "appended") {
    const size_t appended = text.find("<AppendedData");
    const long offset = whole_number_in(attribute(array, "offset").value_or("")).value_or(-1);
    if (appended == std::string::npos || offset < 0)
      refuse_image(file, "an array's data are not where it says: the file is cut. Copy it again.");
    encoding = attribute(element(text, "AppendedData"), "encoding").value_or("base64");
    from = text.find('_', text.find('>', appended)) + 1 + size_t(offset);
  } else
    from = text.find_first_not_of(" \t\r\n", from);
  if (from < text.size()) // else beyond what is looked at
    check_blocks(file, text.substr(from, 64), head, encoding, voxels);
}

std::string beginning_of(const std::string &file) {
  constexpr long kLook = 1 << 20; // header and, in most files, all elements
  std::string text(kLook, ' ');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), kLook);
  text.resize(size_t(in.gcount()));
  return text;
}

} // namespace

bool states_voxel_size_of_vti(const std::string &file) {
  return attribute(element(beginning_of(file), "ImageData"), "Spacing").has_value();
}

void check_vti(const std::string &file) {
  constexpr double kPacked = 10000.0; // voxels that the best packing has put into a byte
  const std::string text = beginning_of(file);
  const std::string image = element(text, "ImageData");
  const Extent whole = extent_of(file, image, "WholeExtent");
  check_axes(file, {whole[1] - whole[0] + 1, whole[3] - whole[2] + 1, whole[5] - whole[4] + 1},
             long(std::filesystem::file_size(file)), kPacked);
  size_t pieces = 0;
  for (size_t at = 0; (at = text.find("<Piece", at)) != std::string::npos; ++at, ++pieces)
    if (extent_of(file, element(text, "Piece", at), "Extent") != whole)
      refuse_image(
          file,
          "it comes in pieces; a label image must be in one. Save it again as one .vti file.");
  if (pieces != 1)
    refuse_image(file, "it has {} pieces; a label image has one. Save it again.", pieces);
  const double voxels = double(whole[1] - whole[0] + 1) * double(whole[3] - whole[2] + 1) *
                        double(whole[5] - whole[4] + 1);
  for (size_t at = 0; (at = text.find("<DataArray", at)) != std::string::npos; ++at)
    check_array(file, text, at, voxels);
}

} // namespace calendem
