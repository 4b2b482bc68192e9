// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_SAMPLE_VERB_H
#define CALENDEM_SAMPLE_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_sample_verb(CLI::App &app);
}

#endif
