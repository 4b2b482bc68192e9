// SPDX-License-Identifier: GPL-2.0-or-later
// Walks the directories of a TIFF file (TIFF 6.0, section 2; BigTIFF) to see whether it is whole
// and holds pages of labels of one size.
#include "electrode/structure/data_rows.h"
#include "electrode/structure/image_header.h"
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace calendem {

namespace {

using std::uint64_t;

struct Page {
  uint64_t width = 0, height = 0, bits = 1, samples = 1;
  uint64_t strip_rows = 4294967295, tile_width = 0, tile_height = 0; ///< no tiles: 0

  /// Strips or tiles that the page must have.
  uint64_t parts() const {
    const auto steps = [](uint64_t n, uint64_t step) { return step ? (n + step - 1) / step : 0; };
    return tile_width ? steps(width, tile_width) * steps(height, tile_height)
                      : steps(height, strip_rows);
  }
};

// Tags of one number for one sample per voxel: libtiff divides by some that it could not read.
struct SingleTag {
  uint64_t tag, most;
  uint64_t Page::*member;
};
constexpr uint64_t kAny = 4294967295;
constexpr SingleTag kSingleTags[] = {{277, 65535, &Page::samples},
                                     {256, kAny, &Page::width},
                                     {257, kAny, &Page::height},
                                     {258, 64, &Page::bits},
                                     {259, 65535, nullptr},
                                     {262, 65535, nullptr},
                                     {266, 2, nullptr},
                                     {274, 8, nullptr},
                                     {278, kAny, &Page::strip_rows},
                                     {284, 2, nullptr},
                                     {317, 3, nullptr},
                                     {322, kAny, &Page::tile_width},
                                     {323, kAny, &Page::tile_height},
                                     {339, 3, nullptr}};

class Walk {
public:
  explicit Walk(const std::string &file)
      : in_(file, std::ios::binary), bytes_(std::filesystem::file_size(file)) {
    char order[2] = {0, 0};
    in_.read(order, 2);
    big_endian_ = order[0] == 'M';
    const uint64_t version = number(2, 2);
    big_ = version == 43;
    known_ =
        (order[0] == 'I' || order[0] == 'M') && order[0] == order[1] && (big_ || version == 42);
  }
  bool known() const { return known_; }

  /// What is wrong with the first page that has a fault; empty if none has.
  std::string fault() {
    uint64_t at = big_ ? number(8, 8) : number(4, 4);
    Page first;
    std::set<uint64_t> seen;
    for (pages_ = 0; at != 0; ++pages_) {
      Page page;
      if (!seen.insert(at).second || !read(at, page))
        return "lies partly beyond the end of the file or contradicts itself: the file is cut or "
               "damaged. Copy it again.";
      if (page.samples != 1 || (page.bits != 8 && page.bits != 16 && page.bits != 32))
        return fmt::format(
            "has {} numbers of {} bits per voxel; a label image has one of 8, 16 or 32. "
            "Export the labels, not a rendering.",
            page.samples, page.bits);
      if (pages_ == 0)
        first = page;
      if (page.width != first.width || page.height != first.height || page.bits != first.bits)
        return fmt::format(
            "has {} x {} voxels of {} bits, the first {} x {} of {}. All pages must be "
            "of one size.",
            page.width, page.height, page.bits, first.width, first.height, first.bits);
    }
    size_ = {long(first.width), long(first.height), pages_};
    return pages_ > 0 ? "" : "is not there: the file is cut. Copy it again.";
  }
  long pages() const { return pages_; }
  /// Voxels along the axes; known once there is no fault.
  const std::array<long, 3> &size() const { return size_; }

private:
  std::ifstream in_;
  uint64_t bytes_;
  long pages_ = 0;
  std::array<long, 3> size_ = {0, 0, 0};
  bool big_endian_ = false, big_ = false, known_ = false;

  uint64_t number(uint64_t at, int bytes) {
    std::array<unsigned char, 8> b{};
    in_.clear();
    in_.seekg(std::streamoff(at));
    in_.read(reinterpret_cast<char *>(b.data()), bytes);
    uint64_t v = 0;
    for (int k = 0; k < bytes; ++k)
      v |= uint64_t(b[k]) << 8 * (big_endian_ ? bytes - 1 - k : k);
    return v;
  }
  // Element k of an entry's values; beyond the file it is the file's size.
  uint64_t element(uint64_t entry, uint64_t k) {
    const int type = int(number(entry + 2, 2)), width = type == 3 ? 2 : type == 16 ? 8 : 4;
    const uint64_t count = count_of(entry);
    const uint64_t field = entry + (big_ ? 12 : 8), room = big_ ? 8 : 4;
    const uint64_t values = count <= room / width ? field : number(field, int(room));
    return values > bytes_ || (k + 1) * width > bytes_ - values ? bytes_
                                                                : number(values + k * width, width);
  }
  uint64_t count_of(uint64_t entry) { return big_ ? number(entry + 4, 8) : number(entry + 4, 4); }

  // One directory and the data of its strips or tiles; `at` becomes the next one's place.
  bool read(uint64_t &at, Page &page) {
    const uint64_t head = big_ ? 8 : 2, step = big_ ? 20 : 12, next = big_ ? 8 : 4;
    if (at > bytes_ || head + next > bytes_ - at)
      return false;
    const uint64_t entries = number(at, int(head));
    if (entries > (bytes_ - at - head - next) / step)
      return false;
    std::map<uint64_t, uint64_t> tags;
    for (uint64_t e = 0; e < entries; ++e)
      if (const uint64_t entry = at + head + e * step;
          !tags.emplace(number(entry, 2), entry).second)
        return false; // twice: of two numbers VTK may take the other one
    for (const SingleTag &single : kSingleTags)
      if (tags.count(single.tag)) {
        const uint64_t entry = tags[single.tag], type = number(entry + 2, 2);
        const uint64_t value = element(entry, 0);
        const bool per_sample = single.tag == 258 || single.tag == 339;
        if (count_of(entry) != (per_sample ? page.samples : 1) || (type != 3 && type != 4) ||
            value > single.most || (value == 0 && single.tag != 262))
          return false;
        if (single.member)
          page.*single.member = value;
      }
    const bool tiles = page.tile_width > 0;
    const uint64_t offsets = tags[tiles ? 324 : 273], lengths = tags[tiles ? 325 : 279];
    const uint64_t strips = offsets ? count_of(offsets) : 0;
    if (!lengths || count_of(lengths) != strips || strips != page.parts() || strips == 0 ||
        strips > bytes_)
      return false;
    for (uint64_t k = 0; k < strips; ++k)
      if (const uint64_t from = element(offsets, k);
          from >= bytes_ || element(lengths, k) > bytes_ - from)
        return false;
    at = number(at + head + entries * step, int(next));
    return true;
  }
};

} // namespace

void check_tiff(const std::string &file) {
  constexpr double kPacked = 10000.0; // voxels that the best packing has put into a byte
  Walk walk(file);
  if (!walk.known())
    refuse_image(file, "it does not begin as a TIFF file does. Give the image as the program that "
                       "segmented it wrote it.");
  if (const std::string fault = walk.fault(); !fault.empty())
    refuse_image(file, fmt::format("page {} {}", walk.pages() + 1, fault));
  check_axes(file, walk.size(), long(std::filesystem::file_size(file)), kPacked);
}

// The elements of a .vti file that say how large the image is.

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
    refuse_image(
        file, fmt::format("its header has no {}=\"...\" of six whole numbers: it is cut or no .vti "
                          "file. Save the image anew.",
                          name));
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
                 fmt::format("its packed data announce {:.0f} blocks of {:.0f} bytes for {:.0f} "
                             "voxels: the file is damaged. Copy it again.",
                             h[0], h[1], voxels));
}

