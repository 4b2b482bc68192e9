// SPDX-License-Identifier: GPL-2.0-or-later
// From why to what to do: predict, design.
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/recipe.h"
#include "commands/commands.h"
#include "predict/by_gap.h"
#include "predict/files.h"
#include "predict/prediction.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kPercent = 100.0;

struct PredictOptions {
  std::string model, folder;
  std::vector<std::string> recipes, vary;
  std::string pressures, gaps, material;
  double press_percent = 0.0;
  double porosity = 0.0, within = 1.0, cracked_below = 100.0;
  int runs = 0; ///< of each film's own at each pressure; 0: the bank's emulators
  StudyOptions study;
};

/// "20,50,80" or "20:300", which is 25 values at equal ratios.
std::vector<double> values_of(const std::string &option, const std::string &text,
                              const std::string &unit) {
  std::vector<double> out;
  const bool range = text.find(':') != std::string::npos;
  std::string part;
  for (std::size_t k = 0; k <= text.size(); ++k) {
    if (k < text.size() && text[k] != ',' && text[k] != ':') {
      part += text[k];
      continue;
    }
    std::size_t used = 0;
    double value = NAN;
    try {
      value = std::stod(part, &used);
    } catch (const std::exception &) {
    }
    if (used != part.size() || !(value > 0.0) || !std::isfinite(value))
      throw Failure(kBadInput, fmt::format("{} is '{}'; give {} as 20,50,80 or as a range 20:300.",
                                           option, text, unit));
    out.push_back(value);
    part.clear();
  }
  if (range && (out.size() != 2 || out[0] >= out[1]))
    throw Failure(kBadInput,
                  fmt::format("{} is '{}'; a range is LOW:HIGH in {}.", option, text, unit));
  if (range)
    out = spread_pressures(out[0], out[1], 25);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<double> pressures_of(const std::string &text) {
  return values_of("--pressure", text, "MPa");
}

void check_covered(const std::vector<double> &pressures, const FilmBank &bank) {
  for (const double p : pressures)
    if (!bank.covers(p))
      throw Failure(kBadInput,
                    fmt::format("--pressure asks for {:g} MPa; the bank has {:g} to {:g}. Predict "
                                "it by runs of its own (--runs), or make a bank with more "
                                "pressures_MPa.",
                                p, bank.spec().pressures.front(), bank.spec().pressures.back()));
}

/// What a recipe may hold, and no further beyond the bank's films than these differ.
void check_varied(const std::string &text, double value, const BankParameter &p) {
  double low = 2.0 * p.low - p.high, high = 2.0 * p.high - p.low;
  for (const Key &key : recipe_keys())
    for (const std::string &name : p.keys)
      if (name == "recipe." + key.name) {
        low = std::max(low, key.low);
        high = std::min(high, key.high);
      }
  if (!(value >= low && value <= high))
    throw Failure(kBadInput,
                  fmt::format("--vary is '{}'; {} may be {:g} to {:g} (the bank has {:g} "
                              "to {:g}).",
                              text, p.name, low, high, p.low, p.high));
}

/// Every combination of "NAME=v,v,v" for the films.
std::vector<Film> varied(std::vector<Film> films, const std::vector<std::string> &vary,
                         const FilmBank &bank) {
  for (const std::string &text : vary) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::size_t place = 0;
    std::vector<std::string> names;
    for (const BankParameter &p : bank.film())
      names.push_back(p.name);
    while (place < names.size() && names[place] != name)
      ++place;
    if (equals == std::string::npos || place == names.size())
      throw Failure(kBadInput, fmt::format("--vary is '{}'; give NAME=VALUE,VALUE with a name of "
                                           "the bank's films: {}.",
                                           text, fmt::join(names, ", ")));
    std::vector<Film> next;
    for (const Film &f : films)
      for (const std::string &value : CLI::detail::split(text.substr(equals + 1), ',')) {
        Film changed = f;
        double number = 0.0;
        if (!CLI::detail::lexical_cast(value, number) || !std::isfinite(number))
          throw Failure(kBadInput, fmt::format("--vary is '{}'; '{}' is no number.", text, value));
        check_varied(text, number, bank.film()[place]);
        changed.recipe[place] = number;
        changed.name += fmt::format("{}{} {:g}", f.name.empty() ? "" : ", ", name, number);
        next.push_back(changed);
      }
    films = next;
  }
  return films;
}

