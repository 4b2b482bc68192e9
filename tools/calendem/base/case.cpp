// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/recipe.h"
#include "effects/effects_of_temperature.h"
#include "physics/hertz_contact.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <tuple>

namespace calendem {
namespace {

const char *name_of(Phase phase) {
  static const char *const names[] = {"am", "cbd", "collector", "platen"};
  return names[int(phase) - int(Phase::Am)];
}

bool cohesive(Phase phase) { return phase == Phase::Am || phase == Phase::Cbd; }

std::vector<std::string> keys_of(Phase phase) {
  const std::string at = fmt::format("material.{}.", name_of(phase));
  std::vector<std::string> keys = {at + "youngs_modulus_GPa", at + "poisson"};
  if (cohesive(phase))
    keys.push_back(at + "ced_J_m3");
  return keys;
}

bool sound(const Settings &s, const std::vector<std::string> &keys) {
  return std::all_of(keys.begin(), keys.end(), [&](const std::string &k) { return s.sound({k}); });
}

/// What a value is multiplied by where the rolls are warm.
double softening(const Settings &s, const std::string &key) {
  return softens(key) ? CbdSoftening::factor(s.number(kTemperature)) : 1.0;
}

/// For messages on what is softened; empty at room temperature.
std::string at_temperature(const Settings &s) {
  const double factor = CbdSoftening::factor(s.number(kTemperature));
  return factor == 1.0 ? ""
                       : fmt::format(" At {} = {} moduli and limits of CBD are {:.2f} of these.",
                                     kTemperature, s.text(kTemperature), factor);
}

PhasePair pair_of(const Settings &s, Phase a, Phase b) {
  const auto of = [&](Phase phase, const char *key) {
    const std::string name = fmt::format("material.{}.{}", name_of(phase), key);
    return s.number(name) * softening(s, name);
  };
  PhasePair pair = {0.0, effective_modulus(1e6 * of(a, "youngs_modulus_GPa"), of(a, "poisson"),
                                           1e6 * of(b, "youngs_modulus_GPa"), of(b, "poisson"))};
  if (cohesive(a) && cohesive(b))
    pair.cohesion = 1e-3 * std::sqrt(of(a, "ced_J_m3") * of(b, "ced_J_m3"));
  return pair;
}

// AM against CBD is allowed more: the paper's own values give 0.07.
void check_collapse(const Settings &s, Phase first, Phase second, double limit,
                    Mistakes &mistakes) {
  if (!sound(s, keys_of(first)) || !sound(s, keys_of(second)) || !s.sound({kTemperature}))
    return;
  const std::string a = name_of(first), b = name_of(second);
  const std::string at_a = "material." + a + ".", at_b = "material." + b + ".";
  const PhasePair pair = pair_of(s, first, second);
  const double overlap = sjkr_equilibrium_overlap(pair.cohesion, pair.modulus, 0.5);
  if (overlap > limit)
    mistakes.add(std::max(s.line(at_a + "ced_J_m3"), s.line(at_b + "ced_J_m3")),
                 "cohesion would collapse the packing: it pulls {} spheres into each other by "
                 "{:.3g} of their radius, at most {} is allowed. The overlap scales as (CED/E)^2: "
                 "lower ced_J_m3 ({}) or raise youngs_modulus_GPa ({}).{}",
                 a == b ? a : a + " and " + b, overlap, limit,
                 a == b ? s.text(at_a + "ced_J_m3")
                        : s.text(at_a + "ced_J_m3") + " and " + s.text(at_b + "ced_J_m3"),
                 a == b ? s.text(at_a + "youngs_modulus_GPa")
                        : s.text(at_a + "youngs_modulus_GPa") + " and " +
                              s.text(at_b + "youngs_modulus_GPa"),
                 at_temperature(s));
}

// What cohesion and modulus of the phases leave to the strength of a contact law between them.
void check_contact(const Settings &s, const Effect &e, Phase a, Phase b, Mistakes &mistakes) {
  const Key &key = e.settings.front();
  std::vector<std::string> names;
  for (const Key &setting : e.settings)
    names.push_back(setting.name);
  if (!sound(s, names) || !sound(s, keys_of(a)) || !sound(s, keys_of(b)) ||
      !s.sound({kTemperature}))
    return;
  const double factor = script_units(key.unit) * softening(s, key.name),
               value = factor * s.number(key.name);
  PropertyValues values = {};
  for (std::size_t k = 0; k < e.settings.size(); ++k)
    values.at(k) = script_units(e.settings[k].unit) * softening(s, e.settings[k].name) *
                   s.number(e.settings[k].name);
  const ContactLimits limits = e.contact.law->limits(pair_of(s, a, b), values);
  if (value <= 0.0 || (value >= limits.least && value <= limits.most))
    return;
  const bool low = value < limits.least;
  const std::string unit = key.unit == "fraction" ? "" : " " + key.unit;
  mistakes.add(s.line(key.name),
               "{} is {}{}, too {} for {} and {} spheres: {}. Give 0 (off) or {} {:.3g}{}.{}",
               key.name, s.text(key.name), unit, low ? "low" : "high", name_of(std::min(a, b)),
               name_of(std::max(a, b)), limits.why, low ? "at least" : "at most",
               (low ? limits.least : limits.most) / factor, unit, at_temperature(s));
}

// A property that may be only some part of the effective modulus.
void check_part_of_modulus(const Settings &s, const Effect &e, Phase a, Phase b,
                           Mistakes &mistakes) {
  for (std::size_t k = 0; k < e.settings.size(); ++k) {
    const Key &key = e.settings[k];
    const double part = e.contact.law->properties.at(k).most_of_modulus;
    if (!s.sound({key.name}) || !sound(s, keys_of(a)) || !sound(s, keys_of(b)))
      continue;
    const double most = part * pair_of(s, a, b).modulus / script_units(key.unit);
    if (s.number(key.name) > most)
      mistakes.add(s.line(key.name),
                   "{} is {} {}: between {} and {} spheres at most {} of the effective modulus is "
                   "allowed. Give at most {:.3g}.",
                   key.name, s.text(key.name), key.unit, name_of(a), name_of(b), part, most);
  }
}

double units_of(const std::string &name) { return script_units(find_key(case_keys(), name)->unit); }

void check_relation(const Settings &s, const Relation &r, Mistakes &mistakes) {
  if (!s.sound({r.key, r.other}))
    return;
  const double value = s.number(r.key), other = s.number(r.other);
  const double most = r.part * other * units_of(r.other) / units_of(r.key);
  if (r.is == Relation::Is::AtMost && value > most)
    mistakes.add(s.line(r.key), "{} is {}, above {}{} = {}: {}. Give at most {:g}.", r.key,
                 s.text(r.key), r.part == 1.0 ? "" : fmt::format("{:g} of ", r.part), r.other,
                 s.text(r.other), r.why, most);
  if (r.is == Relation::Is::NotBoth && value > 0.0 && other > 0.0)
    mistakes.add(s.line(r.key), "{} is {} and {} is {}: {}. Set one of them to 0.", r.key,
                 s.text(r.key), r.other, s.text(r.other), r.why);
  if (r.is == Relation::Is::Needs && value > 0.0 && other <= 0.0)
    mistakes.add(s.line(r.key), "{} is {} and {} is {}: {}. Give that a value above 0, or this 0.",
                 r.key, s.text(r.key), r.other, s.text(r.other), r.why);
}

// A contact follows one law.
void check_one_law(const Settings &s, const Effect &e, const Effect &f, Mistakes &mistakes) {
  if (!e.contact.law || !f.contact.law || e.contact.law == f.contact.law)
    return;
  const std::string &a = e.settings.front().name, &b = f.settings.front().name;
  const auto &others = f.contact.between;
  const bool meet = std::any_of(
      e.contact.between.begin(), e.contact.between.end(), [&](const std::pair<Phase, Phase> &p) {
        return std::count(others.begin(), others.end(), p) +
                   std::count(others.begin(), others.end(), std::pair(p.second, p.first)) >
               0;
      });
  if (meet)
    check_relation(s, {b, Relation::Is::NotBoth, a, "a contact follows one law"}, mistakes);
}

void check_effect(const Settings &s, const Effect &e, Mistakes &mistakes) {
  for (const auto &[a, b] : e.contact.between) {
    check_contact(s, e, a, b, mistakes);
    check_part_of_modulus(s, e, a, b, mistakes);
  }
  for (const Relation &r : e.relations)
    check_relation(s, r, mistakes);
}

/// Values that are 0 or at least this.
void check_least(const Settings &s, Mistakes &mistakes) {
  for (const auto &[key, least] :
       {std::pair("bond.weibull_modulus", 1.0), std::pair("numerics.timestep_us", 1e-6)})
    if (s.sound({key}) && s.number(key) > 0.0 && s.number(key) < least)
      mistakes.add(s.line(key), "{} is {}; give 0 or at least {:g}.", key, s.text(key), least);
}

/// A target of another control than the case's would not be reached.
void check_other_targets(const Settings &s, Mistakes &mistakes) {
  if (!s.sound({"platen.control"}))
    return;
  const std::string control = s.text("platen.control");
  for (const std::string other : {"thickness", "displacement", "roll_gap"}) {
    const std::string key = "platen." + other + "_um";
    if (other != control && s.sound({key}) && s.number(key) > 0.0)
      mistakes.add(s.line(key),
                   "{} is {} but platen.control is \"{}\": the platen would not stop there. Give "
                   "control = \"{}\", or leave {} out.",
                   key, s.text(key), control, other, key);
  }
}

void check_target(const Settings &s, Mistakes &mistakes) {
  const std::string control = s.text("platen.control");
  if (control == "pressure" || !s.sound({"platen.control", "platen." + control + "_um"}))
    return;
  const std::string key = "platen." + control + "_um";
  if (s.number(key) <= 0.0)
    mistakes.add(s.line("platen.control"),
                 "platen.control is \"{}\" but {} is {}; give a value > 0 um.", control, key,
                 s.number(key));
}

/// Settings a roll does not support or takes under another key.
void check_roll(const Settings &s, Mistakes &mistakes) {
  if (!s.sound({"platen.control"}))
    return;
  if (s.text("platen.control") != "roll_gap") {
    for (const auto &[key, none, why] :
         {std::tuple("roll.line_load_N_mm", 0, "only a roll has a line load"),
          std::tuple("roll.elongation_percent", 0, "the web elongates under a roll only"),
          std::tuple("roll.passes", 1, "a platen goes down platen.presses times")})
      if (s.sound({key}) && s.number(key) > none)
        mistakes.add(
            s.line(key),
            "{} is {} and platen.control is \"{}\": {}. Give control = \"roll_gap\", or {}.", key,
            s.text(key), s.text("platen.control"), why, none);
    return;
  }
  const std::string first = "roll.first_gap_um", gap = "platen.roll_gap_um";
  if (s.sound({first, gap}) && s.number(first) > 0.0 && s.number(first) < s.number(gap))
    mistakes.add(s.line(first),
                 "{} is {}, below {} = {}: passes go from a wider gap to a narrower one. Give at "
                 "least that, or 0: the same gap in all passes.",
                 first, s.text(first), gap, s.text(gap));
  for (const auto &[key, none, why] :
       {std::tuple("platen.dwell_us", 0, "a roll does not stand still in the nip"),
        std::tuple("platen.presses", 1, "a roll goes over the film roll.passes times"),
        std::tuple("effects.machine_compliance.um_per_MPa", 0,
                   "platen.roll_gap_um is the gap of the loaded rolls, frame and all")})
    if (s.sound({key}) && s.number(key) > none)
      mistakes.add(s.line(key), "{} is {} and platen.control is \"roll_gap\": {}. Give {}.", key,
                   s.text(key), why, none);
}

void check_presses(const Settings &s, Mistakes &mistakes) {
  const std::string first = "platen.first_pressure_MPa", last = "platen.max_pressure_MPa";
  if (!s.sound({first, last, "platen.presses", "platen.control"}) || s.number(first) == 0.0)
    return;
  if (s.text("platen.control") != "pressure" || s.number("platen.presses") < 2.0)
    mistakes.add(
        s.line(first),
        "{} is {}, but the platen does not go to several pressures: control is \"{}\", presses is "
        "{}. Give control = \"pressure\" and presses = 2 or more, or leave it out.",
        first, s.text(first), s.text("platen.control"), s.text("platen.presses"));
  else if (s.number(first) > s.number(last))
    mistakes.add(s.line(first),
                 "{} is {}, above {} = {}: presses go from a lower pressure to a higher one. Give "
                 "at most that.",
                 first, s.text(first), last, s.text(last));
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
                 "{} is {}: in that time the platen moves {:.3g} um at {} = {} m/s, at most {} um "
                 "is allowed, or pressure and gap are averaged over a bend of the curve. Give at "
                 "most {:.3g} us, or 0, which is just that; or lower the speed.",
                 key, s.text(key), travel, speed, s.text(speed), kAverageTravel,
                 kAverageTravel / s.number(speed));
}

} // namespace

