// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/csv_table.h"
#include "base/provenance.h"
#include "diagnose/compare/gap.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace calendem {
namespace {

constexpr double kSlopeFrom = 0.7; // of the maximum: the part of the curve whose slope is taken

std::string text_of(const std::string &file, Mistakes &mistakes) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    mistakes.add(0, fmt::format("{} is missing. Give a directory made by calendem run.", file));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

nlohmann::json json_of(const std::string &file, Mistakes &mistakes) {
  const std::string text = text_of(file, mistakes);
  nlohmann::json j = nlohmann::json::parse(text, nullptr, false);
  if (!text.empty() && !j.is_object())
    mistakes.add(0, fmt::format("{} is cut or damaged. Make the run again.", file));
  return j;
}

double number(const nlohmann::json &j, const char *key, const std::string &file,
              Mistakes &mistakes) {
  if (!j.is_object())
    return 0.0;
  if (j.contains(key) && j[key].is_number())
    return j[key].get<double>();
  mistakes.add(
      0, fmt::format("{} has no number '{}'. Run calendem collect on the folder with this version.",
                     file, key));
  return 0.0;
}

void read_curve(const std::string &file, SimulatedRun &run, Mistakes &mistakes) {
  const auto table = CsvTable::parse(text_of(file, mistakes));
  for (const char *column :
       {"stage", "displacement_shown_um", "pressure_shown_MPa", "porosity_total"})
    if (!table.has(column))
      return mistakes.add(0, fmt::format("{} has no column '{}'.", file, column));
  const auto stage = table.texts("stage");
  const auto d = table.numbers("displacement_shown_um"), p = table.numbers("pressure_shown_MPa"),
             porosity = table.numbers("porosity_total");
  double sp = 0, sq = 0, spp = 0, spq = 0, n = 0;
  for (std::size_t k = 0; k < stage.size(); ++k) {
    if (stage[k] != "compression" || !add_if_higher(run.pressure, run.displacement, p[k], d[k]) ||
        p[k] < kSlopeFrom * run.max_pressure)
      continue;
    sp += p[k], sq += porosity[k], spp += p[k] * p[k], spq += p[k] * porosity[k], n += 1.0;
  }
  for (std::size_t k = stage.size(); k-- > 0 && stage[k] == "relaxation";)
    add_if_higher(run.release_pressure, run.release_displacement, p[k], d[k]);
  const double spread = n * spp - sp * sp;
  run.porosity_slope = spread > 0.0 ? (n * spq - sp * sq) / spread : 0.0;
}

void read_summary(const std::string &folder, SimulatedRun &run, Mistakes &mistakes) {
  const std::string file = folder + "/summary.json";
  const nlohmann::json s = json_of(file, mistakes);
  if (s.is_object() && !s.value("finished", false))
    return mistakes.add(0, fmt::format("{} is of a run that is not finished ({}). Go on with "
                                       "calendem run --resume.",
                                       folder, s.value("stopped_because", "?")));
  run.max_pressure = number(s, "max_pressure_shown_MPa", file, mistakes);
  run.thickness_at_max = number(s, "thickness_at_max_shown_um", file, mistakes);
  run.thickness_after = number(s, "thickness_after_relaxation_shown_um", file, mistakes);
  run.porosity_initial = number(s, "porosity_initial_shown", file, mistakes);
  run.porosity_at_max = number(s, "porosity_at_max", file, mistakes);
  run.porosity_after = number(s, "porosity_after_relaxation_shown", file, mistakes);
  if (s.contains("imposed") && s["imposed"].is_object())
    run.imposed = s["imposed"].value("what", "something that this version does not know");
  const double bodies = number(s, "bodies", file, mistakes);
  run.cracked_fraction = bodies > 0.0 ? number(s, "cracked_bodies", file, mistakes) / bodies : 0.0;
  run.solid_column = number(s, "thickness_at_max_um", file, mistakes) * (1.0 - run.porosity_at_max);
}

} // namespace

bool add_if_higher(std::vector<double> &pressures, std::vector<double> &displacements,
                   double pressure, double displacement) {
  if (!pressures.empty() && pressure <= pressures.back())
    return false;
  pressures.push_back(pressure);
  displacements.push_back(displacement);
  return true;
}

double displacement_at(const std::vector<double> &pressures,
                       const std::vector<double> &displacements, double pressure) {
  if (!pressures.empty() && pressures.front() == pressure)
    return displacements.front();
  for (std::size_t k = 1; k < pressures.size(); ++k)
    if (pressures[k] >= pressure && pressures[k - 1] < pressure)
      return displacements[k - 1] + (displacements[k] - displacements[k - 1]) *
                                        (pressure - pressures[k - 1]) /
                                        (pressures[k] - pressures[k - 1]);
  return std::nan("");
}

SimulatedRun read_simulated_run(const std::string &folder) {
  Mistakes mistakes(folder);
  SimulatedRun run;
  run.folder = folder;
  read_summary(folder, run, mistakes);
  mistakes.stop_if_any();
  read_curve(folder + "/curve.csv", run, mistakes);
  const std::string recipe = folder + "/electrode.json";
  const nlohmann::json electrode = json_of(recipe, mistakes);
  if (electrode.is_object()) {
    run.electrode_hash = hash_of_file(recipe);
    const nlohmann::json settings_of_recipe = electrode.value("recipe", nlohmann::json::object());
    for (const auto &[key, value] : settings_of_recipe.items())
      if (value.is_string())
        run.recipe[key] = value;
  }
  Mistakes of_case(folder + "/case.toml");
  const Settings settings = read_toml(folder + "/case.toml", FileKind::Case, case_keys(), of_case);
  of_case.stop_if_any();
  mistakes.stop_if_any();
  run.control = settings.text("platen.control");
  run.target = settings.number(run.control == "pressure" ? std::string("platen.max_pressure_MPa")
                                                         : "platen." + run.control + "_um");
  return run;
}

} // namespace calendem
