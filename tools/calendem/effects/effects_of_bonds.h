// SPDX-License-Identifier: GPL-2.0-or-later
// Effects inside the bodies: a function returns a row.
#ifndef CALENDEM_EFFECTS_EFFECTS_OF_BONDS_H
#define CALENDEM_EFFECTS_EFFECTS_OF_BONDS_H

#include "effects/effect.h"

namespace calendem {

inline Effect weibull_strength() {
  Effect e = effect("weibull_strength", "bond",
                    "the strength of bonds has a Weibull distribution with the same mean");
  e.parameter = strength({"bond.weibull_modulus"}, "0").log_uniform(1.5, 10).in_reciprocal();
  e.moves = "breaks begin earlier and are spread over more of the curve; porosity hardly changes";
  e.source = "Weibull 1951; a modulus of 3-8 is an unsourced prior for NMC, widened here";
  e.law = "weibull_strength.h";
  e.verification = "strength";
  return e;
}

inline Effect pre_cracks() {
  Effect e = effect("pre_cracks", "bond", "a fraction of the bonds has no strength from the start");
  e.settings = {number("effects.pre_cracks.fraction", "pre_cracks", "0", 0, 0.9, "",
                       "fraction of the bonds without strength")};
  e.parameter = strength(e.settings[0]).log_uniform(0.02, 0.5);
  e.bond_law = "pre_cracks";
  e.moves = "bodies are weaker from the first load on: lower pressure at a displacement, more "
            "cracked bodies";
  e.source = "a random choice of bonds; tomograms show pores and cracks in NMC, an unsourced prior";
  e.law = "pre_cracks.h";
  e.verification = "strength";
  return e;
}

inline Effect body_scatter() {
  Effect e = effect("body_scatter", "bond",
                    "the strength of whole bodies has a lognormal distribution with mean 1");
  e.settings = {number("effects.body_scatter.sd_ln", "body_scatter", "0", 0, 1, "",
                       "standard deviation of the logarithm of strength; seed: bond.seed")};
  e.parameter = strength(e.settings[0]).log_uniform(0.1, 0.8);
  e.bond_law = "body_scatter";
  e.moves = "some bodies break early and others not at all: breaks are spread over the curve, and "
            "there are fewer cracked bodies for the same number of broken bonds";
  e.source = "a Weibull law of modulus m has pi/(m sqrt 6): 0.16-0.43 for 3-8, an unsourced prior "
             "for NMC, widened here";
  e.law = "body_strength.h";
  e.verification = "strength";
  return e;
}

inline Effect body_size() {
  Effect e = effect("body_size", "bond",
                    "large bodies are weaker: strength follows a power law of the diameter");
  e.settings = {
      number("effects.body_size.exponent", "body_size_exponent", "0", 0, 3, "",
             "exponent a in strength ~ d^-a; 3/m for a Weibull modulus m; 0: no effect"),
      number("effects.body_size.reference_um", "body_reference_um", "4.35", 0.1, 100, "um",
             "diameter of a body of unchanged strength; the recipe's particles.median_um")};
  e.parameter = strength(e.settings[0]).log_uniform(0.2, 2);
  e.bond_law = "body_size";
  e.moves = "breaks begin earlier, in the largest bodies; small bodies stay whole";
  e.source = "Weibull 1939; McDowell & Bolton 1998: 3/m of grains; m 3-8 is an unsourced prior for "
             "NMC, widened here";
  e.law = "body_strength.h";
  e.verification = "strength";
  return e;
}

inline std::vector<Effect> effects_of_bonds() {
  return {weibull_strength(), pre_cracks(), body_scatter(), body_size()};
}

} // namespace calendem

#endif
