// SPDX-License-Identifier: GPL-2.0-or-later
// calendem report DIR… [-o FILE.html]
#ifndef CALENDEM_REPORT_VERB_H
#define CALENDEM_REPORT_VERB_H

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace calendem {

/// The verb throws Failure (spec/messages.h) with the exit status when it cannot be done.
void add_report_verb(CLI::App &app);

namespace report {

/// Writes `page` (HTML), its twin beside it with the ending .json and, if a folder is given, every
/// plot as `figures`/ID.svg. Exit status of the program:
/// 0 done, 2 bad input (all mistakes are on stderr and nothing is written).
int write_report(const std::vector<std::string> &directories, std::string page,
                 const std::string &figures = "");

} // namespace report
} // namespace calendem

#endif
