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
      {"electrode", "electrode", "", 0, 0, "", "folder of the electrode, made by calendem pack", "",
       true},
      {"material.am.youngs_modulus_GPa", "E_am_GPa", "200", 0.01, 1000, "GPa",
       "Young's modulus of the active material"},
      {"material.am.poisson", "nu_am", "0.3", 0, 0.49, "", "Poisson's ratio"},
      {"material.am.friction", "mu_am", "0.001", 0, 2, "", "coefficient of friction"},
      {"material.am.restitution", "e_am", "0.15", 0.051, 1, "", "coefficient of restitution"},
      {"material.am.ced_J_m3", "ced_am_J_m3", "6e8", 0, 1e11, "J/m3",
       "cohesion energy density, eq. 3; the default is from a script for sjkr2, where the force is "
       "twice as large"},
      {"material.cbd.youngs_modulus_GPa", "E_cbd_GPa", "2", 0.01, 1000, "GPa",
       "Young's modulus of the carbon-binder domain"},
      {"material.cbd.poisson", "nu_cbd", "0.49", 0, 0.49, "", "Poisson's ratio"},
      {"material.cbd.friction", "mu_cbd", "0.001", 0, 2, "", "coefficient of friction"},
      {"material.cbd.restitution", "e_cbd", "0.15", 0.051, 1, "", "coefficient of restitution"},
      {"material.cbd.ced_J_m3", "ced_cbd_J_m3", "7e7", 0, 1e11, "J/m3",
       "cohesion energy density, eq. 3; the default is from a script for sjkr2, where the force is "
       "twice as large"},
      {"material.collector.youngs_modulus_GPa", "E_col_GPa", "69", 0.01, 1000, "GPa",
       "Young's modulus of the collector"},
      {"material.collector.poisson", "nu_col", "0.3", 0, 0.49, "", "Poisson's ratio"},
      {"material.collector.friction", "mu_col", "1.2", 0, 2, "", "coefficient of friction"},
      {"material.collector.restitution", "e_col", "0.5", 0.051, 1, "",
       "coefficient of restitution"},
      {"material.platen.youngs_modulus_GPa", "E_plt_GPa", "200", 0.01, 1000, "GPa",
       "Young's modulus of the platen"},
      {"material.platen.poisson", "nu_plt", "0.3", 0, 0.49, "", "Poisson's ratio"},
      {"material.platen.friction", "mu_plt", "0.76", 0, 2, "", "coefficient of friction"},
      {"material.platen.restitution", "e_plt", "0.78", 0.051, 1, "", "coefficient of restitution"},
      {"bond.youngs_modulus_GPa", "E_bond_GPa", "", 0.01, 1000, "GPa",
       "Young's modulus of the bond's cylinder", "", false, false,
       "material.am.youngs_modulus_GPa"},
      {"bond.poisson", "nu_bond", "", 0, 0.49, "", "Poisson's ratio of the bond", "", false, false,
       "material.am.poisson"},
      {"bond.radius_ratio", "lambda", "1", 0.05, 1.5, "",
       "bond radius divided by the smaller radius of the two spheres"},
      {"bond.tensile_strength_MPa", "sigma_c_MPa", "500", 0.1, 1e5, "MPa",
       "tensile strength sigma_c, eq. 6"},
      {"bond.shear_strength_MPa", "tau_c_MPa", "500", 0.1, 1e5, "MPa",
       "shear strength tau_c, eq. 7"},
      {"bond.criterion", "criterion", "signed", 0, 0, "", "sign of F_n in eq. 6",
       "signed|unsigned|as_printed"},
      {"bond.breakable", "breakable", "yes", 0, 0, "", "no: bonds never break", "yes|no"},
      {"bond.contact_diameter", "contact_diameter", "radii", 0, 0, "",
       "distance at which primaries of one body touch if they were never bonded or have separated "
       "since: the sum of their radii, or the spacing of their lattice",
       "radii|lattice"},
      {"bond.surface_inset_um", "surface_inset", "0", 0, 0.3, "um",
       "how far inside the tips of its primaries the surface of a body lies, for other bodies and "
       "CBD; 0: at the tips"},
      {"bond.inset_fading", "inset_fading", "0", 0, 1, "fraction",
       "part of a primary's inset that is gone once all its bonds are broken, and in proportion "
       "before; 0: a fragment's surface lies as deep as its body's"},
      {"bond.damping", "bond_damping", "0.02", 0, 1, "", "fraction of critical damping"},
      {"bond.weibull_modulus", "weibull_m", "0", 0, 100, "",
       "Weibull modulus of the bond strength, at least 1; 0: no scatter"},
      {"bond.seed", "bond_seed", "1", 0, 4e9, "", "seed of the scatter of strength", "", false,
       true},
      {"imposed.cbd_nanoporosity_until_MPa", "cbd_imposed_MPa", "0", 0, 2000, "MPa",
       "pressure of the platen at which the nanoporosity of all CBD has decreased from initial to "
       "floor, as Xu et al. impose it; 0: not imposed"},
      {"platen.control", "control", "pressure", 0, 0, "", "what the platen moves to",
       "pressure|thickness|displacement|roll_gap"},
      {"platen.max_pressure_MPa", "p_max_MPa", "150", 0.1, 2000, "MPa",
       "target, with control = pressure"},
      {"platen.thickness_um", "h_target_um", "0", 0, 1000, "um",
       "target, with control = thickness"},
      {"platen.displacement_um", "d_target_um", "0", 0, 1000, "um",
       "target, with control = displacement"},
      {"platen.roll_gap_um", "roll_gap_um", "0", 0, 1000, "um",
       "with control = roll_gap: thickness of the film between the loaded rolls, without foil; "
       "with line_load_N_mm the first gap to try"},
      {"platen.speed_m_s", "speed_m_s", "1", 1e-4, 20, "m/s",
       "speed under load; under a roll the largest speed of closing and of slip"},
      {"platen.touch_speed_m_s", "touch_speed_m_s", "1", 1e-4, 20, "m/s",
       "speed below touch_pressure_MPa"},
      {"platen.touch_pressure_MPa", "touch_pressure_MPa", "5", 0, 1000, "MPa",
       "pressure that ends the slow approach"},
      {"platen.release_speed_m_s", "release_speed_m_s", "1", 1e-4, 20, "m/s", "speed upwards"},
      {"platen.ramp_us", "ramp_us", "0.5", 0, 1e4, "us",
       "time from rest to full speed; 0: at once"},
      {"platen.dwell_us", "dwell_us", "0", 0, 1e4, "us", "time at the target"},
      {"platen.presses", "presses", "1", 1, 20, "",
       "how many times the platen goes to the target and up again", "", false, true},
      {"platen.contact_lost_fraction", "lost_fraction", "0.01", 1e-4, 0.5, "",
       "contact is lost below this fraction of the maximum pressure"},
      {"roll.radius_mm", "roll_radius_mm", "200", 1, 2000, "mm", "radius of the roll on the film"},
      {"roll.counter_radius_mm", "counter_radius_mm", "", 0, 2000, "mm",
       "radius of the roll behind the collector; 0: flat", "", false, false, "roll.radius_mm"},
      {"roll.line_load_N_mm", "", "0", 0, 1e5, "N/mm",
       "line load of the last pass; the gap is iterated to meet it; 0: platen.roll_gap_um is the "
       "gap"},
      {"roll.line_load_tolerance", "", "0.02", 1e-3, 0.5, "",
       "allowed relative deviation from the line load"},
      {"roll.line_speed_m_min", "line_speed_m_min", "0.5", 1e-3, 1000, "m/min",
       "speed of the web; only used to report the ratio of simulated to real speed and the time in "
       "the last nip"},
      {"roll.slip", "roll_slip", "0", 0, 0.1, "",
       "relative speed of the roll's surface ahead of the web"},
      {"roll.passes", "roll_passes", "1", 1, 20, "", "number of passes under the roll", "", false,
       true},
      {"roll.first_gap_um", "first_gap_um", "0", 0, 1000, "um",
       "gap of the first of several passes; the others follow in equal steps to roll_gap_um; 0: "
       "all have roll_gap_um"},
      {"roll.elongation_percent", "elongation_percent", "0", 0, 5, "%",
       "permanent elongation of foil and film along the web, in proportion to the reduction of the "
       "gap"},
      {"numerics.timestep_us", "dt_us", "0", 0, 1, "us",
       "time step, at least 1e-6; 0: timestep_fraction of the bound"},
      {"numerics.timestep_fraction", "dt_fraction", "0.8", 0.01, 1, "",
       "time step as a fraction of its bound"},
      {"numerics.average_us", "average_us", "0", 0, 100, "us",
       "averaging window of pressure and gap; 0: 0.1 um at the platen's highest speed"},
      {"numerics.gravity_m_s2", "gravity_m_s2", "9.81", 0, 1e4, "m/s2",
       "gravity along -z; 0: none"},
      {"output.every_us", "every_us", "0.1", 1e-3, 1000, "us",
       "time between rows of the curve; at most 0.1 um at the platen's highest speed"},
      {"output.vtk_every_us", "vtk_every_us", "2", 1e-3, 1e4, "us", "time between frames"},
      {"output.restart_every_us", "restart_every_us", "5", 1e-2, 1e5, "us",
       "time between restart files; LIGGGHTS rebuilds its neighbour lists at each, so that another "
       "interval gives another run"},
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
