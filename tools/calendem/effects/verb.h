// SPDX-License-Identifier: GPL-2.0-or-later
// calendem effects [NAME] [--json], calendem registry DIR [--check]
#ifndef CALENDEM_EFFECTS_VERB_H
#define CALENDEM_EFFECTS_VERB_H

namespace CLI {
class App;
}

namespace calendem {
void add_effects_verb(CLI::App &app);
void add_registry_verb(CLI::App &app);
} // namespace calendem

#endif
