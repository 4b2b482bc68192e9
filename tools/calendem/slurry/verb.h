// SPDX-License-Identifier: GPL-2.0-or-later
// `calendem dry`
#ifndef CALENDEM_SLURRY_VERB_H
#define CALENDEM_SLURRY_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_dry_verb(CLI::App &app);
}

#endif
