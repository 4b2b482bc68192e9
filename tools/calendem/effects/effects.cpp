// SPDX-License-Identifier: GPL-2.0-or-later
#include "effects/effects.h"
#include "effects/effects_of_bonds.h"
#include "effects/effects_of_contacts.h"
#include "effects/effects_of_temperature.h"
#include "effects/effects_of_the_coating.h"
#include "effects/effects_of_the_press.h"

namespace calendem {

const std::vector<Effect> &effects() {
  static const std::vector<Effect> table = [] {
    std::vector<Effect> all = effects_of_contacts();
    for (const std::vector<Effect> &more : {effects_of_bonds(), effects_of_the_coating(),
                                            effects_of_temperature(), effects_of_the_press()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return table;
}

void add_settings_of_effects(bool in_recipe, std::vector<Key> &keys) {
  for (const Effect &e : effects())
    if (e.in_recipe == in_recipe)
      keys.insert(keys.end(), e.settings.begin(), e.settings.end());
}

} // namespace calendem
