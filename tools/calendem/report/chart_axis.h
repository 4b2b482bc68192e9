// SPDX-License-Identifier: GPL-2.0-or-later
// A linear axis: range rounded outwards to ticks of 1, 2 or 5 times a power of ten.
#ifndef CALENDEM_REPORT_CHART_AXIS_H
#define CALENDEM_REPORT_CHART_AXIS_H

#include <string>
#include <vector>

namespace calendem::report {

struct Axis {
  double low = 0, high = 1; ///< in units of the data
  double step = 0.2;

  std::vector<double> ticks() const;
  std::string label(double tick) const; ///< as many decimals as the step needs
  /// Position between `begin` (for low) and `end` (for high).
  double place(double value, double begin, double end) const;
};

/// Axis that holds [low, high] with about `count` ticks. A range of no width is widened.
Axis axis_for(double low, double high, int count);

/// Smallest and largest finite value; `first` false when there is none.
struct Range {
  bool any = false;
  double low = 0, high = 0;
  void include(double value);
};

} // namespace calendem::report

#endif
