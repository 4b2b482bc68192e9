// SPDX-License-Identifier: GPL-2.0-or-later
// calendem run CASE.toml -o DIR [--ranks N] [--resume]
#ifndef CALENDEM_RUN_VERB_H
#define CALENDEM_RUN_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_run_verb(CLI::App &app);
}

#endif
