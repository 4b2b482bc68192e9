// SPDX-License-Identifier: GPL-2.0-or-later
// Effects inside the bodies: a function returns a row.
#ifndef CALENDEM_REGISTRY_EFFECTS_OF_BONDS_H
#define CALENDEM_REGISTRY_EFFECTS_OF_BONDS_H

#include "registry/effect.h"

namespace calendem {

inline Effect weibull_strength() {
  Effect e;
  e.name = "weibull_strength";
  e.layer = "bond";
  e.what = "strength of bonds scattered by a Weibull law of the same mean";
  e.parameter = {{"bond.weibull_modulus"},   "0", 1.5, 10, Spread::LogUniform,
                 AmplitudeScale::Reciprocal, 1.0};
  e.moves = "breaks begin earlier and spread over more of the curve; porosity hardly changes";
  e.source = "Weibull 1951; a modulus of 3-8 is an unsourced prior for NMC, widened here";
  e.law = "weibull_strength.h";
  e.verification = "strength";
  return e;
}

inline Effect pre_cracks() {
  Effect e;
  e.name = "pre_cracks";
  e.layer = "bond";
  e.what = "a fraction of the bonds has no strength from the start";
  e.settings = {{"effects.pre_cracks.fraction", "pre_cracks", "0", 0, 0.9, "",
                 "of the bonds, without strength"}};
  e.parameter = strength(e.settings[0], 0.02, 0.5, Spread::LogUniform);
  e.bond_law = "pre_cracks";
  e.moves =
      "weaker bodies from the first load on: lower pressure at a displacement, more cracked bodies";
  e.source = "a random choice of bonds; tomograms show pores and cracks in NMC, an unsourced prior";
  e.law = "pre_cracks.h";
  e.verification = "strength";
  return e;
}

inline std::vector<Effect> effects_of_bonds() { return {weibull_strength(), pre_cracks()}; }

} // namespace calendem

#endif
