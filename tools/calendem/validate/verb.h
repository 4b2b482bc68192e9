// SPDX-License-Identifier: GPL-2.0-or-later
// calendem validate FILE...
#ifndef CALENDEM_VALIDATE_VERB_H
#define CALENDEM_VALIDATE_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_validate_verb(CLI::App &app);
}

#endif
