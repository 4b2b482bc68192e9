// SPDX-License-Identifier: GPL-2.0-or-later
// calendem withheld make | answer | score
#ifndef CALENDEM_WITHHELD_VERB_H
#define CALENDEM_WITHHELD_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_withheld_verb(CLI::App &app);
}

#endif
