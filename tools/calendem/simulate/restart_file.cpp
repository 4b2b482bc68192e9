// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/restart_file.h"
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

namespace calendem {
namespace {

constexpr double kShortestRecord = 5.0; // length, x, y, z and something
constexpr size_t kCount = sizeof(std::int32_t);
constexpr int kMostEmptyRanks = 64;

template <class T> T value_at(const std::string &bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Atoms whose records fill exactly `n` values from `at` on; -1 if they do not.
long atoms_in_chunk(const std::string &bytes, size_t at, size_t n) {
  long atoms = 0;
  for (size_t k = 0; k < n; ++atoms) {
    const double length = value_at<double>(bytes, at + sizeof(double) * k);
    if (!(length >= kShortestRecord) || length > double(n - k) || length != std::floor(length))
      return -1;
    k += static_cast<size_t>(length);
  }
  return atoms;
}

/// Where the chunk of at least one atom begins that reaches to `end`; `end` if there is none.
size_t last_chunk(const std::string &bytes, size_t end) {
  const size_t shortest = kCount + sizeof(double) * static_cast<size_t>(kShortestRecord);
  for (size_t length = shortest; length <= end; length += sizeof(double)) {
    const size_t begin = end - length, n = (length - kCount) / sizeof(double);
    if (value_at<std::int32_t>(bytes, begin) == static_cast<std::int64_t>(n) &&
        atoms_in_chunk(bytes, begin + kCount, n) > 0)
      return begin;
  }
  return end;
}

} // namespace

// From the end: where a count reaches exactly to the end, a chunk of atoms begins; then the one
// before it. Ranks without atoms leave counts of 0, which the last value of an atom may look like
// too: they are taken for such only where no chunk fits.
bool restart_is_whole(const std::string &file, long atoms) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  int empty_ranks = 0;
  size_t end = bytes.size();
  while (atoms > 0) {
    const size_t begin = last_chunk(bytes, end);
    if (begin < end) {
      atoms -= atoms_in_chunk(bytes, begin + kCount, (end - begin - kCount) / sizeof(double));
      end = begin;
    } else if (end >= kCount && value_at<std::int32_t>(bytes, end - kCount) == 0 &&
               empty_ranks++ < kMostEmptyRanks) {
      end -= kCount;
    } else {
      return false;
    }
  }
  return atoms == 0;
}

} // namespace calendem
