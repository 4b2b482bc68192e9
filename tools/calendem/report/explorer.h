// SPDX-License-Identifier: GPL-2.0-or-later
// Data of the page's 3-D view: particles and bonds before, at maximum pressure and after, and what
// bodies.csv says of each body. explorer.js draws it with three.js; no network is needed.
#ifndef CALENDEM_REPORT_EXPLORER_H
#define CALENDEM_REPORT_EXPLORER_H

#include <nlohmann/json.hpp>

#include "measure/run_directory.h"

namespace calendem::report {

/// Null when the run has no frames. Positions are whole numbers of 1/65535 of the box, little
/// endian, base64; bodies that a periodic face cuts are put together. Unreadable frames go to
/// `run.notes`.
nlohmann::json explorer_of(Run &run);

} // namespace calendem::report

#endif
