// SPDX-License-Identifier: GPL-2.0-or-later
// Sums that do not depend on the order of their terms: terms are cut to multiples of one power of
// two and added as whole numbers. The same atoms give the same bits on any number of processors.
//   sum = unit * sum of trunc(term / unit),  |term|, |sum| < 2^63 unit
// Each term loses less than one unit, towards zero, so that force and counterforce stay opposite.
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
  long long of(double term) const { return static_cast<long long>(rounded(term)); }
  double value(long long sum) const { return static_cast<double>(sum) * unit; }
};

/// Sum of whole numbers that one alone cannot hold, as two of them: 2^31 terms of any size.
struct LongSum {
  long long high = 0, low = 0; ///< high * 2^32 + low

  void add(long long term) {
    high += term >> 32;
    low += term & 0xffffffffLL;
  }
  double value() const {
    return static_cast<double>(high) * 4294967296.0 + static_cast<double>(low);
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
