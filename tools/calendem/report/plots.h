// SPDX-License-Identifier: GPL-2.0-or-later
// The charts of a report. With one run a colour means a branch or a quantity, as in the paper's
// Figure 4b; with several it means a run.
#ifndef CALENDEM_REPORT_PLOTS_H
#define CALENDEM_REPORT_PLOTS_H

#include "measure/run_directory.h"
#include "report/page.h"
#include <vector>

namespace calendem::report {

/// The title of a chart of one run: with its name where there are several.
std::string titled(const std::string &title, const Run &run, bool single);

/// Adds a line of the i-th run, which keeps its colour and symbol through all charts; a single run has
/// `colour` and no symbol.
Series &add_line(Chart &chart, const std::vector<Run> &runs, std::size_t i, const std::string &name,
                 Column x, Column y, const char *colour, const char *dash);

/// The paper's broken bonds [%], and its Table 1: total porosity after relaxation [%].
Series breaks_of_paper(const std::string &name);
Series porosity_of_paper(const std::string &name);

std::vector<Chart> plots_of(const std::vector<Run> &runs);

/// Histogram of the bodies' sphericity, from electrode.json; no series when that has none.
Chart sphericities(const Run &run, bool single);

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

/// Macro porosity through the thickness; no series when no run was measured.
Chart porosity_profiles(const std::vector<Run> &runs);
/// Broken share of the bonds in each slice; no series when no bond broke.
Chart broken_profiles(const std::vector<Run> &runs);

/// {"moments": [names], "rows": [{quantity, cells: [{value, text}]}]}; null when not measured.
nlohmann::json structure_table(const Run &run);

/// Share of the contact force beyond 0.1, 0.2, 0.3 of the smaller radius, against pressure.
Chart force_beyond_range(const std::vector<Run> &runs);
/// Inertial number and kinetic over elastic energy before the release, above 5 MPa.
Chart inertial_numbers(const std::vector<Run> &runs);

/// {"rows": [{name, cells: [{value, text}]}]} of the contacts at maximum pressure; null: not known.
nlohmann::json validity_table(const Run &run);

} // namespace calendem::report

#endif
