// SPDX-License-Identifier: GPL-2.0-or-later
#include "effects/settings.h"

namespace calendem {
namespace {

/// A phase, its short name in the scripts, and the defaults of its settings; no cohesion: it has none.
struct PhaseSettings {
  const char *phase, *name, *what, *modulus, *poisson, *friction, *restitution, *cohesion;
};
constexpr PhaseSettings kPhases[] = {
    {"am", "am", "the active material", "200", "0.3", "0.001", "0.15", "6e8"},
    {"cbd", "cbd", "the carbon-binder domain", "2", "0.49", "0.001", "0.15", "7e7"},
    {"collector", "col", "the collector", "69", "0.3", "1.2", "0.5", nullptr},
    {"platen", "plt", "the platen", "200", "0.3", "0.76", "0.78", nullptr}};

void add_phase(const PhaseSettings &p, std::vector<Key> &keys) {
  const std::string at = std::string("material.") + p.phase + ".", of = p.name;
  keys.push_back(number(at + "youngs_modulus_GPa", "E_" + of + "_GPa", p.modulus, 0.01, 1000, "GPa",
                        std::string("Young's modulus of ") + p.what));
  keys.push_back(number(at + "poisson", "nu_" + of, p.poisson, 0, 0.49, "", "Poisson's ratio"));
  keys.push_back(
      number(at + "friction", "mu_" + of, p.friction, 0, 2, "", "coefficient of friction"));
  keys.push_back(number(at + "restitution", "e_" + of, p.restitution, 0.051, 1, "",
                        "coefficient of restitution"));
  if (p.cohesion)
    keys.push_back(number(at + "ced_J_m3", "ced_" + of + "_J_m3", p.cohesion, 0, 1e11, "J/m3",
                          "cohesion energy density, eq. 3; the default is from a script for sjkr2, "
                          "where the force is twice as large"));
}

// NOLINTNEXTLINE(readability-function-size): a table, one row for each setting
std::vector<Key> base_settings() {
  return {
      setting("bond.youngs_modulus_GPa", "E_bond_GPa")
          .follows("material.am.youngs_modulus_GPa")
          .range(0.01, 1000, "GPa")
          .means("Young's modulus of the bond's cylinder"),
      setting("bond.poisson", "nu_bond")
          .follows("material.am.poisson")
          .range(0, 0.49)
          .means("Poisson's ratio of the bond"),
      number("bond.radius_ratio", "lambda", "1", 0.05, 1.5, "",
             "bond radius divided by the smaller radius of the two spheres"),
      number("bond.tensile_strength_MPa", "sigma_c_MPa", "500", 0.1, 1e5, "MPa",
             "tensile strength sigma_c, eq. 6"),
      number("bond.shear_strength_MPa", "tau_c_MPa", "500", 0.1, 1e5, "MPa",
             "shear strength tau_c, eq. 7"),
      setting("bond.criterion", "criterion", "signed")
          .one_of("signed|unsigned|as_printed")
          .means("sign of F_n in eq. 6"),
      setting("bond.breakable", "breakable", "yes").one_of("yes|no").means("no: bonds never break"),
      setting("bond.contact_diameter", "contact_diameter", "radii")
          .one_of("radii|lattice")
          .means("distance at which primaries of one body touch if they were never bonded or have "
                 "separated since: the sum of their radii, or the spacing of their lattice"),
      number("bond.surface_inset_um", "surface_inset", "0", 0, 0.3, "um",
             "how far inside the tips of its primaries the surface of a body lies, for other "
             "bodies and CBD; 0: at the tips"),
      number("bond.inset_fading", "inset_fading", "0", 0, 1, "fraction",
             "how much less deep a primary with fewer than six bonds lies; 1: in proportion to its "
             "bonds, so that fragments and small bodies keep their volume; 0: no less"),
      number("bond.damping", "bond_damping", "0.02", 0, 1, "", "fraction of critical damping"),
      number("bond.weibull_modulus", "weibull_m", "0", 0, 100, "",
             "Weibull modulus of the bond strength, at least 1; 0: no scatter"),
      setting("bond.seed", "bond_seed", "1")
          .range(0, 4e9)
          .is_whole()
          .means("seed of the scatter of strength"),
      number("imposed.cbd_nanoporosity_until_MPa", "cbd_imposed_MPa", "0", 0, 2000, "MPa",
             "pressure of the platen at which the nanoporosity of all CBD has decreased from "
             "initial to floor, as Xu et al. impose it; 0: not imposed"),
      setting("platen.control", "control", "pressure")
          .one_of("pressure|thickness|displacement|roll_gap")
          .means("what the platen moves to"),
      number("platen.max_pressure_MPa", "p_max_MPa", "150", 0.1, 2000, "MPa",
             "target, with control = pressure"),
      number("platen.thickness_um", "h_target_um", "0", 0, 1000, "um",
             "target, with control = thickness"),
      number("platen.displacement_um", "d_target_um", "0", 0, 1000, "um",
             "target, with control = displacement"),
      number("platen.roll_gap_um", "roll_gap_um", "0", 0, 1000, "um",
             "with control = roll_gap: thickness of the film between the loaded rolls, without "
             "foil; with line_load_N_mm the first gap to try"),
      number("platen.speed_m_s", "speed_m_s", "1", 1e-4, 20, "m/s",
             "speed under load; under a roll the largest speed of closing and of slip"),
      number("platen.touch_speed_m_s", "touch_speed_m_s", "1", 1e-4, 20, "m/s",
             "speed below touch_pressure_MPa"),
      number("platen.touch_pressure_MPa", "touch_pressure_MPa", "5", 0, 1000, "MPa",
             "pressure that ends the slow approach"),
      number("platen.release_speed_m_s", "release_speed_m_s", "1", 1e-4, 20, "m/s",
             "speed upwards"),
      number("platen.ramp_us", "ramp_us", "0.5", 0, 1e4, "us",
             "time from rest to full speed; 0: at once"),
      number("platen.dwell_us", "dwell_us", "0", 0, 1e4, "us", "time at the target"),
      setting("platen.presses", "presses", "1")
          .range(1, 20)
          .is_whole()
          .means("how many times the platen goes to the target and up again"),
      number("platen.first_pressure_MPa", "first_pressure_MPa", "0", 0, 2000, "MPa",
             "target of the first of several presses; the others follow up to max_pressure_MPa; 0: "
             "all have max_pressure_MPa"),
      setting("platen.spacing", "press_spacing", "step")
          .one_of("step|ratio")
          .means("how the targets of presses grow from the first to the last: by equal steps or "
                 "by equal ratios"),
      number("platen.contact_lost_fraction", "lost_fraction", "0.01", 1e-4, 0.5, "",
             "contact is lost below this fraction of the maximum pressure"),
      number("roll.radius_mm", "roll_radius_mm", "200", 1, 2000, "mm",
             "radius of the roll on the film"),
      setting("roll.counter_radius_mm", "counter_radius_mm")
          .follows("roll.radius_mm")
          .range(0, 2000, "mm")
          .means("radius of the roll behind the collector; 0: flat"),
      number("roll.line_load_N_mm", "", "0", 0, 1e5, "N/mm",
             "line load of the last pass; the gap is iterated to meet it; 0: platen.roll_gap_um is "
             "the gap"),
      number("roll.line_load_tolerance", "", "0.02", 1e-3, 0.5, "",
             "allowed relative deviation from the line load"),
      number("roll.line_speed_m_min", "line_speed_m_min", "0.5", 1e-3, 1000, "m/min",
             "speed of the web; only used to report the ratio of simulated to real speed and the "
             "time in the last nip"),
      number("roll.slip", "roll_slip", "0", 0, 0.1, "",
             "relative speed of the roll's surface ahead of the web"),
      setting("roll.passes", "roll_passes", "1")
          .range(1, 20)
          .is_whole()
          .means("number of passes under the roll"),
      number("roll.first_gap_um", "first_gap_um", "0", 0, 1000, "um",
             "gap of the first of several passes; the others follow in equal steps to roll_gap_um; "
             "0: all have roll_gap_um"),
      number("roll.elongation_percent", "elongation_percent", "0", 0, 5, "%",
             "permanent elongation of foil and film along the web, in proportion to the reduction "
             "of the gap"),
      number("numerics.timestep_us", "dt_us", "0", 0, 1, "us",
             "time step, at least 1e-6; 0: timestep_fraction of the bound"),
      number("numerics.timestep_fraction", "dt_fraction", "0.8", 0.01, 1, "",
             "time step as a fraction of its bound"),
      number("numerics.average_us", "average_us", "0", 0, 100, "us",
             "averaging window of pressure and gap; 0: 0.1 um at the platen's highest speed"),
      number("numerics.gravity_m_s2", "gravity_m_s2", "9.81", 0, 1e4, "m/s2",
             "gravity along -z; 0: none"),
      number("output.every_us", "every_us", "0.1", 1e-3, 1000, "us",
             "time between rows of the curve; at most 0.1 um at the platen's highest speed"),
      number("output.vtk_every_us", "vtk_every_us", "2", 1e-3, 1e4, "us", "time between frames"),
      number("output.restart_every_us", "restart_every_us", "5", 1e-2, 1e5, "us",
             "time between restart files; LIGGGHTS rebuilds its neighbour lists at each, so that "
             "another interval gives another run")};
}

} // namespace

const std::vector<Key> &case_keys() {
  static const std::vector<Key> all = [] {
    std::vector<Key> keys = {setting("electrode", "electrode")
                                 .is_text()
                                 .means("folder of the electrode, made by calendem pack")};
    for (const PhaseSettings &phase : kPhases)
      add_phase(phase, keys);
    const std::vector<Key> others = base_settings();
    keys.insert(keys.end(), others.begin(), others.end());
    add_settings_of_effects(false, keys);
    return keys;
  }();
  return all;
}

} // namespace calendem
