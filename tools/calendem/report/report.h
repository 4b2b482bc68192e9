// SPDX-License-Identifier: GPL-2.0-or-later
// A report: one object, from which both report.json and report.html are made; its 3-D view.
#ifndef CALENDEM_REPORT_REPORT_H
#define CALENDEM_REPORT_REPORT_H

#include "measure/run_directory.h"
#include "report/page.h"
#include "report/pictures.h"
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace calendem::report {

/// Everything that is shown about `runs`; `command` is the command line that asked for it. The object
/// has pictures by their frame file, without pixels. What cannot be drawn goes to the runs' notes.
Page page_of(std::vector<Run> &runs, const std::string &command);

/// Writes `page` (HTML) and its twin beside it with the ending .json. Throws Failure(2) with the
/// mistakes of all directories; nothing is written then.
void write_report(const std::vector<std::string> &directories, std::string page);

// Data of the page's 3-D view: particles and bonds before, at maximum pressure and after, and what
// bodies.csv says of each body. explorer.js draws it with three.js; no network is needed.

/// Null when the run has no frames. Positions are whole numbers of 1/65535 of the box, little
/// endian, base64; bodies that a periodic face cuts are put together. Unreadable frames go to
/// `run.notes`.
nlohmann::json explorer_of(Run &run);

} // namespace calendem::report

#endif
