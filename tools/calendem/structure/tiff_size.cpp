// SPDX-License-Identifier: GPL-2.0-or-later
// Walks the directories of a TIFF file (TIFF 6.0, section 2; BigTIFF) to see whether it is whole.
#include "spec/messages.h"
#include "structure/image_files.h"
#include <array>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

namespace calendem {
namespace {

using std::uint64_t;

class Walk {
public:
  explicit Walk(const std::string &file)
      : in_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {
    char order[2] = {0, 0};
    in_.read(order, 2);
    big_endian_ = order[0] == 'M';
    known_ = (order[0] == 'I' || order[0] == 'M') && order[0] == order[1];
    big_ = number(2, 2) == 43;
  }
  bool known() const { return known_; }

  /// Directories that lie in the file whole, up to the first that does not.
  bool whole(int &pages) {
    uint64_t at = big_ ? number(8, 8) : number(4, 4);
    for (pages = 0; at != 0; ++pages)
      if (!page(at) || pages > 1000000)
        return false;
    return pages > 0;
  }

private:
  std::ifstream in_;
  uint64_t size_;
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
    const uint64_t count = big_ ? number(entry + 4, 8) : number(entry + 4, 4);
    const uint64_t field = entry + (big_ ? 12 : 8), room = big_ ? 8 : 4;
    const uint64_t values = count * width <= room ? field : number(field, int(room));
    return values + (k + 1) * width > size_ ? size_ : number(values + k * width, width);
  }
  // One directory and the data of its strips or tiles; `at` becomes the next one's place.
  bool page(uint64_t &at) {
    const uint64_t head = big_ ? 8 : 2, step = big_ ? 20 : 12, next = big_ ? 8 : 4;
    if (at + head > size_)
      return false;
    const uint64_t entries = number(at, int(head));
    if (entries > size_ || at + head + entries * step + next > size_)
      return false;
    uint64_t offsets = 0, bytes = 0, strips = 0;
    for (uint64_t e = 0; e < entries; ++e) {
      const uint64_t entry = at + head + e * step, tag = number(entry, 2);
      if (tag == 273 || tag == 324) {
        offsets = entry;
        strips = big_ ? number(entry + 4, 8) : number(entry + 4, 4);
      } else if (tag == 279 || tag == 325)
        bytes = entry;
    }
    for (uint64_t k = 0; offsets && bytes && k < strips; ++k)
      if (element(offsets, k) + element(bytes, k) > size_)
        return false;
    at = number(at + head + entries * step, int(next));
    return true;
  }
};

} // namespace

void check_tiff_size(const std::string &file) {
  Walk walk(file);
  int pages = 0;
  if (walk.known() && !walk.whole(pages))
    throw Failure(kBadInput, fmt::format("{}: page {} lies partly beyond the end of the file: the "
                                         "file is cut. Copy it again.",
                                         file, pages + 1));
}

} // namespace calendem
