// SPDX-License-Identifier: GPL-2.0-or-later
// How far a running compression is.
#ifndef CALENDEM_SIMULATE_PROGRESS_H
#define CALENDEM_SIMULATE_PROGRESS_H

#include "base/case.h"
#include "simulate/collect.h"
#include <chrono>
#include <cmath>

namespace calendem {

/// Share of the target of pressure, displacement or thickness that a row has reached; 1 once the
/// platen goes back.
double target_share(const Settings &settings, const RawRow &row);

/// Simulated time [us] until the compression's target is met: at the platen's speed, or as the
/// pressure has grown over the last quarter; NaN where that says nothing.
double time_to_target(const Settings &settings, const std::vector<RawRow> &rows);

/// Shows the progress line; on a terminal in place, else a line every half minute.
class Progress {
public:
  /// `settings` is referred to.
  Progress(const std::string &curve, const Settings &settings);
  void operator()();

private:
  std::string curve_;
  const Settings &settings_;
  double from_ = NAN; ///< simulated time at the first look, which was at looked_ [us]
  std::chrono::steady_clock::time_point looked_, begin_, shown_;
};

} // namespace calendem

#endif