double averaging_window(const Settings &s) {
  const double given = s.number("numerics.average_us");
  return given > 0.0 ? given : kAverageTravel / s.number(highest_speed(s));
}

std::vector<std::string> slow_speeds(const Settings &s) {
  constexpr double kSlow = 0.1;      // m/s
  constexpr double kStepsAt1 = 15e3; // per um at 1 m/s, with the default material
  std::vector<std::string> out;
  for (const char *key : kSpeeds)
    if (s.number(key) < kSlow)
      out.push_back(
          fmt::format("{} is {}: this is the speed of the simulated platen, not of a "
                      "calender. 1 um takes about {:.2g} million steps. 1 to 4 m/s is usual.",
                      key, s.text(key), 1e-6 * kStepsAt1 / s.number(key)));
  return out;
}

PressInstruments instruments_of(const Settings &s) {
  PressInstruments press;
  for (const Effect &e : effects())
    if (e.shown)
      press.*e.shown = s.number(e.parameter.keys.front());
  return press;
}

void check_case(const Settings &s, Mistakes &mistakes) {
  check_collapse(s, Phase::Am, Phase::Am, 0.1, mistakes);
  check_collapse(s, Phase::Cbd, Phase::Cbd, 0.1, mistakes);
  check_collapse(s, Phase::Am, Phase::Cbd, 0.2, mistakes);
  for (const Effect &e : effects()) {
    check_effect(s, e, mistakes);
    for (const Effect &f : effects())
      if (&e < &f)
        check_one_law(s, e, f, mistakes);
  }
  check_target(s, mistakes);
  check_other_targets(s, mistakes);
  check_least(s, mistakes);
  check_roll(s, mistakes);
  check_presses(s, mistakes);
  check_window(s, mistakes);
}

namespace {

Settings read_case_of(const std::string &file, const ReferenceMaterial *known) {
  namespace fs = std::filesystem;
  Mistakes mistakes(file);
  Settings s = read_toml(file, FileKind::Case, case_keys(), mistakes);
  const fs::path electrode =
      (fs::absolute(file).parent_path() / s.text("electrode")).lexically_normal();
  take_values(known ? *known : material_of_electrode(electrode.string()), case_keys(), s);
  check_case(s, mistakes);
  mistakes.stop_if_any();
  s.set("electrode", electrode.string());
  return s;
}

} // namespace

Settings read_case(const std::string &file) { return read_case_of(file, nullptr); }

Settings read_case(const std::string &file, const Recipe &recipe) {
  return read_case_of(file, &recipe.material);
}

} // namespace calendem
