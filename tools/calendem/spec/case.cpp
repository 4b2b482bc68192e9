// SPDX-License-Identifier: GPL-2.0-or-later
#include "spec/case.h"
#include "physics/hertz_contact.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>

namespace calendem {

const std::vector<Key> &case_keys() {
  static const std::vector<Key> keys = {
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
      {"bond.youngs_modulus_GPa", "E_bond_GPa", "200", 0.01, 1000, "GPa", "of the bond's cylinder"},
      {"bond.poisson", "nu_bond", "0.3", 0, 0.49, "", "Poisson's ratio of the bond"},
      {"bond.radius_ratio", "lambda", "1", 0.05, 1.5, "", "bond radius over the smaller radius"},
      {"bond.tensile_strength_MPa", "sigma_c_MPa", "500", 0.1, 1e5, "MPa", "sigma_c, eq. 6"},
      {"bond.shear_strength_MPa", "tau_c_MPa", "500", 0.1, 1e5, "MPa", "tau_c, eq. 7"},
      {"bond.criterion", "criterion", "signed", 0, 0, "", "sign of F_n in eq. 6",
       "signed|unsigned|as_printed"},
      {"bond.breakable", "breakable", "yes", 0, 0, "", "no: bonds bear any load", "yes|no"},
      {"bond.damping", "bond_damping", "0.02", 0, 1, "", "fraction of critical damping"},
      {"bond.weibull_modulus", "weibull_m", "0", 0, 100, "", "scatter of strength; 0: none"},
      {"bond.seed", "bond_seed", "1", 0, 4e9, "", "of the scatter", "", false, true},
      {"effects.nmc_plasticity.yield_pressure_GPa", "nmc_yield_GPa", "0", 0, 1000, "GPa",
       "limit of the contact pressure between bodies and at the platen; 0: elastic"},
      {"effects.collector_indentation.yield_pressure_GPa", "collector_yield_GPa", "0", 0, 1000,
       "GPa", "limit of the contact pressure of bodies on the collector; 0: elastic"},
      {"effects.cbd_collapse.yield_pressure_MPa", "cbd_yield_MPa", "0", 0, 1e5, "MPa",
       "mean pressure of a CBD sphere at which its nanopores begin to collapse; 0: never"},
      {"effects.cbd_collapse.hardening_MPa", "cbd_hardening_MPa", "50", 0.1, 1e5, "MPa",
       "pressure scale of the fall above the yield pressure"},
      {"effects.cbd_collapse.initial_nanoporosity", "cbd_initial_phi", "0.5", 0, 0.95, "fraction",
       "the recipe's cbd.nanoporosity_percent"},
      {"effects.cbd_collapse.floor_nanoporosity", "cbd_floor_phi", "0.27", 0, 0.95, "fraction",
       "what no pressure goes below"},
      {"effects.cbd_collapse.relaxation_us", "cbd_collapse_us", "0.1", 1e-3, 1e3, "us",
       "time in which nanopores follow their pressure; some transits of a pressure wave"},
      {"effects.cbd_collapse.every_steps", "cbd_collapse_steps", "50", 1, 1e6, "steps",
       "between updates of the nanopores", "", false, true},
      {"imposed.cbd_nanoporosity_until_MPa", "cbd_imposed_MPa", "0", 0, 2000, "MPa",
       "pressure of the platen up to which nanoporosity falls from initial to floor in all CBD "
       "alike, as Xu et al. impose it; 0: it does not"},
      {"effects.cbd_viscoelasticity.relaxed_fraction", "cbd_relaxed_fraction", "0", 0, 0.95,
       "fraction", "of the stiffness of contacts with CBD that relaxes; 0: elastic"},
      {"effects.cbd_viscoelasticity.time_us", "cbd_relaxation_us", "1", 1e-3, 1e6, "us",
       "relaxation time; the run's own time counts, see platen.speed_m_s"},
      {"platen.control", "control", "pressure", 0, 0, "", "what the platen goes down to",
       "pressure|thickness|displacement"},
      {"platen.max_pressure_MPa", "p_max_MPa", "150", 0.1, 2000, "MPa", "with control = pressure"},
      {"platen.thickness_um", "h_target_um", "0", 0, 1000, "um", "with control = thickness"},
      {"platen.displacement_um", "d_target_um", "0", 0, 1000, "um", "with control = displacement"},
      {"platen.speed_m_s", "speed_m_s", "1", 1e-4, 20, "m/s", "under load"},
      {"platen.touch_speed_m_s", "touch_speed_m_s", "1", 1e-4, 20, "m/s",
       "below touch_pressure_MPa"},
      {"platen.touch_pressure_MPa", "touch_pressure_MPa", "5", 0, 1000, "MPa",
       "ends the slow approach"},
      {"platen.release_speed_m_s", "release_speed_m_s", "1", 1e-4, 20, "m/s", "upwards"},
      {"platen.ramp_us", "ramp_us", "0.5", 0, 1e4, "us", "from rest to the speed; 0: at once"},
      {"platen.dwell_us", "dwell_us", "0", 0, 1e4, "us", "at the target"},
      {"platen.contact_lost_fraction", "lost_fraction", "0.01", 1e-4, 0.5, "",
       "contact is lost below this fraction of the maximum pressure"},
      {"effects.pre_cracks.fraction", "pre_cracks", "0", 0, 0.9, "",
       "of the bonds, without strength"},
      {"effects.machine_compliance.um_per_MPa", "compliance_um_MPa", "0", 0, 1, "um/MPa",
       "of frame and rolls, in the displacement shown"},
      {"effects.pressure_calibration.factor", "pressure_factor", "1", 0.2, 5, "",
       "pressure shown over pressure"},
      {"effects.thickness_zero.offset_um", "", "0", -50, 50, "um", "added to the thickness shown"},
      {"numerics.timestep_us", "dt_us", "0", 0, 1, "us", "0: timestep_fraction of the bound"},
      {"numerics.timestep_fraction", "dt_fraction", "0.8", 0.01, 1, "", "of the bond-aware bound"},
      {"numerics.average_us", "average_us", "0", 0, 100, "us",
       "averaging window of pressure and gap; 0: 0.1 um at the platen's highest speed"},
      {"numerics.gravity_m_s2", "gravity_m_s2", "9.81", 0, 1e4, "m/s2", "along -z; 0: none"},
      {"output.every_us", "every_us", "0.1", 1e-3, 1000, "us",
       "between rows of the curve; at most 0.1 um at the platen's highest speed"},
      {"output.vtk_every_us", "vtk_every_us", "2", 1e-3, 1e4, "us", "between frames"},
      {"output.restart_every_us", "restart_every_us", "5", 1e-2, 1e5, "us",
       "between restart files"},
  };
  return keys;
}

namespace {

// Overlap at which cohesion and Hertz repulsion balance, over the radius of two equal spheres.
double overlap_over_radius(const Settings &s, const std::string &a, const std::string &b) {
  const auto of = [&](const std::string &phase, const char *key) {
    return s.number("material." + phase + "." + key);
  };
  const double ced = 1e-3 * std::sqrt(of(a, "ced_J_m3") * of(b, "ced_J_m3"));
  const double E = effective_modulus(1e6 * of(a, "youngs_modulus_GPa"), of(a, "poisson"),
                                     1e6 * of(b, "youngs_modulus_GPa"), of(b, "poisson"));
  return sjkr_equilibrium_overlap(ced, E, 0.5);
}

// AM against CBD is allowed more: the paper's own values give 0.07.
void check_collapse(const Settings &s, const std::string &a, const std::string &b, double limit,
                    Mistakes &mistakes) {
  const std::string at_a = "material." + a + ".", at_b = "material." + b + ".";
  if (!s.sound({at_a + "ced_J_m3", at_a + "youngs_modulus_GPa", at_a + "poisson", at_b + "ced_J_m3",
                at_b + "youngs_modulus_GPa", at_b + "poisson"}))
    return;
  const double overlap = overlap_over_radius(s, a, b);
  if (overlap > limit)
    mistakes.add(
        std::max(s.line(at_a + "ced_J_m3"), s.line(at_b + "ced_J_m3")),
        fmt::format("cohesion would collapse the packing: it pulls {} spheres into each other by "
                    "{:.3g} of their radius, at most {} is allowed. The overlap scales as "
                    "(CED/E)^2: lower ced_J_m3 ({}) or raise youngs_modulus_GPa ({}).",
                    a == b ? a : a + " and " + b, overlap, limit,
                    a == b ? s.text(at_a + "ced_J_m3")
                           : s.text(at_a + "ced_J_m3") + " and " + s.text(at_b + "ced_J_m3"),
                    a == b ? s.text(at_a + "youngs_modulus_GPa")
                           : s.text(at_a + "youngs_modulus_GPa") + " and " +
                                 s.text(at_b + "youngs_modulus_GPa")));
}

// A contact that yields below 2 CED cannot carry its own cohesion (physics/plastic_contact.h).
void check_yield(const Settings &s, Mistakes &mistakes) {
  const std::string key = "effects.nmc_plasticity.yield_pressure_GPa";
  if (!s.sound({key, "material.am.ced_J_m3"}))
    return;
  const double least = 2.5e-9 * s.number("material.am.ced_J_m3");
  if (s.number(key) > 0.0 && s.number(key) < least)
    mistakes.add(s.line(key),
                 fmt::format("{} is {} GPa, below 2.5 times material.am.ced_J_m3 = {}: such "
                             "contacts cannot carry their own cohesion and the packing collapses. "
                             "Give 0 (elastic) or at least {:.3g} GPa; NMC's is 1 to 12 GPa.",
                             key, s.text(key), s.text("material.am.ced_J_m3"), least));
}

// What relaxes in a contact leaves cohesion a softer one: the overlap grows by 1/(1 - g)^2.
void check_relaxed(const Settings &s, Mistakes &mistakes) {
  const std::string key = "effects.cbd_viscoelasticity.relaxed_fraction";
  for (const std::string phase : {"am", "cbd"}) {
    const std::string at = "material." + phase + ".", cbd = "material.cbd.";
    if (!s.sound({key, at + "ced_J_m3", at + "youngs_modulus_GPa", at + "poisson", cbd + "ced_J_m3",
                  cbd + "youngs_modulus_GPa", cbd + "poisson"}))
      continue;
    const double left = 1.0 - s.number(key);
    const double overlap = overlap_over_radius(s, phase, "cbd") / (left * left);
    if (left < 1.0 && overlap > 0.3)
      mistakes.add(
          s.line(key),
          fmt::format("{} is {}: once relaxed, cohesion pulls {} and cbd spheres into each "
                      "other by {:.3g} of their radius; at most 0.3 is allowed, or the "
                      "packing collapses. Lower it or the ced_J_m3.",
                      key, s.text(key), phase, overlap));
  }
}

void check_floor(const Settings &s, Mistakes &mistakes) {
  const std::string at = "effects.cbd_collapse.";
  const std::string floor = at + "floor_nanoporosity", initial = at + "initial_nanoporosity";
  if (s.sound({floor, initial}) && s.number(floor) > s.number(initial))
    mistakes.add(s.line(floor), fmt::format("{} is {}, above {} = {}: pores would open under "
                                            "pressure. Give a value at or below it.",
                                            floor, s.text(floor), initial, s.text(initial)));
}

void check_imposed(const Settings &s, Mistakes &mistakes) {
  const std::string law = "effects.cbd_collapse.yield_pressure_MPa",
                    imposed = "imposed.cbd_nanoporosity_until_MPa";
  if (s.sound({law, imposed}) && s.number(law) > 0.0 && s.number(imposed) > 0.0)
    mistakes.add(s.line(imposed), fmt::format("{} is {} and {} is {}: nanoporosity follows either "
                                              "the pressure of each sphere or the platen's. Set "
                                              "one of them to 0.",
                                              imposed, s.text(imposed), law, s.text(law)));
}

void check_target(const Settings &s, Mistakes &mistakes) {
  const std::string control = s.text("platen.control");
  if (control == "pressure" || !s.sound({"platen.control", "platen." + control + "_um"}))
    return;
  const std::string key = "platen." + control + "_um";
  if (s.number(key) <= 0.0)
    mistakes.add(s.line("platen.control"),
                 fmt::format("platen.control is \"{}\" but {} is {}; give a value > 0 um.", control,
                             key, s.number(key)));
}

const char *const kSpeeds[] = {"platen.speed_m_s", "platen.touch_speed_m_s",
                               "platen.release_speed_m_s"};

/// The key of the platen's highest speed.
std::string highest_speed(const Settings &s) {
  return *std::max_element(std::begin(kSpeeds), std::end(kSpeeds),
                           [&](const char *a, const char *b) { return s.number(a) < s.number(b); });
}

void check_window(const Settings &s, Mistakes &mistakes) {
  const std::string key = "numerics.average_us";
  if (!s.sound({key, kSpeeds[0], kSpeeds[1], kSpeeds[2]}))
    return;
  const std::string speed = highest_speed(s);
  const double travel = s.number(key) * s.number(speed);
  if (travel > kAverageTravel * (1.0 + 1e-9))
    mistakes.add(s.line(key),
                 fmt::format("{} is {}: in that time the platen moves {:.3g} um at {} = {} m/s, at "
                             "most {} um is allowed, or pressure and gap are averaged over a bend "
                             "of the curve. Give at most {:.3g} us, or 0, which is just that; or "
                             "lower the speed.",
                             key, s.text(key), travel, speed, s.text(speed), kAverageTravel,
                             kAverageTravel / s.number(speed)));
}

} // namespace

double averaging_window(const Settings &s) {
  const double given = s.number("numerics.average_us");
  return given > 0.0 ? given : kAverageTravel / s.number(highest_speed(s));
}

void check_case(const Settings &s, Mistakes &mistakes) {
  check_collapse(s, "am", "am", 0.1, mistakes);
  check_collapse(s, "cbd", "cbd", 0.1, mistakes);
  check_collapse(s, "am", "cbd", 0.2, mistakes);
  check_yield(s, mistakes);
  check_floor(s, mistakes);
  check_imposed(s, mistakes);
  check_relaxed(s, mistakes);
  check_target(s, mistakes);
  check_window(s, mistakes);
}

Settings read_case(const std::string &file) {
  namespace fs = std::filesystem;
  Mistakes mistakes(file);
  Settings s = read_toml(file, FileKind::Case, case_keys(), mistakes);
  check_case(s, mistakes);
  mistakes.stop_if_any();
  const fs::path electrode = s.text("electrode");
  s.set("electrode",
        (electrode.is_absolute() ? electrode : fs::absolute(file).parent_path() / electrode)
            .lexically_normal()
            .string());
  return s;
}

} // namespace calendem
