// SPDX-License-Identifier: GPL-2.0-or-later
// The settings of a calendering run: one row each, those of the base model here, those of an effect
// in its own row. From them come the keys of case.toml, the variables and defaults of the input
// scripts, and what these write into settings.txt. Keys of a table stand together.
#ifndef CALENDEM_REGISTRY_SETTINGS_H
#define CALENDEM_REGISTRY_SETTINGS_H

#include "registry/effects.h"

namespace calendem {

// NOLINTNEXTLINE(readability-function-size): a table, one row for each setting
inline std::vector<Key> base_settings() {
  return {
      {"electrode", "electrode", "", 0, 0, "", "folder made by calendem pack", "", true},
      {"material.am.youngs_modulus_GPa", "E_am_GPa", "200", 0.01, 1000, "GPa", "active material"},
      {"material.am.poisson", "nu_am", "0.3", 0, 0.49, "", "Poisson's ratio"},
      {"material.am.friction", "mu_am", "0.001", 0, 2, "", "coefficient of friction"},
      {"material.am.restitution", "e_am", "0.15", 0.051, 1, "", "coefficient of restitution"},
      {"material.am.ced_J_m3", "ced_am_J_m3", "6e8", 0, 1e11, "J/m3",
       "cohesion energy density, eq. 3; default from an sjkr2 deck, where it pulls twice as hard"},
      {"material.cbd.youngs_modulus_GPa", "E_cbd_GPa", "2", 0.01, 1000, "GPa",
       "carbon-binder domain"},
      {"material.cbd.poisson", "nu_cbd", "0.49", 0, 0.49, "", "Poisson's ratio"},
      {"material.cbd.friction", "mu_cbd", "0.001", 0, 2, "", "coefficient of friction"},
      {"material.cbd.restitution", "e_cbd", "0.15", 0.051, 1, "", "coefficient of restitution"},
      {"material.cbd.ced_J_m3", "ced_cbd_J_m3", "7e7", 0, 1e11, "J/m3",
       "cohesion energy density, eq. 3; default from an sjkr2 deck, where it pulls twice as hard"},
      {"material.collector.youngs_modulus_GPa", "E_col_GPa", "69", 0.01, 1000, "GPa", "collector"},
      {"material.collector.poisson", "nu_col", "0.3", 0, 0.49, "", "Poisson's ratio"},
      {"material.collector.friction", "mu_col", "1.2", 0, 2, "", "coefficient of friction"},
      {"material.collector.restitution", "e_col", "0.5", 0.051, 1, "",
       "coefficient of restitution"},
      {"material.platen.youngs_modulus_GPa", "E_plt_GPa", "200", 0.01, 1000, "GPa", "platen"},
      {"material.platen.poisson", "nu_plt", "0.3", 0, 0.49, "", "Poisson's ratio"},
      {"material.platen.friction", "mu_plt", "0.76", 0, 2, "", "coefficient of friction"},
      {"material.platen.restitution", "e_plt", "0.78", 0.051, 1, "", "coefficient of restitution"},
      {"bond.youngs_modulus_GPa", "E_bond_GPa", "", 0.01, 1000, "GPa", "of the bond's cylinder", "",
       false, false, "material.am.youngs_modulus_GPa"},
      {"bond.poisson", "nu_bond", "", 0, 0.49, "", "Poisson's ratio of the bond", "", false, false,
       "material.am.poisson"},
      {"bond.radius_ratio", "lambda", "1", 0.05, 1.5, "", "bond radius over the smaller radius"},
      {"bond.tensile_strength_MPa", "sigma_c_MPa", "500", 0.1, 1e5, "MPa", "sigma_c, eq. 6"},
      {"bond.shear_strength_MPa", "tau_c_MPa", "500", 0.1, 1e5, "MPa", "tau_c, eq. 7"},
      {"bond.criterion", "criterion", "signed", 0, 0, "", "sign of F_n in eq. 6",
       "signed|unsigned|as_printed"},
      {"bond.breakable", "breakable", "yes", 0, 0, "", "no: bonds bear any load", "yes|no"},
      {"bond.contact_diameter", "contact_diameter", "radii", 0, 0, "",
       "at which primaries of one body meet that are not bonded, nor have touched since their bond "
       "broke: the sum of their radii, or the spacing of their lattice",
       "radii|lattice"},
      {"bond.damping", "bond_damping", "0.02", 0, 1, "", "fraction of critical damping"},
      {"bond.weibull_modulus", "weibull_m", "0", 0, 100, "",
       "scatter of strength, at least 1; 0: none"},
      {"bond.seed", "bond_seed", "1", 0, 4e9, "", "of the scatter", "", false, true},
      {"imposed.cbd_nanoporosity_until_MPa", "cbd_imposed_MPa", "0", 0, 2000, "MPa",
       "pressure of the platen up to which nanoporosity falls from initial to floor in all CBD "
       "alike, as Xu et al. impose it; 0: it does not"},
      {"platen.control", "control", "pressure", 0, 0, "", "target of the platen's descent",
       "pressure|thickness|displacement|roll_gap"},
      {"platen.max_pressure_MPa", "p_max_MPa", "150", 0.1, 2000, "MPa", "with control = pressure"},
      {"platen.thickness_um", "h_target_um", "0", 0, 1000, "um", "with control = thickness"},
      {"platen.displacement_um", "d_target_um", "0", 0, 1000, "um", "with control = displacement"},
      {"platen.roll_gap_um", "roll_gap_um", "0", 0, 1000, "um",
       "with control = roll_gap: film between the loaded rolls, without foil; with line_load_N_mm "
       "where the search begins"},
      {"platen.speed_m_s", "speed_m_s", "1", 1e-4, 20, "m/s",
       "under load; under a roll the largest of closing and of slip"},
      {"platen.touch_speed_m_s", "touch_speed_m_s", "1", 1e-4, 20, "m/s",
       "below touch_pressure_MPa"},
      {"platen.touch_pressure_MPa", "touch_pressure_MPa", "5", 0, 1000, "MPa",
       "ends the slow approach"},
      {"platen.release_speed_m_s", "release_speed_m_s", "1", 1e-4, 20, "m/s", "upwards"},
      {"platen.ramp_us", "ramp_us", "0.5", 0, 1e4, "us", "from rest to the speed; 0: at once"},
      {"platen.dwell_us", "dwell_us", "0", 0, 1e4, "us", "at the target"},
      {"platen.contact_lost_fraction", "lost_fraction", "0.01", 1e-4, 0.5, "",
       "contact is lost below this fraction of the maximum pressure"},
      {"roll.radius_mm", "roll_radius_mm", "200", 1, 2000, "mm", "of the roll on the film"},
      {"roll.counter_radius_mm", "counter_radius_mm", "", 0, 2000, "mm",
       "of the roll behind the collector; 0: flat", "", false, false, "roll.radius_mm"},
      {"roll.line_load_N_mm", "", "0", 0, 1e5, "N/mm",
       "of the last pass; the gap is iterated until it agrees; 0: "
       "platen.roll_gap_um is the gap"},
      {"roll.line_load_tolerance", "", "0.02", 1e-3, 0.5, "",
       "allowed relative deviation from the line load"},
      {"roll.line_speed_m_min", "line_speed_m_min", "0.5", 1e-3, 1000, "m/min",
       "of the web; sets the reported ratio of simulated to real speed"},
      {"roll.slip", "roll_slip", "0", 0, 0.1, "", "surface of the roll ahead of the web, fraction"},
      {"roll.passes", "roll_passes", "1", 1, 20, "", "under the roll", "", false, true},
      {"roll.first_gap_um", "first_gap_um", "0", 0, 1000, "um",
       "of the first of several passes, from which they go to roll_gap_um in equal steps; 0: all "
       "have that"},
      {"roll.elongation_percent", "elongation_percent", "0", 0, 5, "%",
       "of foil and film along the web, in proportion to the fall of the gap; it stays"},
      {"numerics.timestep_us", "dt_us", "0", 0, 1, "us",
       "at least 1e-6; 0: timestep_fraction of the bound"},
      {"numerics.timestep_fraction", "dt_fraction", "0.8", 0.01, 1, "", "of the bond-aware bound"},
      {"numerics.average_us", "average_us", "0", 0, 100, "us",
       "averaging window of pressure and gap; 0: 0.1 um at the platen's highest speed"},
      {"numerics.gravity_m_s2", "gravity_m_s2", "9.81", 0, 1e4, "m/s2", "along -z; 0: none"},
      {"output.every_us", "every_us", "0.1", 1e-3, 1000, "us",
       "between rows of the curve; at most 0.1 um at the platen's highest speed"},
      {"output.vtk_every_us", "vtk_every_us", "2", 1e-3, 1e4, "us", "between frames"},
      {"output.restart_every_us", "restart_every_us", "5", 1e-2, 1e5, "us",
       "between restart files; each ends a step where the host rebuilds its lists, so that another "
       "interval is another run"},
  };
}

inline const std::vector<Key> &case_keys() {
  static const std::vector<Key> all = [] {
    std::vector<Key> keys = base_settings();
    add_settings_of_effects(false, keys);
    return keys;
  }();
  return all;
}

} // namespace calendem

#endif
