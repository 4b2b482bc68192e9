// SPDX-License-Identifier: GPL-2.0-or-later
// All effects, in the order in which they are listed.
#ifndef CALENDEM_EFFECTS_EFFECTS_H
#define CALENDEM_EFFECTS_EFFECTS_H

#include "effects/effect.h"
#include <vector>

namespace calendem {

const std::vector<Effect> &effects();

/// Adds the settings of the effects of the recipe, or of those of the case.
void add_settings_of_effects(bool in_recipe, std::vector<Key> &keys);

} // namespace calendem

#endif
