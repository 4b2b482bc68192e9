// SPDX-License-Identifier: GPL-2.0-or-later
// calendem diagnose EXPERIMENT.toml -o DIR [--bank BANK.toml] [--without EFFECT]
#ifndef CALENDEM_DIAGNOSE_VERB_H
#define CALENDEM_DIAGNOSE_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_diagnose_verb(CLI::App &app);
}

#endif