struct Asked {
  Model model;
  int material = 0; ///< place in Draw::materials
  std::vector<Film> films;
  std::vector<double> pressures;
};

/// Which of a model's materials the films are of.
int material_of(const PredictOptions &o, const std::vector<std::string> &names) {
  if (o.material.empty() && names.size() == 1)
    return 0;
  if (o.material == kOther)
    return int(names.size());
  const auto at = std::find(names.begin(), names.end(), o.material);
  if (at == names.end())
    throw Failure(kBadInput,
                  fmt::format("--material {}; the model has '{}'. Say which of them the films are "
                              "of, or '{}' for one that was not measured.",
                              o.material.empty() ? "is needed" : "is '" + o.material + "'",
                              fmt::join(names, "', '"), kOther));
  return int(at - names.begin());
}

Asked of_model(const PredictOptions &o) {
  Asked out = {read_model(o.model), 0, {}, pressures_of(o.pressures)};
  out.material = material_of(o, out.model.calibration.materials);
  return out;
}

Asked asked(const PredictOptions &o) {
  Asked out = of_model(o);
  for (const std::string &file : o.recipes) {
    out.films.push_back(out.model.bank.film_of(read_recipe(file)));
    out.films.back().material = out.material;
  }
  out.films = varied(out.films, o.vary, out.model.bank);
  check_covered(out.pressures, out.model.bank);
  return out;
}

nlohmann::ordered_json provenance(const PredictOptions &o) {
  nlohmann::ordered_json out = {{"calendem", version()},
                                {"hashes", "64-bit FNV-1a"},
                                {"model", o.model},
                                {"model_hash", hash_of_file(o.model)}};
  for (const std::string &file : o.recipes)
    out["recipes"].push_back({{"file", file}, {"hash", hash_of_file(file)}});
  return out;
}

std::vector<PredictedFilm> by_emulators(const Asked &a, const PredictOptions &o) {
  std::vector<PredictedFilm> films;
  for (const Film &f : a.films)
    films.push_back(
        predicted(a.model.bank, a.model.calibration, f, a.pressures, o.press_percent / kPercent));
  return films;
}

/// Of a recipe, by its place in the list.
ByRuns run_film(const Asked &a, const PredictOptions &o, std::size_t recipe,
                const std::vector<double> &pressures) {
  StudyOptions study = o.study;
  study.folder = fmt::format("{}/runs/{}", o.folder, recipe + 1);
  fmt::print("{}: {}: {} runs, {} draws of the material at {} pressures\n", study.verb,
             o.recipes[recipe], o.runs * pressures.size(), o.runs, pressures.size());
  return by_runs(a.model.bank, a.model.calibration, read_recipe(o.recipes[recipe]), a.material,
                 pressures, o.press_percent / kPercent, o.runs, study);
}

/// What could not be run of a recipe; the others go on.
class Missed {
public:
  void add(const std::string &recipe, const Failure &why) {
    texts_.push_back(fmt::format("{}: {}", recipe, why.what()));
    status_ = why.exit_status();
  }
  /// After all that there is was written.
  void stop_if_any() const {
    if (!texts_.empty())
      throw Failure(status_, fmt::format("{}\nThe rest is written.", fmt::join(texts_, "\n")));
  }

private:
  std::vector<std::string> texts_;
  ExitStatus status_ = kDone;
};

std::vector<PredictedFilm> films_by_runs(const Asked &a, const PredictOptions &o, Missed &missed) {
  if (!o.vary.empty())
    throw Failure(kBadInput, "--runs goes with recipes as they are: without --vary.");
  if (o.press_percent > 0.0 && a.pressures.size() < 2)
    throw Failure(kBadInput, "--press-percent with --runs needs the slope between pressures: give "
                             "two or more to --pressure, or leave it out.");
  if (o.pressures.find(':') != std::string::npos)
    throw Failure(kBadInput, "--runs needs pressures one by one: each is so many simulations. Give "
                             "--pressure 80,150.");
  std::vector<PredictedFilm> films;
  for (std::size_t k = 0; k < o.recipes.size(); ++k)
    try {
      films.push_back(run_film(a, o, k, a.pressures).predicted);
    } catch (const Failure &f) {
      missed.add(o.recipes[k], f);
    }
  if (films.empty())
    missed.stop_if_any();
  return films;
}

