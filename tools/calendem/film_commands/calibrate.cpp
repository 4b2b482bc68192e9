// SPDX-License-Identifier: GPL-2.0-or-later
// What measured films say of the material.
#include "base/material_notes.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/shown.h"
#include "film_commands/film_commands.h"
#include "film_commands/films_asked.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <utility>

namespace calendem {
namespace {

struct CalibrateOptions {
  std::vector<std::string> experiments;
  std::string bank, folder;
  CalibrationSettings settings;
  int runs = 0; ///< of every film at every pressure, to confirm the model; 0: none
  StudyOptions study;
};

/// Runs the films again, writing what there is after each. Returns what could not be run.
MissedRuns confirm(const FilmBank &bank, const Calibration &c, const CalibrateOptions &o,
                   const std::vector<Recipe> &recipes,
                   const std::function<void(const std::vector<Confirmed> &)> &write) {
  MissedRuns missed;
  std::vector<Confirmed> all;
  for (std::size_t k = 0; k < recipes.size(); ++k)
    missed.attempt(o.experiments[k], [&] {
      StudyOptions study = o.study;
      study.folder = fmt::format("{}/runs/{}", o.folder, k + 1);
      fmt::print("calibrate: {}: {} draws of the material are run on packings of their own\n",
                 c.films[k].name, o.runs);
      for (const Confirmed &row : confirmed_by_runs(bank, c, int(k), recipes[k], o.runs, study))
        all.push_back(row);
      write(all);
    });
  if (!all.empty())
    fmt::print("run again: porosity after release, %\n");
  for (const Confirmed &r : all)
    fmt::print(
        "  {:<36} {:4.0f} MPa  measured {:.1f}, {} runs {:.1f} ({:.1f} to {:.1f}), emulators "
        "{:.1f}: off by {:.1f} ± {:.1f}\n",
        r.film, r.pressure, kPercent * r.measured, r.runs, kPercent * r.mean, kPercent * r.low,
        kPercent * r.high, kPercent * r.emulated, kPercent * (r.mean - r.emulated),
        kPercent * r.error);
  return missed;
}

constexpr double kWorthSaying = 0.05; // probability in any material

std::string data_in_words(const Calibration &c) {
  const auto count = [](std::size_t n, const char *what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  return fmt::format("{}, {}{}", count(c.films.size(), "film"), count(c.data.size(), "number"),
                     c.crushed.empty() ? "" : ", " + count(c.crushed.size(), "crushing load"));
}

/// Effects first, then those that act together.
void say_effects(const FilmBank &bank, const Calibration &c) {
  fmt::print("probability that an effect acts{}\n",
             c.materials.size() > 1 ? fmt::format(" in {}", fmt::join(c.materials, " | ")) : "");
  for (std::size_t e = 0; e < bank.effects().size(); ++e) {
    fmt::print("  {:<28}", bank.effects()[e].name);
    for (std::size_t m = 0; m < c.materials.size(); ++m)
      fmt::print(" {:5.1f} %", kPercent * acting(c, int(e), m));
    fmt::print("\n");
  }
  fmt::print("sets of them, from {:.0f} % on\n", kPercent * kWorthSaying);
  for (const EffectSet &set : effect_sets_of(bank, c)) {
    if (*std::max_element(set.probability.begin(), set.probability.end()) < kWorthSaying)
      continue;
    fmt::print("  {}:", set.name);
    for (const double probability : set.probability)
      fmt::print(" {:.1f} %", kPercent * probability);
    fmt::print("\n");
  }
}

std::string film_in_words(const LeftOut &r) {
  return fmt::format(
      "  {:<36} {:4.0f} MPa  measured {:.1f}, predicted {:.1f} (90 %: {:.1f} to {:.1f})", r.film,
      r.pressure, kPercent * r.measured, kPercent * r.predicted.median,
      kPercent * r.predicted.low90, kPercent * r.predicted.high90);
}

void say_left_out(const std::vector<LeftOut> &rows) {
  for (const LeftOut &r : rows)
    if (r.number == FilmNumber::PorosityAfter)
      fmt::print("{}, Heckel {:.1f}, Meyer {:.1f}\n", film_in_words(r),
                 kPercent * r.rules.at("Heckel"), kPercent * r.rules.at("Meyer"));
  const char *heading = "other readings, with the film left out\n";
  for (const LeftOut &r : rows)
    if (r.number != FilmNumber::PorosityAfter)
      fmt::print("{}{}, {}, %\n", std::exchange(heading, ""), film_in_words(r),
                 reading_in_words(name_of(r.number)));
}

/// An experiment on films of the material that their recipe names.
Experiment experiment_of_its_material(const std::string &file) {
  Experiment experiment = read_experiment(file);
  stop_if_of_other_material(experiment.recipe);
  return experiment;
}

/// A case for each material. Throws Failure(2) where a file of that name is not of a calibration.
std::vector<std::string> files_of_cases(const std::string &folder, const Calibration &c) {
  std::vector<std::string> cases;
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    cases.push_back(folder + (m == 0 ? "/case.toml" : fmt::format("/case_{}.toml", m + 1)));
    require_own_file(cases.back(), kHeadOfCase);
  }
  return cases;
}

void run_calibrate(const CalibrateOptions &o) {
  const FilmBank bank(o.bank);
  Calibration c;
  c.error = model_error_of(bank);
  std::vector<std::string> not_said;
  std::vector<Recipe> recipes;
  for (const std::string &file : o.experiments) {
    const Experiment experiment = experiment_of_its_material(file);
    add_experiment(experiment, bank, c, not_said);
    recipes.push_back(experiment.recipe);
  }
  make_output_folder(o.folder);
  const std::vector<std::string> cases = files_of_cases(o.folder, c);
  fmt::print("calibrate: {}\n", data_in_words(c));
  calibrate(bank, o.settings, c);
  for (const std::string &text : warnings_of(bank, c))
    not_said.push_back(text);
  say_effects(bank, c);
  if (c.films.size() > 1)
    fmt::print("each film left out in turn: porosity after release, %\n");
  const std::vector<LeftOut> rows = left_out(bank, c, o.settings);
  nlohmann::ordered_json model = to_json(bank, c, rows, o.folder);
  for (const std::string &file : o.experiments)
    model["provenance"]["experiments"].push_back({{"file", file}, {"hash", hash_of_file(file)}});
  model["not_said"] = not_said;
  const auto write = [&](const std::vector<Confirmed> &confirmed) {
    model["confirmed"] = to_json(confirmed);
    write_file(o.folder + "/model.json", model.dump(1) + "\n");
    write_file(o.folder + "/model.html", model_page(bank, c, model));
  };
  write({});
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    write_file(cases[m], case_of(bank, c, m));
  say_left_out(rows);
  for (const std::string &text : not_said)
    fmt::print("- {}\n", text);
  const MissedRuns missed = o.runs > 0 ? confirm(bank, c, o, recipes, write) : MissedRuns();
  fmt::print("page: {0}/model.html\nmodel: {0}/model.json\n", o.folder);
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    fmt::print("case: {}{}\n", cases[m], of_material(c, m));
  missed.stop_if_any();
}

} // namespace

void set_up_calibrate(CLI::App &verb) {
  auto o = std::make_shared<CalibrateOptions>();
  o->bank = input_scripts() + "/cases/films/bank.toml";
  verb.add_option("EXPERIMENT", o->experiments, "experiment files (TOML)")->required();
  verb.add_option("-o,--output", o->folder, "folder for model.json, case.toml and model.html")
      ->required();
  verb.add_option("--bank", o->bank, "bank (TOML) with its table (CSV) beside it");
  verb.add_option("--samples", o->settings.samples, "number of samples of the posterior")
      ->check(CLI::Range(64, 1 << 20));
  add_run_options(
      verb, o->runs, o->study, "--confirm",
      "number of simulations of every film at every pressure, each with another draw of "
      "the material on another packing");
  verb.callback([o] { run_calibrate(*o); });
}

} // namespace calendem
