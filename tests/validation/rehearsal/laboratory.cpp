// SPDX-License-Identifier: GPL-2.0-or-later
#include "laboratory.h"
#include "base/provenance.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>

namespace calendem {
namespace {

constexpr double kPressures[] = {50.0, 150.0}; // about these the film is pressed
constexpr double kPorosityPoints = 0.3, kCrackedShare = 0.03, kCurveUm = 0.05, kTouchUm = 1.0;

bool contains(const std::vector<std::string> &all, const std::string &name) {
  return std::find(all.begin(), all.end(), name) != all.end();
}

} // namespace

Experiment Laboratory::measure(const bank::Run &run, std::uint64_t seed) const {
  std::filesystem::create_directories(folder_);
  write_file(folder_ + "/film.toml", recipe_of(run));
  Random random(seed, 1);
  const double diameter = 1e-3 * std::sqrt(4.0 * bank_.recipe().area() / kPi);
  std::string text = fmt::format("[experiment]\nname = \"{}\"\nelectrode = \"film.toml\"\n"
                                 "measured_on = \"simulation\"\nsample_diameter_mm = {:.6f}\n",
                                 std::filesystem::path(folder_).filename().string(), diameter);
  for (const double wanted : kPressures) {
    const bank::PressedFilm &press =
        *std::min_element(run.presses.begin(), run.presses.end(),
                          [&](const bank::PressedFilm &a, const bank::PressedFilm &b) {
                            return std::fabs(std::log(a.pressure / wanted)) <
                                   std::fabs(std::log(b.pressure / wanted));
                          });
    text += condition_of(run, press, random);
  }
  write_file(folder_ + "/experiment.toml", text);
  return read_experiment(folder_ + "/experiment.toml");
}

/// The bank's recipe with the values of the point.
std::string Laboratory::recipe_of(const bank::Run &run) const {
  std::map<std::string, std::string> tables; // of keys by table
  for (std::size_t k = 0; k < bank_.spec().design.inputs.size(); ++k)
    if (const bank::Input &input = bank_.spec().design.inputs[k]; input.is_film())
      for (const std::string &key : input.keys) {
        const std::string name = key.substr(std::string("recipe.").size());
        const std::size_t dot = name.find('.');
        tables[name.substr(0, dot)] +=
            fmt::format("{} = {:.6g}\n", name.substr(dot + 1), run.point.values[k]);
      }
  tables["coating"] += "loading_mg_cm2 = 6\n";
  std::string out = "name = \"film\"\nmaterial = \"nmc111\"\n";
  for (const auto &[table, keys] : tables)
    out += fmt::format("[{}]\n{}", table, keys);
  return out;
}

std::string Laboratory::condition_of(const bank::Run &run, const bank::PressedFilm &press,
                                     Random &random) const {
  const std::string id = fmt::format("p{:.0f}", press.pressure);
  const double touch = kTouchUm * random.normal(),
               largest = run.thickness_before - press.thickness_at_max;
  std::string curve = "stage,pressure_MPa,displacement_um\n";
  const auto add = [&](const char *stage, double pressure, double displacement) {
    if (std::isfinite(displacement))
      curve += fmt::format("{},{:.5g},{:.4f}\n", stage, pressure,
                           displacement + touch + kCurveUm * random.normal());
  };
  for (std::size_t k = 0; k < run.loading.size(); ++k)
    if (bank::curve_pressures()[k] < 0.98 * press.pressure)
      add("compression", bank::curve_pressures()[k], run.loading[k]);
  add("compression", press.pressure, largest);
  for (std::size_t k = press.release.size(); k-- > 0;)
    add("relaxation", bank::kReleasedTo[k] * press.pressure, press.release[k]);
  write_file(folder_ + "/" + id + ".csv", curve);
  return fmt::format(
      "[[condition]]\nid = \"{0}\"\nspecimen = \"one\"\ncontrol = \"pressure\"\ncurve = "
      "\"{0}.csv\"\n"
      "curve_sd_um = {1}\ncurve_zero_um = {2}\nloading_mg_cm2 = {{ value = 6, sd = 0.03 }}\n"
      "max_pressure_MPa = {{ value = {3:.5g}, sd_relative = 0.01 }}\n"
      "porosity_after_percent = {{ value = {4:.4f}, sd = {5} }}\n"
      "cracked_bodies_fraction = {{ value = {6:.4f}, sd = {7} }}\n",
      id, kCurveUm, kTouchUm, press.pressure,
      100.0 * press.porosity_after + kPorosityPoints * random.normal(), kPorosityPoints,
      std::clamp(press.cracked + kCrackedShare * random.normal(), 0.0, 1.0), kCrackedShare);
}

void Laboratory::write_model(const Truth &truth) const {
  std::string out = "electrode = \".\"\n"
                    "effects.cbd_plasticity.beyond_cohesion = 1 # as in the bank's case\n";
  for (const inference::Parameter &p : bank_.effects()) {
    const EffectParameter &effect = find_effect(p.name).parameter;
    const bool acts = contains(truth.acting, p.name);
    for (const std::string &key : effect.keys)
      out +=
          fmt::format("{} = {}{}\n", key,
                      acts ? fmt::format("{:.4g}", effect.value(p.prior.value(0.0))) : effect.off,
                      acts ? " # " + p.name + " acts" : "");
  }
  write_file(folder_ + "/model.toml", out);
}

namespace {

std::vector<std::string> acting_of(const bank::Bank &spec, const bank::Run &run, bool acts) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < spec.design.inputs.size(); ++k)
    if (spec.design.inputs[k].is_effect() && std::isnan(run.point.values[k]) != acts)
      out.push_back(spec.design.inputs[k].name);
  return out;
}

/// Effects that are off and could act beside all that are on: a contact follows one law.
std::vector<std::string> possible_in(const bank::Bank &spec, const bank::Run &run) {
  const std::vector<std::string> on = acting_of(spec, run, true);
  std::vector<std::string> out;
  for (const std::string &name : acting_of(spec, run, false)) {
    bool possible = true;
    for (const bank::Input &input : spec.design.inputs)
      for (const std::string &other : input.excludes)
        possible = possible && !(input.name == name && contains(on, other)) &&
                   !(other == name && contains(on, input.name));
    if (possible)
      out.push_back(name);
  }
  return out;
}

/// Takes an effect from the model by chance.
void take(Truth &from, Random &random) {
  const auto at =
      from.acting.begin() + std::ptrdiff_t(random.uniform() * double(from.acting.size()));
  from.changes.push_back(*at);
  from.acting.erase(at);
}

} // namespace

std::vector<Truth> truths_of(const bank::Bank &spec, const bank::Run &run, int turn) {
  const std::vector<std::string> on = acting_of(spec, run, true), off = possible_in(spec, run);
  Random random(std::uint64_t(run.point.number), 2);
  std::vector<Truth> out;
  out.push_back({Truth::none, on, {}});
  if (turn % 2 == 1 && !off.empty()) {
    const std::string &extra = off[std::size_t(random.uniform() * double(off.size()))];
    out.back() = {Truth::absent, on, {"no " + extra}};
    out.back().acting.push_back(extra);
  }
  const std::size_t taken = turn % 3 == 2 ? 2 : 1;
  if (on.size() < taken)
    return out;
  out.push_back({taken == 2 ? Truth::pair : Truth::single, on, {}});
  for (std::size_t k = 0; k < taken; ++k)
    take(out.back(), random);
  return out;
}

} // namespace calendem
