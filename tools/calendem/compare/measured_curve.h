// SPDX-License-Identifier: GPL-2.0-or-later
// A press's curve without the rows that jump away from their neighbours.
#ifndef CALENDEM_COMPARE_MEASURED_CURVE_H
#define CALENDEM_COMPARE_MEASURED_CURVE_H

#include <string>
#include <vector>

namespace calendem {

struct MeasuredBranch {
  std::vector<double> pressure, displacement; ///< by rising pressure [MPa], [um]
};

struct MeasuredCurve {
  /// The first loading, the last release: up to the highest, down to the lowest pressure so far.
  MeasuredBranch loading, release;
  int left_out = 0; ///< rows that stand out
};

/// Reads a CSV file that check_curve found right.
MeasuredCurve read_measured_curve(const std::string &file);

} // namespace calendem

#endif
