// SPDX-License-Identifier: GPL-2.0-or-later
// What `calendem measure` found of a run, as charts and a table. Nothing where it was not asked.
#ifndef CALENDEM_REPORT_STRUCTURE_PART_H
#define CALENDEM_REPORT_STRUCTURE_PART_H

#include <vector>

#include "measure/run_directory.h"
#include "report/chart.h"

namespace calendem::report {

/// Macro porosity through the thickness; no series when no run was measured.
Chart porosity_profiles(const std::vector<Run> &runs);
/// Broken share of the bonds in each slice; no series when no bond broke.
Chart broken_profiles(const std::vector<Run> &runs);

/// {"moments": [names], "rows": [{quantity, cells: [{value, text}]}]}; null when not measured.
nlohmann::json structure_table(const Run &run);

} // namespace calendem::report

#endif
