// SPDX-License-Identifier: GPL-2.0-or-later
// What warm rolls do to the binder: a row, and the settings that it scales.
#ifndef CALENDEM_EFFECTS_EFFECTS_OF_TEMPERATURE_H
#define CALENDEM_EFFECTS_EFFECTS_OF_TEMPERATURE_H

#include "effects/effect.h"
#include "physics/cbd_softening.h"

namespace calendem {

constexpr const char *kTemperature = "effects.cbd_softening.temperature_C";

/// Settings that are smaller by CbdSoftening's factor where the rolls are warm; by the name that the
/// scripts have for it, ${cbd_soft}. common/model.in takes it for those of no contact law.
inline bool softens(const std::string &key) {
  for (const char *one :
       {"material.cbd.youngs_modulus_GPa", "effects.cbd_plasticity.yield_pressure_GPa",
        "effects.cbd_plasticity.hardening_GPa", "effects.cbd_ductility.hardness_GPa",
        "effects.cbd_collapse.yield_pressure_MPa", "effects.cbd_collapse.hardening_MPa"})
    if (key == one)
      return true;
  return false;
}

inline Effect cbd_softening() {
  Effect e =
      effect("cbd_softening", "boundary", "warm rolls or platens soften the carbon-binder domain");
  e.settings = {number(kTemperature, "temperature_C", "25", CbdSoftening::kColdest,
                       CbdSoftening::kHottest, "C",
                       "temperature of rolls or platen, and of the film; the values of the "
                       "material are those at 25")};
  e.parameter = strength(e.settings[0]).uniform(40, 100);
  e.moves = "lower pressure at a displacement and a denser film, more so with more carbon-binder; "
            "with a law of yield or collapse less springback";
  e.source = "carbon black and PVdF 1 : 1 at 25 and 80 C: modulus smaller by 41 %, indents of 1193 "
             "and 1948 nm at equal load (Hong et al. 2026, doi:10.1016/j.ensm.2026.105321)";
  e.law = "cbd_softening.h";
  e.verification = "cbd_softening";
  return e;
}

inline std::vector<Effect> effects_of_temperature() { return {cbd_softening()}; }

} // namespace calendem

#endif
