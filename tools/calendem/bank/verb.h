// SPDX-License-Identifier: GPL-2.0-or-later
// calendem bank BANK.toml -o DIR [--jobs N] [--slurm] ...: the options of study
#ifndef CALENDEM_BANK_VERB_H
#define CALENDEM_BANK_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_bank_verb(CLI::App &app);
}

#endif
