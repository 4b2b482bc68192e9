// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "base/run_folder.h"
#include "compare/gap.h"
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kSlopeFrom = 0.7;  // of the maximum: the part of the curve whose slope is taken
constexpr double kDwellFrom = 0.75; // of the dwell: the part whose mean pressure is what is left

void read_curve(RunFolder &folder, bool dwells, SimulatedRun &run, Mistakes &mistakes) {
  const Curve c = folder.curve({"displacement_shown_um", "pressure_shown_MPa", "porosity_total"},
                               mistakes, mistakes);
  if (c.rows() == 0)
    return;
  const Column &d = c["displacement_shown_um"], &p = c["pressure_shown_MPa"],
               &porosity = c["porosity_total"];
  double sp = 0, sq = 0, spp = 0, spq = 0, n = 0;
  for (std::size_t k = 0; k < c.rows() && c.stage[k] != "relaxation"; ++k) {
    if (c.stage[k] != "compression" || !add_if_higher(run.pressure, run.displacement, p[k], d[k]) ||
        p[k] < kSlopeFrom * run.max_pressure)
      continue;
    sp += p[k], sq += porosity[k], spp += p[k] * p[k], spq += p[k] * porosity[k], n += 1.0;
  }
  for (std::size_t k = c.rows(); k-- > 0 && c.stage[k] == "relaxation";)
    add_if_higher(run.release_pressure, run.release_displacement, p[k], d[k]);
  if (dwells)
    run.pressure_left = pressure_left(c.stage, p);
  const double spread = n * spp - sp * sp;
  run.porosity_slope = spread > 0.0 ? (n * spq - sp * sq) / spread : 0.0;
}

void read_summary(RunFolder &folder, SimulatedRun &run, Mistakes &mistakes) {
  folder.must_be_finished(mistakes);
  if (!mistakes.empty())
    return;
  const auto number = [&](const char *key) { return folder.number(key, mistakes); };
  run.max_pressure = number("max_pressure_shown_MPa");
  run.thickness_at_max = number("thickness_at_max_shown_um");
  run.thickness_after = number("thickness_after_relaxation_shown_um");
  run.porosity_initial = number("porosity_initial_shown");
  run.porosity_at_max = number("porosity_at_max");
  run.porosity_after = number("porosity_after_relaxation_shown");
  const nlohmann::json &s = folder.object("summary.json");
  if (s.contains("imposed") && s["imposed"].is_object())
    run.imposed = s["imposed"].value("what", "something that this version does not know");
  const double bodies = number("bodies");
  run.cracked_fraction = bodies > 0.0 ? number("cracked_bodies") / bodies : 0.0;
  run.broken_fraction =
      number_in(s, "broken_fraction_after"); // the mean of a sample's cells has none
  run.cbd_nanoporosity = number_in(s, "cbd_nanoporosity_after");
  run.solid_column = number("thickness_at_max_um") * (1.0 - run.porosity_at_max);
}

} // namespace

double pressure_left(const std::vector<std::string> &stage, const std::vector<double> &pressure) {
  double before = NAN;
  std::vector<double> dwell;
  for (std::size_t k = 0; k < stage.size(); ++k)
    if (stage[k] == "dwell") {
      dwell.push_back(pressure[k]);
    } else if (stage[k] == "compression") {
      before = pressure[k];
      dwell.clear();
    }
  double sum = 0.0;
  const auto from = std::size_t(kDwellFrom * double(dwell.size()));
  for (std::size_t k = from; k < dwell.size(); ++k)
    sum += dwell[k];
  return sum / double(dwell.size() - from) / before;
}

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

SimulatedRun read_simulated_run(const std::string &path) {
  Mistakes mistakes;
  RunFolder folder(path);
  SimulatedRun run;
  run.folder = path;
  read_summary(folder, run, mistakes);
  mistakes.stop_if_any();
  const Settings settings = folder.settings();
  read_curve(folder, settings.number("platen.dwell_us") > 0.0, run, mistakes);
  run.inverse_tortuosity = folder.inverse_tortuosity("after");
  if (const auto &electrode = folder.object("electrode.json", mistakes); electrode.is_object()) {
    // a packing made twice took other times, but is the same
    run.electrode_hash =
        electrode.value("identity", hash_of_file(folder.path_of("electrode.json")));
    run.recipe = recipe_in(electrode);
  }
  mistakes.stop_if_any();
  run.way = fmt::format("platen.presses = {}, dwell_us = {}, speed_m_s = {}",
                        settings.text("platen.presses"), settings.text("platen.dwell_us"),
                        settings.text("platen.speed_m_s"));
  run.control = settings.text("platen.control");
  run.target = settings.number(run.control == "pressure" ? std::string("platen.max_pressure_MPa")
                                                         : "platen." + run.control + "_um");
  return run;
}

} // namespace calendem