// The data of one array: behind its element, or where the appended data begin and the offset says.
void check_array(const std::string &file, const std::string &text, size_t at, double voxels) {
  const std::string array = element(text, "DataArray", at), head = element(text, "VTKFile");
  if (const auto n = attribute(array, "NumberOfComponents"); n && *n != "1")
    refuse_image(file,
                 fmt::format("an array has {} numbers per voxel; a label image has one. Export "
                             "the labels, not a rendering.",
                             n->substr(0, 20)));
  if (attribute(array, "NumberOfTuples"))
    refuse_image(file,
                 "an array of an image states NumberOfTuples: it is no .vti file. Save it anew.");
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

} // namespace

void check_vti(const std::string &file) {
  constexpr long kLook = 1 << 20;     // header and, in most files, all elements
  constexpr double kPacked = 10000.0; // voxels that the best packing has put into a byte
  std::string text(kLook, ' ');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), kLook);
  text.resize(size_t(in.gcount()));
  const std::string image = element(text, "ImageData");
  const Extent whole = extent_of(file, image, "WholeExtent");
  check_axes(file, {whole[1] - whole[0] + 1, whole[3] - whole[2] + 1, whole[5] - whole[4] + 1},
             long(std::filesystem::file_size(file)), kPacked);
  size_t pieces = 0;
  for (size_t at = 0; (at = text.find("<Piece", at)) != std::string::npos; ++at, ++pieces)
    if (extent_of(file, element(text, "Piece", at), "Extent") != whole)
      refuse_image(
          file,
          "it comes in pieces; a label image is wanted in one. Save it anew as one .vti file.");
  if (pieces != 1)
    refuse_image(file,
                 fmt::format("it has {} pieces; a label image has one. Save it anew.", pieces));
  const double voxels = double(whole[1] - whole[0] + 1) * double(whole[3] - whole[2] + 1) *
                        double(whole[5] - whole[4] + 1);
  for (size_t at = 0; (at = text.find("<DataArray", at)) != std::string::npos; ++at)
    check_array(file, text, at, voxels);
}

} // namespace calendem
