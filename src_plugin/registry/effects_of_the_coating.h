// SPDX-License-Identifier: GPL-2.0-or-later
// The coating as it came from the dryer: a function returns a row. Keys are the recipe's.
#ifndef CALENDEM_REGISTRY_EFFECTS_OF_THE_COATING_H
#define CALENDEM_REGISTRY_EFFECTS_OF_THE_COATING_H

#include "registry/effect.h"

namespace calendem {

inline Effect cbd_gradient() {
  Effect e;
  e.name = "cbd_gradient";
  e.layer = "coating";
  e.what = "more carbon-binder domain at one side of the coating than at the other";
  e.settings = {{"effects.cbd_gradient.slope", "", "0", -1, 1, "",
                 "content at the surface less that at the collector, over their sum"}};
  e.parameter = strength(e.settings[0], -0.6, 0.9, Spread::Uniform);
  e.in_recipe = true;
  e.moves = "profiles of carbon-binder and porosity over the height, before and after";
  e.source = "Font et al. 2018 (towards the surface in fast drying), Nikpour et al. 2022 (either "
             "way); the range is an unsourced prior";
  e.law = "cbd_gradient.h";
  e.verification = "regression/coating";
  return e;
}

inline std::vector<Effect> effects_of_the_coating() { return {cbd_gradient()}; }

} // namespace calendem

#endif
