// SPDX-License-Identifier: GPL-2.0-or-later
// What `calendem measure` found of a run, as charts and a table. Nothing where it was not asked.
#ifndef CALENDEM_REPORT_STRUCTURE_PART_H
#define CALENDEM_REPORT_STRUCTURE_PART_H

#include <filesystem>
#include <vector>

#include "report/chart.h"
#include "report/run_directory.h"

namespace calendem::report {

/// Reads structure.json and structure.csv into `run`. A file that is cut or was measured of another
/// curve is a note, not a mistake.
void read_structure(const std::filesystem::path &directory, Run &run);

/// Macro porosity through the thickness; no series when no run was measured.
Chart porosity_profiles(const std::vector<Run> &runs);
/// Broken share of the bonds in each slice; no series when no bond broke.
Chart broken_profiles(const std::vector<Run> &runs);

/// {"moments": [names], "rows": [{quantity, cells: [{value, text}]}]}; null when not measured.
nlohmann::json structure_table(const Run &run);

} // namespace calendem::report

#endif