void say(const AtGap &at) {
  fmt::print(
      "  {:6.1f} um  {:5.0f} ({:.0f} to {:.0f})  {:5.1f} ({:.1f} to {:.1f})  {:5.1f} ({:.1f} to "
      "{:.1f})\n",
      at.gap, at.pressure.median, at.pressure.low90, at.pressure.high90, kPercent * at.after.median,
      kPercent * at.after.low90, kPercent * at.after.high90, kPercent * at.cracked.median,
      kPercent * at.cracked.low90, kPercent * at.cracked.high90);
  for (const auto &[share, where] : {std::pair(at.below, "below"), std::pair(at.above, "above")})
    if (share >= 0.01)
      fmt::print("    note: with {:.0f} % the pressure lies {} the bank's; its band ends there\n",
                 kPercent * share, where);
}

void run_predict_at_gaps(const PredictOptions &o) {
  const Asked a = asked(o);
  const std::vector<double> gaps = values_of("--gap", o.gaps, "um");
  std::vector<std::vector<AtGap>> all;
  for (const Film &f : a.films)
    all.push_back(at_gaps(a.model.bank, a.model.calibration, f, gaps));
  nlohmann::ordered_json json = {{"films", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < all.size(); ++k)
    json["films"].push_back(gap_json(a.model.bank, a.films[k], all[k]));
  json["provenance"] = provenance(o);
  make_output_folder(o.folder);
  write_file(o.folder + "/gap.csv", gap_table(a.model.bank, a.films, all));
  write_file(o.folder + "/gap.json", json.dump(1) + "\n");
  write_file(o.folder + "/gap.html", gap_page(a.films, all, json));
  for (std::size_t k = 0; k < all.size(); ++k) {
    fmt::print("{}: pressure, MPa (90 %), porosity after release, %, cracked particles, %\n",
               a.films[k].name);
    for (const AtGap &at : all[k])
      say(at);
    for (const std::string &text : a.model.bank.beyond(a.films[k]))
      fmt::print("  note: {}\n", text);
  }
  fmt::print("page: {0}/gap.html\ntable: {0}/gap.csv\n", o.folder);
}

void run_predict(const PredictOptions &o) {
  if (!o.gaps.empty()) {
    run_predict_at_gaps(o);
    return;
  }
  const Asked a = o.runs > 0 ? of_model(o) : asked(o);
  Missed missed;
  const std::vector<PredictedFilm> films =
      o.runs > 0 ? films_by_runs(a, o, missed) : by_emulators(a, o);
  nlohmann::ordered_json json = to_json(a.model.bank, films);
  json["provenance"] = provenance(o);
  make_output_folder(o.folder);
  write_file(o.folder + "/prediction.csv", prediction_table(a.model.bank, films));
  write_file(o.folder + "/prediction.json", json.dump(1) + "\n");
  write_file(o.folder + "/prediction.html", prediction_page(a.model.calibration, films, json));
  for (const PredictedFilm &f : films) {
    fmt::print("{}: porosity after release, % (90 %), cracked particles, %\n", f.film.name);
    for (std::size_t k = 0; k < f.pressures.size(); ++k)
      fmt::print("  {:6.1f} MPa  {:5.1f} ({:.1f} to {:.1f})  {:5.1f} ({:.1f} to {:.1f})\n",
                 f.pressures[k], kPercent * f.after[k].median, kPercent * f.after[k].low90,
                 kPercent * f.after[k].high90, kPercent * f.cracked[k].median,
                 kPercent * f.cracked[k].low90, kPercent * f.cracked[k].high90);
    for (const std::string &text : f.beyond)
      fmt::print("  note: {}\n", text);
  }
  fmt::print("page: {0}/prediction.html\ntable: {0}/prediction.csv\n", o.folder);
  missed.stop_if_any();
}

/// The proposal of a recipe, run.
void confirm(const Asked &a, const PredictOptions &o, std::size_t recipe, const Target &target,
             Design &d) {
  const std::vector<double> pressure = {d.chances[d.best].pressure};
  const ByRuns own = run_film(a, o, recipe, pressure);
  d.confirmed = own.predicted;
  d.confirmed_chance = chances_from(pressure, own.of, target).front();
}

void say_confirmed(const Design &d) {
  const Band &after = d.confirmed->after[0], &cracked = d.confirmed->cracked[0];
  fmt::print("  run {} times, each with another draw of the material on another packing: it meets "
             "the target with {:.0f} %: porosity {:.1f} % ({:.1f} to {:.1f}), cracked particles "
             "{:.0f} % ({:.0f} to {:.0f})\n",
             d.confirmed->runs, kPercent * d.confirmed_chance.both, kPercent * after.median,
             kPercent * after.low90, kPercent * after.high90, kPercent * cracked.median,
             kPercent * cracked.low90, kPercent * cracked.high90);
}

/// Pressing makes no film more porous.
void check_target(const Asked &a, double porosity) {
  const std::vector<BankParameter> &of = a.model.bank.film();
  for (const Film &f : a.films)
    for (std::size_t k = 0; k < of.size(); ++k)
      if (of[k].keys.front() == kPorosityKey && f.recipe[k] <= porosity)
        throw Failure(kBadInput, fmt::format("--porosity {:g}: {} has {:g} % before pressing. Ask "
                                             "for less.",
                                             porosity, f.name, f.recipe[k]));
}

/// The answer for a film, in words.
void say(const Design &d, const Target &target) {
  const Chance &best = d.chances[d.best];
  const Band &after = d.predicted.after[d.best], &cracked = d.predicted.cracked[d.best];
  const std::string there = fmt::format(
      "porosity {:.1f} % (90 %: {:.1f} to {:.1f}), cracked particles {:.0f} % ({:.0f} to {:.0f})",
      kPercent * after.median, kPercent * after.low90, kPercent * after.high90,
      kPercent * cracked.median, kPercent * cracked.low90, kPercent * cracked.high90);
  if (kPercent * best.both < 1.0)
    fmt::print("{}: no pressure from {:.0f} to {:.0f} MPa meets the target (less than 1 %); at "
               "{:.0f} MPa: {}\n",
               d.film.name, d.chances.front().pressure, d.chances.back().pressure, best.pressure,
               there);
  else
    fmt::print("{}: {:.0f} MPa meets the target with {:.0f} % (assured: {:.0f} %): {}\n",
               d.film.name, best.pressure, kPercent * best.both, kPercent * best.assured, there);
  if (target.cracked_below < 1.0)
    fmt::print("  the porosity with {:.0f} %, the cracked particles with {:.0f} %\n",
               kPercent * best.porosity, kPercent * best.cracked);
  if (d.confirmed)
    say_confirmed(d);
  for (const std::string &text : d.predicted.beyond)
    fmt::print("  note: {}\n", text);
}

void run_design(const PredictOptions &o) {
  if (o.runs > 0 && (!o.vary.empty() || o.press_percent > 0.0))
    throw Failure(kBadInput, "--confirm runs recipes as they are: without --vary and "
                             "--press-percent.");
  const Asked a = asked(o);
  check_target(a, o.porosity);
  const Target target = {o.porosity / kPercent, o.within / kPercent, o.cracked_below / kPercent};
  std::vector<Design> designs;
  for (const Film &f : a.films) {
    Design d;
    d.film = f;
    d.chances = chances(a.model.bank, a.model.calibration, f, a.pressures,
                        o.press_percent / kPercent, target);
    d.predicted =
        predicted(a.model.bank, a.model.calibration, f, a.pressures, o.press_percent / kPercent);
    d.best = best_of(d.chances);
    designs.push_back(d);
  }
  const auto write = [&] {
    nlohmann::ordered_json json = to_json(a.model.bank, target, designs);
    json["provenance"] = provenance(o);
    make_output_folder(o.folder);
    write_file(o.folder + "/design.json", json.dump(1) + "\n");
    write_file(o.folder + "/design.html", design_page(target, designs, json));
  };
  write(); // runs may fail
  Missed missed;
  for (std::size_t k = 0; o.runs > 0 && k < designs.size(); ++k)
    try {
      confirm(a, o, k, target, designs[k]);
      write();
    } catch (const Failure &f) {
      missed.add(o.recipes[k], f);
    }
  for (const Design &d : designs)
    say(d, target);
  fmt::print("page: {0}/design.html\ndata: {0}/design.json\n", o.folder);
  missed.stop_if_any();
}

void add_common_options(CLI::App &verb, PredictOptions &o) {
  verb.add_option("MODEL", o.model, "model.json of calendem calibrate")->required();
  verb.add_option("RECIPE", o.recipes, "electrode recipes (TOML), uncalendered")->required();
  verb.add_option("-o,--output", o.folder, "folder for the page and the data")->required();
  verb.add_option("--vary", o.vary,
                  "NAME=VALUE,VALUE: the recipes with these values of one of the bank's parameters "
                  "of films; several: every combination");
  verb.add_option("--material", o.material,
                  "name of the films' material, where the model was calibrated on several; other: "
                  "one that was not measured");
  verb.add_option("--press-percent", o.press_percent,
                  "standard deviation of the press's pressure [%]; default 0: as asked for")
      ->check(finite_range(0.0, 50.0));
}

void add_run_options(CLI::App &verb, PredictOptions &o, const char *name, const char *what) {
  CLI::Option *runs = verb.add_option(name, o.runs, what)->check(CLI::Range(kFewestOwnRuns, 400));
  o.study.verb = verb.get_name();
  o.study.liggghts = liggghts_program();
  verb.add_option("--jobs", o.study.jobs, "simulations at a time")
      ->check(CLI::Range(1, 4096))
      ->needs(runs);
  verb.add_option("--ranks", o.study.ranks, "MPI ranks of each simulation")
      ->check(CLI::Range(1, 4096))
      ->needs(runs);
  verb.add_option("--liggghts", o.study.liggghts, "program with the plugin, for these")
      ->needs(runs);
}

} // namespace

