// SPDX-License-Identifier: GPL-2.0-or-later
// Fracture, particle by particle: what `calendem run` left in bodies.csv, cracks.csv,
// thresholds.csv and breaks.csv, as charts.
#ifndef CALENDEM_REPORT_FRACTURE_PART_H
#define CALENDEM_REPORT_FRACTURE_PART_H

#include <vector>

#include "measure/run_directory.h"
#include "report/chart.h"

namespace calendem::report {

// Each has no series when the run has not the table it is drawn from.

/// Bodies that are cracked, apart, split against pressure.
Chart cracked_by_pressure(const std::vector<Run> &runs);
/// Faces of broken bonds against pressure.
Chart crack_surface(const std::vector<Run> &runs);
/// Thresholds of broken bonds against lost connectivity: agreement, false positives and negatives.
Chart thresholds(const Run &run, bool single);
/// Largest fragment against broken bonds, a point for every body.
Chart fragments(const Run &run, bool single);
/// Broken bonds against depth, a point for every body.
Chart broken_by_depth(const Run &run, bool single);
/// Pressure and broken bonds of the studied body against displacement (the paper's Figure 5b).
Chart one_body(const Run &run, bool single);

/// The body that is studied by itself: the one with most broken bonds (of equals the first); 0:
/// none.
int studied_body(const Run &run);

} // namespace calendem::report

#endif
