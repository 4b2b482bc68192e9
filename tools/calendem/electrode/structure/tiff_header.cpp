// SPDX-License-Identifier: GPL-2.0-or-later
// Walks the directories of a TIFF file (TIFF 6.0, section 2; BigTIFF) to see whether it is whole
// and holds pages of labels of one size.
#include "electrode/structure/image_header.h"
#include <array>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <set>

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

} // namespace calendem
