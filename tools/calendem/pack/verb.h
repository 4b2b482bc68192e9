// SPDX-License-Identifier: GPL-2.0-or-later
// calendem pack SPEC.toml -o DIR [--seed N] [--ranks N]
#ifndef CALENDEM_PACK_VERB_H
#define CALENDEM_PACK_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_pack_verb(CLI::App &app);
}

#endif
