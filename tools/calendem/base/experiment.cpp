// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/experiment.h"
#include "base/pi.h"

namespace calendem {

double sample_area_cm2(const Experiment &e) {
  return kPi / 400.0 * e.sample_diameter_mm * e.sample_diameter_mm;
}

double foil_mg_cm2(const Experiment &e) {
  return 0.1 * e.foil_thickness_um * e.foil_density_g_cm3; // um g/cm3 -> mg/cm2
}

double coating_thickness_um(const Experiment &e, const Measured &thickness) {
  return thickness.value - (thickness.includes_foil ? e.foil_thickness_um : 0.0);
}

double coating_loading_mg_cm2(const Experiment &e, const Measured &mass) {
  return mass.value / sample_area_cm2(e) - (mass.includes_foil ? foil_mg_cm2(e) : 0.0);
}

double solid_thickness_um(const Experiment &e, double loading_mg_cm2) {
  return 10.0 * loading_mg_cm2 *
         (e.recipe.am_weight / e.recipe.am_density +
          (1.0 - e.recipe.am_weight) / e.recipe.cbd_solid_density);
}

} // namespace calendem
