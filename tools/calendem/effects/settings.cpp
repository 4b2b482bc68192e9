// SPDX-License-Identifier: GPL-2.0-or-later
#include "effects/settings.h"

namespace calendem {
namespace {

// NOLINTNEXTLINE(readability-function-size): a table, one row for each setting
std::vector<Key> base_settings() {
  return {
      setting("electrode", "electrode")
          .is_text()
          .means("folder of the electrode, made by calendem pack"),
      setting("material.am.youngs_modulus_GPa", "E_am_GPa", "200")
          .range(0.01, 1000, "GPa")
          .means("Young's modulus of the active material"),
      setting("material.am.poisson", "nu_am", "0.3").range(0, 0.49).means("Poisson's ratio"),
      setting("material.am.friction", "mu_am", "0.001")
          .range(0, 2)
          .means("coefficient of friction"),
      setting("material.am.restitution", "e_am", "0.15")
          .range(0.051, 1)
          .means("coefficient of restitution"),
      setting("material.am.ced_J_m3", "ced_am_J_m3", "6e8")
          .range(0, 1e11, "J/m3")
          .means("cohesion energy density, eq. 3; the default is from a script for sjkr2, where "
                 "the force is twice as large"),
      setting("material.cbd.youngs_modulus_GPa", "E_cbd_GPa", "2")
          .range(0.01, 1000, "GPa")
          .means("Young's modulus of the carbon-binder domain"),
      setting("material.cbd.poisson", "nu_cbd", "0.49").range(0, 0.49).means("Poisson's ratio"),
      setting("material.cbd.friction", "mu_cbd", "0.001")
          .range(0, 2)
          .means("coefficient of friction"),
      setting("material.cbd.restitution", "e_cbd", "0.15")
          .range(0.051, 1)
          .means("coefficient of restitution"),
      setting("material.cbd.ced_J_m3", "ced_cbd_J_m3", "7e7")
          .range(0, 1e11, "J/m3")
          .means("cohesion energy density, eq. 3; the default is from a script for sjkr2, where "
                 "the force is twice as large"),
      setting("material.collector.youngs_modulus_GPa", "E_col_GPa", "69")
          .range(0.01, 1000, "GPa")
          .means("Young's modulus of the collector"),
      setting("material.collector.poisson", "nu_col", "0.3")
          .range(0, 0.49)
          .means("Poisson's ratio"),
      setting("material.collector.friction", "mu_col", "1.2")
          .range(0, 2)
          .means("coefficient of friction"),
      setting("material.collector.restitution", "e_col", "0.5")
          .range(0.051, 1)
          .means("coefficient of restitution"),
      setting("material.platen.youngs_modulus_GPa", "E_plt_GPa", "200")
          .range(0.01, 1000, "GPa")
          .means("Young's modulus of the platen"),
      setting("material.platen.poisson", "nu_plt", "0.3").range(0, 0.49).means("Poisson's ratio"),
      setting("material.platen.friction", "mu_plt", "0.76")
          .range(0, 2)
          .means("coefficient of friction"),
      setting("material.platen.restitution", "e_plt", "0.78")
          .range(0.051, 1)
          .means("coefficient of restitution"),
      setting("bond.youngs_modulus_GPa", "E_bond_GPa")
          .follows("material.am.youngs_modulus_GPa")
          .range(0.01, 1000, "GPa")
          .means("Young's modulus of the bond's cylinder"),
      setting("bond.poisson", "nu_bond")
          .follows("material.am.poisson")
          .range(0, 0.49)
          .means("Poisson's ratio of the bond"),
      setting("bond.radius_ratio", "lambda", "1")
          .range(0.05, 1.5)
          .means("bond radius divided by the smaller radius of the two spheres"),
      setting("bond.tensile_strength_MPa", "sigma_c_MPa", "500")
          .range(0.1, 1e5, "MPa")
          .means("tensile strength sigma_c, eq. 6"),
      setting("bond.shear_strength_MPa", "tau_c_MPa", "500")
          .range(0.1, 1e5, "MPa")
          .means("shear strength tau_c, eq. 7"),
      setting("bond.criterion", "criterion", "signed")
          .one_of("signed|unsigned|as_printed")
          .means("sign of F_n in eq. 6"),
      setting("bond.breakable", "breakable", "yes").one_of("yes|no").means("no: bonds never break"),
      setting("bond.contact_diameter", "contact_diameter", "radii")
          .one_of("radii|lattice")
          .means("distance at which primaries of one body touch if they were never bonded or have "
                 "separated since: the sum of their radii, or the spacing of their lattice"),
      setting("bond.surface_inset_um", "surface_inset", "0")
          .range(0, 0.3, "um")
          .means("how far inside the tips of its primaries the surface of a body lies, for other "
                 "bodies and CBD; 0: at the tips"),
      setting("bond.inset_fading", "inset_fading", "0")
          .range(0, 1, "fraction")
          .means("part of a primary's inset that is gone once all its bonds are broken, and in "
                 "proportion before; 0: a fragment's surface lies as deep as its body's"),
      setting("bond.damping", "bond_damping", "0.02")
          .range(0, 1)
          .means("fraction of critical damping"),
      setting("bond.weibull_modulus", "weibull_m", "0")
          .range(0, 100)
          .means("Weibull modulus of the bond strength, at least 1; 0: no scatter"),
      setting("bond.seed", "bond_seed", "1")
          .range(0, 4e9)
          .is_whole()
          .means("seed of the scatter of strength"),
      setting("imposed.cbd_nanoporosity_until_MPa", "cbd_imposed_MPa", "0")
          .range(0, 2000, "MPa")
          .means("pressure of the platen at which the nanoporosity of all CBD has decreased from "
                 "initial to floor, as Xu et al. impose it; 0: not imposed"),
      setting("platen.control", "control", "pressure")
          .one_of("pressure|thickness|displacement|roll_gap")
          .means("what the platen moves to"),
      setting("platen.max_pressure_MPa", "p_max_MPa", "150")
          .range(0.1, 2000, "MPa")
          .means("target, with control = pressure"),
      setting("platen.thickness_um", "h_target_um", "0")
          .range(0, 1000, "um")
          .means("target, with control = thickness"),
      setting("platen.displacement_um", "d_target_um", "0")
          .range(0, 1000, "um")
          .means("target, with control = displacement"),
      setting("platen.roll_gap_um", "roll_gap_um", "0")
          .range(0, 1000, "um")
          .means("with control = roll_gap: thickness of the film between the loaded rolls, without "
                 "foil; with line_load_N_mm the first gap to try"),
      setting("platen.speed_m_s", "speed_m_s", "1")
          .range(1e-4, 20, "m/s")
          .means("speed under load; under a roll the largest speed of closing and of slip"),
      setting("platen.touch_speed_m_s", "touch_speed_m_s", "1")
          .range(1e-4, 20, "m/s")
          .means("speed below touch_pressure_MPa"),
      setting("platen.touch_pressure_MPa", "touch_pressure_MPa", "5")
          .range(0, 1000, "MPa")
          .means("pressure that ends the slow approach"),
      setting("platen.release_speed_m_s", "release_speed_m_s", "1")
          .range(1e-4, 20, "m/s")
          .means("speed upwards"),
      setting("platen.ramp_us", "ramp_us", "0.5")
          .range(0, 1e4, "us")
          .means("time from rest to full speed; 0: at once"),
      setting("platen.dwell_us", "dwell_us", "0").range(0, 1e4, "us").means("time at the target"),
      setting("platen.presses", "presses", "1")
          .range(1, 20)
          .is_whole()
          .means("how many times the platen goes to the target and up again"),
      setting("platen.first_pressure_MPa", "first_pressure_MPa", "0")
          .range(0, 2000, "MPa")
          .means("target of the first of several presses; the others follow up to "
                 "max_pressure_MPa; 0: all have max_pressure_MPa"),
      setting("platen.spacing", "press_spacing", "step")
          .one_of("step|ratio")
          .means("how the targets of presses grow from the first to the last: by equal steps or "
                 "by equal ratios"),
      setting("platen.contact_lost_fraction", "lost_fraction", "0.01")
          .range(1e-4, 0.5)
          .means("contact is lost below this fraction of the maximum pressure"),
      setting("roll.radius_mm", "roll_radius_mm", "200")
          .range(1, 2000, "mm")
          .means("radius of the roll on the film"),
      setting("roll.counter_radius_mm", "counter_radius_mm")
          .follows("roll.radius_mm")
          .range(0, 2000, "mm")
          .means("radius of the roll behind the collector; 0: flat"),
      setting("roll.line_load_N_mm", "", "0")
          .range(0, 1e5, "N/mm")
          .means("line load of the last pass; the gap is iterated to meet it; 0: "
                 "platen.roll_gap_um is the gap"),
      setting("roll.line_load_tolerance", "", "0.02")
          .range(1e-3, 0.5)
          .means("allowed relative deviation from the line load"),
      setting("roll.line_speed_m_min", "line_speed_m_min", "0.5")
          .range(1e-3, 1000, "m/min")
          .means("speed of the web; only used to report the ratio of simulated to real speed and "
                 "the time in the last nip"),
      setting("roll.slip", "roll_slip", "0")
          .range(0, 0.1)
          .means("relative speed of the roll's surface ahead of the web"),
      setting("roll.passes", "roll_passes", "1")
          .range(1, 20)
          .is_whole()
          .means("number of passes under the roll"),
      setting("roll.first_gap_um", "first_gap_um", "0")
          .range(0, 1000, "um")
          .means("gap of the first of several passes; the others follow in equal steps to "
                 "roll_gap_um; 0: all have roll_gap_um"),
      setting("roll.elongation_percent", "elongation_percent", "0")
          .range(0, 5, "%")
          .means("permanent elongation of foil and film along the web, in proportion to the "
                 "reduction of the gap"),
      setting("numerics.timestep_us", "dt_us", "0")
          .range(0, 1, "us")
          .means("time step, at least 1e-6; 0: timestep_fraction of the bound"),
      setting("numerics.timestep_fraction", "dt_fraction", "0.8")
          .range(0.01, 1)
          .means("time step as a fraction of its bound"),
      setting("numerics.average_us", "average_us", "0")
          .range(0, 100, "us")
          .means("averaging window of pressure and gap; 0: 0.1 um at the platen's highest speed"),
      setting("numerics.gravity_m_s2", "gravity_m_s2", "9.81")
          .range(0, 1e4, "m/s2")
          .means("gravity along -z; 0: none"),
      setting("output.every_us", "every_us", "0.1")
          .range(1e-3, 1000, "us")
          .means("time between rows of the curve; at most 0.1 um at the platen's highest speed"),
      setting("output.vtk_every_us", "vtk_every_us", "2")
          .range(1e-3, 1e4, "us")
          .means("time between frames"),
      setting("output.restart_every_us", "restart_every_us", "5")
          .range(1e-2, 1e5, "us")
          .means("time between restart files; LIGGGHTS rebuilds its neighbour lists at each, so "
                 "that another interval gives another run")};
}

} // namespace

const std::vector<Key> &case_keys() {
  static const std::vector<Key> all = [] {
    std::vector<Key> keys = base_settings();
    add_settings_of_effects(false, keys);
    return keys;
  }();
  return all;
}

} // namespace calendem
