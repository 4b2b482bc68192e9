// SPDX-License-Identifier: GPL-2.0-or-later
// Sums that do not depend on the order of their terms: terms are rounded to multiples of a power of
// two and added as whole numbers. The same atoms give the same bits on any number of processors.
//   FixedPoint: sum = unit * sum of round(term / unit),  |term|, |sum| < 2^63 unit
//   WideSum: the same with six units at once, which together hold forces in any system of units
// A term and its opposite give opposite whole numbers: force and counterforce stay opposite.
// Verified by tests/unit/physics/fixed_point_test.cpp and tests/reliability/same_physics.
#ifndef CALENDEM_PHYSICS_FIXED_POINT_H
#define CALENDEM_PHYSICS_FIXED_POINT_H

#include <cmath>

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

/// Beside a sum of vectors of whole numbers, of which 64 binary digits are kept: what shows that a
/// component has left their range, and looks like another number. It is the sum, in units of 2^24, of
///   x + 2^7 y + 2^14 z,
/// which a component off by 2^64 does not fit. For up to 2^10 terms that use their whole range.
struct SumCheck {
  static constexpr double kMost = 0x1p63; ///< that a term or a sum can be, in its units

  /// The check of a term, to be added as a whole number if it can be: not that of what is no
  /// number, or far too large. A component that is a little too large does not fit the sum.
  static double of(double x, double y, double z) { return 0x1p-24 * (x + 0x1p7 * y + 0x1p14 * z); }
  static bool can_be_added(double check) { return std::fabs(check) < 0x1p55; }
  static bool fits(const unsigned long long (&sum)[4]) { ///< the check is the last
    const auto number = [&](int k) { return static_cast<double>(static_cast<long long>(sum[k])); };
    const double check = 0x1p-24 * (number(0) + 0x1p7 * number(1) + 0x1p14 * number(2));
    return std::fabs(number(3) - check) < 0x1p16; // each term is cut to a whole number
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