void add_predict_verb(CLI::App &app) {
  auto o = std::make_shared<PredictOptions>();
  o->pressures = "20:300";
  CLI::App *verb =
      app.add_subcommand("predict", "Predict porosity, springback and cracked particles of a film "
                                    "against pressure, with intervals");
  add_common_options(*verb, *o);
  CLI::Option *pressure =
      verb->add_option("--pressure", o->pressures, "MPa: 20,50,80 or a range 20:300 (default)");
  CLI::Option *gap = verb->add_option("--gap", o->gaps,
                                      "um, instead of a pressure: thickness of the coating under "
                                      "load, without foil; 30,32 or 28:36");
  gap->excludes(pressure);
  add_run_options(*verb, *o, "--runs",
                  "so many simulations of each recipe at each pressure, each with another draw of "
                  "the material, instead of the bank's emulators: for electrodes and pressures "
                  "that the bank does not have");
  gap->excludes(verb->get_option("--runs"))->excludes(verb->get_option("--press-percent"));
  verb->callback([o] { run_predict(*o); });
}

void add_design_verb(CLI::App &app) {
  auto o = std::make_shared<PredictOptions>();
  o->pressures = "20:300";
  CLI::App *verb = app.add_subcommand(
      "design", "Choose the pressure that meets a target, with the probability that it does");
  add_common_options(*verb, *o);
  verb->add_option("--porosity", o->porosity, "wanted total porosity after release [%]")
      ->required()
      ->check(finite_range(1.0, 79.0));
  verb->add_option("--within", o->within, "points of porosity that it may be off (default 1)")
      ->check(finite_range(0.01, 20.0));
  verb->add_option("--cracked-below", o->cracked_below, "cracked particles [%]; default: any")
      ->check(finite_range(0.1, 100.0));
  verb->add_option("--pressure", o->pressures, "MPa to choose from: a list or a range");
  add_run_options(*verb, *o, "--confirm",
                  "so many simulations of each recipe at the pressure proposed, each with another "
                  "draw of the material on another packing");
  verb->callback([o] { run_design(*o); });
}

} // namespace calendem
