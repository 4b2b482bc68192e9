// SPDX-License-Identifier: GPL-2.0-or-later
// All effects, in the order in which they are told.
#ifndef CALENDEM_REGISTRY_EFFECTS_H
#define CALENDEM_REGISTRY_EFFECTS_H

#include "registry/effects_of_bonds.h"
#include "registry/effects_of_contacts.h"
#include "registry/effects_of_the_press.h"

namespace calendem {

inline const std::vector<Effect> &effects() {
  static const std::vector<Effect> table = {
      friction(),         nmc_plasticity(),  cbd_collapse(),       cbd_viscoelasticity(),
      cbd_plasticity(),   cbd_confinement(), nmc_confinement(),    collector_indentation(),
      weibull_strength(), pre_cracks(),      machine_compliance(), pressure_calibration(),
      thickness_zero(),
  };
  return table;
}

} // namespace calendem

#endif
