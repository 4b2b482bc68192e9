// SPDX-License-Identifier: GPL-2.0-or-later
// calendem tomogram SPEC.toml -o FILE.mhd
#ifndef CALENDEM_TOMOGRAM_VERB_H
#define CALENDEM_TOMOGRAM_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_tomogram_verb(CLI::App &app);
}

#endif
