// SPDX-License-Identifier: GPL-2.0-or-later
// calendem study STUDY.toml -o DIR [--jobs N] [--ranks N] [--only N] [--table]
#ifndef CALENDEM_STUDY_VERB_H
#define CALENDEM_STUDY_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_study_verb(CLI::App &app);
}

#endif
