// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_STRUCTURE_MEASURE_VERB_H
#define CALENDEM_STRUCTURE_MEASURE_VERB_H

namespace CLI {
class App;
}

namespace calendem {

/// calendem measure DIR|IMAGE -o OUT
void add_measure_verb(CLI::App &app);

} // namespace calendem

#endif
