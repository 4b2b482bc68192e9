// SPDX-License-Identifier: GPL-2.0-or-later
// The coating as it came from the dryer: a function returns a row.
#ifndef CALENDEM_EFFECTS_EFFECTS_OF_THE_COATING_H
#define CALENDEM_EFFECTS_EFFECTS_OF_THE_COATING_H

#include "effects/effect.h"
#include "physics/drying_shrinkage.h"

namespace calendem {

inline Effect cbd_gradient() {
  Effect e = effect("cbd_gradient", "coating",
                    "more carbon-binder domain at one side of the coating than at the other");
  e.settings = {
      number("effects.cbd_gradient.slope", "", "0", -1, 1, "",
             "CBD content at the surface minus that at the collector, divided by their sum")};
  e.parameter = strength(e.settings[0]).uniform(-0.6, 0.9);
  e.in_recipe = true;
  e.moves = "profiles of carbon-binder and porosity over the height, before and after";
  e.source = "Font et al. 2018 (towards the surface in fast drying), Nikpour et al. 2022 (either "
             "way); the range is an unsourced prior";
  e.law = "cbd_gradient.h";
  e.verification = "regression/coating";
  return e;
}

inline Effect drying_stress() {
  Effect e = effect(
      "drying_stress", "coating",
      "the binder has shrunk on the foil: binder bridges are under tension before the press");
  e.settings = {
      number("effects.drying_stress.shrinkage", "drying_shrinkage", "0", 0, DryingShrinkage::kMost,
             "", "relative shrinkage of the length of binder bridges; 0: none"),
      number(
          "effects.drying_stress.time_us", "drying_us", "0.5", 0.01, 100, "us",
          "time in which they shrink; they then rest for the same time before the platen starts")};
  e.parameter = strength(e.settings[0]).log_uniform(0.001, 0.02);
  e.relations = {{e.settings[0].name, Relation::Is::Needs, "effects.binder_bridges.strength_MPa",
                  "only binder bridges can shrink"}};
  e.moves = "film under tension in its plane, little where CBD is sparse; bridges break during "
            "drying and at lower pressures";
  e.source =
      "Croll 1979; binder that swells on the foil of a graphite electrode makes 1-2 MPa "
      "(Sethuraman et al. 2012, arXiv:1201.2155), which with a modulus of 0.08-0.11 GPa of hard "
      "carbon electrodes (Sawhney et al. 2024, arXiv:2403.11668) and a Poisson's ratio of 0.3 is a "
      "strain in the plane of 0.6-1.8 %, widened here";
  e.law = "drying_shrinkage.h";
  e.verification = "drying_stress";
  return e;
}

inline std::vector<Effect> effects_of_the_coating() { return {cbd_gradient(), drying_stress()}; }

} // namespace calendem

#endif
