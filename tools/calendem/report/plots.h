// SPDX-License-Identifier: GPL-2.0-or-later
// The charts of a report. With one run a colour means a branch or a quantity, as in the paper's
// Figure 4b; with several it means a run.
#ifndef CALENDEM_REPORT_PLOTS_H
#define CALENDEM_REPORT_PLOTS_H

#include <vector>

#include "measure/run_directory.h"
#include "report/chart.h"

namespace calendem::report {

std::vector<Chart> plots_of(const std::vector<Run> &runs);

/// Histogram of the bodies' sphericity, from electrode.json; no series when that has none.
Chart sphericities(const Run &run, bool single);

} // namespace calendem::report

#endif
