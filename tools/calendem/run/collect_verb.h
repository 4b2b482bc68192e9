// SPDX-License-Identifier: GPL-2.0-or-later
// calendem collect DIR: the files of a run's directory from what plain input scripts left there
#ifndef CALENDEM_RUN_COLLECT_VERB_H
#define CALENDEM_RUN_COLLECT_VERB_H

#include "spec/toml_reader.h"

namespace CLI {
class App;
}

namespace calendem {

/// Settings of a run from its settings.txt (lines "variable value", written by the input scripts).
/// `electrode`, if not empty, replaces the path that the run used. Throws Failure(2).
Settings read_settings(const std::string &file, const std::string &electrode);

void add_collect_verb(CLI::App &app);

} // namespace calendem

#endif
