// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a run stayed where its laws hold, as charts and a table. Nothing of a run without it.
#ifndef CALENDEM_REPORT_VALIDITY_PART_H
#define CALENDEM_REPORT_VALIDITY_PART_H

#include <vector>

#include "measure/run_directory.h"
#include "report/chart.h"

namespace calendem::report {

/// Share of the contact force beyond 0.1, 0.2, 0.3 of the smaller radius, against pressure.
Chart force_beyond_range(const std::vector<Run> &runs);
/// Inertial number and kinetic over elastic energy before the release, above 5 MPa.
Chart inertial_numbers(const std::vector<Run> &runs);

/// {"rows": [{name, cells: [{value, text}]}]} of the contacts at maximum pressure; null: not known.
nlohmann::json validity_table(const Run &run);

} // namespace calendem::report

#endif
