// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/hidden_changes.h"

namespace calendem {

// Sizes are chosen to be seen, none to be hard; the sources are those of the keys they change.
const std::vector<HiddenChange> &hidden_changes() {
  static const std::vector<HiddenChange> table = {
      {"unsigned_criterion",
       "bonds under compression break as under tension",
       false,
       {{"case.bond.criterion", "unsigned"}}},
      {"weak_in_shear",
       "bonds are weaker in shear than in tension",
       false,
       {{"case.bond.shear_strength_MPa", "", 0.4}}},
      {"cohesion",
       "a tenth of the cohesion energy density of both phases",
       false,
       {{"case.material.am.ced_J_m3", "", 0.1}, {"case.material.cbd.ced_J_m3", "", 0.1}}},
      {"thin_bonds",
       "bonds of 0.7 of the primaries' radius",
       false,
       {{"case.bond.radius_ratio", "", 0.7}}},
      {"narrow_sizes",
       "secondary particles of nearly one size",
       false,
       {{"recipe.particles.sigma_ln", "", 0.4}}},
      {"denser_coating",
       "an initial porosity lower than the recipe says",
       false,
       {{"recipe.coating.porosity_total_percent", "", 0.9}}},
      {"more_binder",
       "three times the carbon and binder that the recipe says",
       false,
       {{"recipe.composition.am_weight_percent", "88"},
        {"recipe.composition.carbon_weight_percent", "6"},
        {"recipe.composition.binder_weight_percent", "6"}}},
      {"displacement_scale", "displacements shown are 8 % too large", false, {}, 1.08},
      {"finer_primaries",
       "bodies of smaller primaries on a closer lattice",
       true,
       {{"recipe.particles.primary_diameter_um", "", 0.88},
        {"recipe.particles.lattice_um", "", 0.88}}},
      {"half_time_step",
       "half the time step",
       true,
       {{"case.numerics.timestep_fraction", "", 0.5}}},
      {"larger_cell",
       "a cell of 1.3 times the sides",
       true,
       {{"recipe.cell.x_um", "", 1.3}, {"recipe.cell.y_um", "", 1.3}}},
      {"half_speed",
       "the platen at half the speed",
       true,
       {{"case.platen.speed_m_s", "", 0.5},
        {"case.platen.touch_speed_m_s", "", 0.5},
        {"case.platen.release_speed_m_s", "", 0.5}}},
  };
  return table;
}

const HiddenChange *find_hidden(const std::string &name) {
  for (const HiddenChange &c : hidden_changes())
    if (c.name == name)
      return &c;
  return nullptr;
}

} // namespace calendem
