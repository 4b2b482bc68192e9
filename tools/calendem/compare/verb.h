// SPDX-License-Identifier: GPL-2.0-or-later
// calendem compare EXPERIMENT.toml DIR... -o DIR
#ifndef CALENDEM_COMPARE_VERB_H
#define CALENDEM_COMPARE_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_compare_verb(CLI::App &app);
}

#endif
