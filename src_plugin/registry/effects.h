// SPDX-License-Identifier: GPL-2.0-or-later
// All effects, in the order in which they are listed.
#ifndef CALENDEM_REGISTRY_EFFECTS_H
#define CALENDEM_REGISTRY_EFFECTS_H

#include "registry/effects_of_bonds.h"
#include "registry/effects_of_contacts.h"
#include "registry/effects_of_the_coating.h"
#include "registry/effects_of_the_press.h"

namespace calendem {

inline const std::vector<Effect> &effects() {
  static const std::vector<Effect> table = [] {
    std::vector<Effect> all = effects_of_contacts();
    for (const std::vector<Effect> &more :
         {effects_of_bonds(), effects_of_the_coating(), effects_of_the_press()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return table;
}

/// Adds the settings of the effects of the recipe, or of those of the case.
inline void add_settings_of_effects(bool in_recipe, std::vector<Key> &keys) {
  for (const Effect &e : effects())
    if (e.in_recipe == in_recipe)
      keys.insert(keys.end(), e.settings.begin(), e.settings.end());
}

} // namespace calendem

#endif
