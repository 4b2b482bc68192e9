// SPDX-License-Identifier: GPL-2.0-or-later
// What a bank's runs gave, small enough to ship: one row for each press of a run.
#ifndef CALENDEM_BANK_RUNS_H
#define CALENDEM_BANK_RUNS_H

#include "bank/bank_file.h"
#include <array>
#include <cmath>

namespace calendem::bank {

/// What a press to one pressure left. Pressures MPa, lengths um, fractions 0-1; NaN: not known.
struct PressedFilm {
  double pressure = NAN, thickness_at_max = NAN, thickness_after = NAN;
  double porosity_at_max = NAN, porosity_after = NAN;
  double cracked = NAN, broken = NAN; ///< shares of the bodies and of the bonds
  /// 1 / tortuosity factor of the macropores through the plane; 0: no path leads through.
  double inverse_tortuosity = NAN;
  double cbd_nanoporosity = NAN;
  std::vector<double> release; ///< displacement at kReleasedTo of the pressure
};

/// The run of one point.
struct Run {
  Point point;
  std::string failed; ///< why there is none: "not packed", "not pressed"; empty: there is one
  double porosity_before = NAN, thickness_before = NAN;
  std::vector<PressedFilm> presses; ///< by rising pressure; a run that jams has fewer
  std::vector<double> loading;      ///< highest displacement so far at curve_pressures(); NaN
};

struct Runs {
  Bank bank;
  std::vector<Run> runs; ///< by number of their points
};

/// Pressures at which the displacement under load is kept [MPa]: from 1 on by ratios of 1.1.
const std::vector<double> &curve_pressures();
/// Shares of a press's pressure at which its release is kept.
inline constexpr std::array<double, 10> kReleasedTo = {0.05, 0.1, 0.2, 0.3, 0.4,
                                                       0.5,  0.6, 0.7, 0.8, 0.9};

/// Reads what is kept from the folder of a run. Throws Failure(2) with what is missing or damaged.
Run read_run_of(const Point &point, const std::string &folder);

/// Columns: point, packing, larger_cell, the inputs (empty: off), failed, numbers before and after a
/// press, displacements at curve_pressures() since the press before, and at kReleasedTo.
std::string write_runs(const Runs &runs);
/// Throws Failure(2): columns that are missing, lines that are damaged, points that are not the
/// bank's.
Runs read_runs(const Bank &bank, const std::string &file);

} // namespace calendem::bank

#endif
