// SPDX-License-Identifier: GPL-2.0-or-later
// Sums that do not depend on the order of their terms: terms are rounded to multiples of a power of
// two and added as whole numbers. The same atoms give the same bits on any number of processors.
//   FixedPoint: sum = unit * sum of round(term / unit),  |term|, |sum| < 2^63 unit
//   WideSum: the same with six units at once, which together hold forces in any system of units
// A term and its opposite give opposite whole numbers: force and counterforce stay opposite.
// Verified by tests/unit/physics/fixed_point_test.cpp and tests/reliability/same_physics.
#ifndef CALENDEM_PHYSICS_FIXED_POINT_H
#define CALENDEM_PHYSICS_FIXED_POINT_H

#include "vector3.h"
#include <cstdlib>

namespace calendem {

struct FixedPoint {
  double unit = 1.0;     ///< a power of two, in the terms' unit
  double per_unit = 1.0; ///< 1 / unit

  FixedPoint() = default;
  /// For sums whose size stays below `largest` > 0.
  explicit FixedPoint(double largest)
      : unit(std::exp2(std::ceil(std::log2(largest)) - 62.0)), per_unit(1.0 / unit) {}

  double rounded(double term) const { return std::rint(term * per_unit); } ///< in units
  double value(long long sum) const { return static_cast<double>(sum) * unit; }
};

/// Beside a sum of vectors of whole numbers, of which 64 binary digits are kept: the same sum in
/// units of 2^53, its three components of 21 digits in one number. It shows whether the sum has left
/// the range of the 64 digits, to look like another number. Of up to 256 vectors it is right to an
/// eighth of that range.
struct RoughSum {
  static constexpr long long kMost = 7LL << 60;            ///< that is in range
  static constexpr unsigned long long kNoFit = 1ULL << 53; ///< in place of a term that does not fit

  /// False for what is not a number, too.
  static bool fits(const Vec3 &term) { return norm_squared(term) < 0x1p126; }
  static unsigned long long of(const Vec3 &term) {
    const double x = std::rint(0x1p-53 * term.x), y = std::rint(0x1p-53 * term.y),
                 z = std::rint(0x1p-53 * term.z);
    return static_cast<unsigned long long>(static_cast<long long>(x + 0x1p21 * y + 0x1p42 * z));
  }
  static bool in_range(unsigned long long sum) {
    for (int k = 0; k < 3; ++k) {
      const long long digits = static_cast<long long>(sum << 43) >> 43; // the lower 21, with a sign
      if (std::llabs(digits) > kMost >> 53)
        return false;
      sum = static_cast<unsigned long long>((static_cast<long long>(sum) - digits) >> 21);
    }
    return true;
  }
};

/// Sum of numbers of any size between 2^-96 and 2^95, in any system of units, without rounding: as
/// whole numbers of the weights 2^(32 k - 96), of up to 2^31 terms. Sums of such sums, over steps or
/// processors, add their whole numbers.
///   term = sum of trunc(what the larger weights leave / weight) weight
struct WideSum {
  static constexpr int kWeights = 6;
  static constexpr double kWeight[kWeights] = {0x1p-96, 0x1p-64, 0x1p-32, 1.0, 0x1p32, 0x1p64};
  static constexpr double kMost = 0x1p95;
  /// By rising weight; the last one counts the terms that were no numbers, or too large.
  long long whole[kWeights + 1] = {};

  void add(double term) {
    if (!(std::fabs(term) < kMost)) {
      ++whole[kWeights];
      return;
    }
    for (int k = kWeights - 1; k >= 0 && term != 0.0; --k) {
      const double part = std::trunc(term / kWeight[k]);
      whole[k] += static_cast<long long>(part);
      term -= part * kWeight[k]; // exact
    }
  }
  void add(WideSum sum) {
    sum.carry();
    for (int k = 0; k <= kWeights; ++k)
      whole[k] += sum.whole[k];
  }
  bool holds_all() const { return whole[kWeights] == 0; } ///< else value() is not the sum
  double value() const {
    WideSum one_way = *this; // of all in which the same sum can be written
    one_way.carry();
    double sum = 0.0;
    for (int k = kWeights - 1; k >= 0; --k)
      sum += static_cast<double>(one_way.whole[k]) * kWeight[k];
    return sum;
  }

private:
  /// All but the largest weight's between 0 and 2^32.
  void carry() {
    for (int k = 0; k < kWeights - 1; ++k) {
      const long long over = whole[k] >> 32;
      whole[k] &= 0xffffffffLL;
      whole[k + 1] += over;
    }
  }
};

/// Spacing of numbers that are all exact, up to `largest` in size: coordinates on it can be shifted
/// by a multiple of it and back without rounding.
inline double exact_spacing(double largest) {
  return std::exp2(std::ceil(std::log2(largest)) - 52.0);
}

inline double nearest_multiple(double x, double spacing) {
  return std::nearbyint(x / spacing) * spacing;
}

} // namespace calendem

#endif
