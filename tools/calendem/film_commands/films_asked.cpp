// SPDX-License-Identifier: GPL-2.0-or-later
#include "film_commands/films_asked.h"
#include "base/material_notes.h"
#include "base/provenance.h"
#include "base/recipe.h"
#include "base/shown.h"
#include "commands/commands.h"
#include "electrode/pack/from_structure.h"
#include "film_commands/film_commands.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace calendem {

std::vector<double> values_of(const std::string &option, const std::string &text,
                              const std::string &unit) {
  std::vector<double> out;
  const bool range = text.find(':') != std::string::npos;
  for (const std::string &part : CLI::detail::split(text, range ? ':' : ',')) {
    double value = NAN;
    if (!CLI::detail::lexical_cast(part, value) || !(value > 0.0) || !std::isfinite(value))
      throw Failure(kBadInput, "{} is '{}'; give {}.", option, text,
                    unit.empty() ? "whole numbers from 1 to 20, as 1,2,3"
                                 : unit + " as 20,50,80 or as a range 20:300");
    out.push_back(value);
  }
  if (range && (out.size() != 2 || out[0] >= out[1]))
    throw Failure(kBadInput, "{} is '{}'; a range is LOW:HIGH in {}.", option, text, unit);
  if (range)
    out = spread_pressures(out[0], out[1], kOfRange);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

namespace {

std::vector<double> pressures_of(const std::string &text) {
  return values_of("--pressure", text, "MPa");
}

void check_covered(const std::vector<double> &pressures, const FilmBank &bank) {
  for (const double p : pressures)
    if (!bank.covers(p))
      throw Failure(kBadInput,
                    "--pressure asks for {:g} MPa; the bank has {:g} to {:g}. Predict it by runs "
                    "of its own (--runs), or make a bank whose case presses to it.",
                    p, bank.pressures().front(), bank.pressures().back());
}

/// What a recipe may hold, and no further beyond the bank's films than these differ.
void check_varied(const std::string &text, double value, const bank::Input &p) {
  double low = 2.0 * p.low - p.high, high = 2.0 * p.high - p.low;
  for (const Key &key : recipe_keys())
    for (const std::string &name : p.keys)
      if (name == "recipe." + key.name) {
        low = std::max(low, key.low);
        high = std::min(high, key.high);
      }
  if (!(value >= low && value <= high))
    throw Failure(kBadInput, "--vary is '{}'; {} may be {:g} to {:g} (the bank has {:g} to {:g}).",
                  text, p.name, low, high, p.low, p.high);
}

/// Every combination of "NAME=v,v,v" for the films.
std::vector<Film> varied(std::vector<Film> films, const std::vector<std::string> &vary,
                         const FilmBank &bank) {
  std::set<std::string> seen;
  for (const std::string &text : vary) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (!seen.insert(name).second)
      throw Failure(kBadInput, "--vary has {} twice; give all its values at once: {}=VALUE,VALUE.",
                    name, name);
    std::vector<std::string> names;
    for (const bank::Input &p : bank.film())
      names.push_back(p.name);
    const auto place = std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
    if (equals == std::string::npos || place == names.size())
      throw Failure(kBadInput,
                    "--vary is '{}'; give NAME=VALUE,VALUE with a name of the bank's films: {}.",
                    text, fmt::join(names, ", "));
    std::vector<Film> next;
    for (const Film &f : films)
      for (const std::string &value : CLI::detail::split(text.substr(equals + 1), ',')) {
        Film changed = f;
        double number = 0.0;
        if (!CLI::detail::lexical_cast(value, number) || !std::isfinite(number))
          throw Failure(kBadInput, "--vary is '{}'; '{}' is no number.", text, value);
        check_varied(text, number, bank.film()[place]);
        changed.recipe[place] = number;
        changed.name += fmt::format("{}{} {:g}{}", f.name.empty() ? "" : ", ", in_words(name).name,
                                    number, in_words(name).unit);
        next.push_back(changed);
      }
    films = next;
  }
  return films;
}

/// Which of a model's materials the films are of.
int material_of(const FilmOptions &o, const std::vector<std::string> &names) {
  if (o.material.empty() && names.size() == 1)
    return 0;
  if (o.material == kOther)
    return int(names.size());
  const auto at = std::find(names.begin(), names.end(), o.material);
  if (at == names.end())
    throw Failure(kBadInput,
                  "--material {}; the model has '{}'. Say which of them the films are of, or '{}' "
                  "for one that was not measured.",
                  o.material.empty() ? "is needed" : "is '" + o.material + "'",
                  fmt::join(names, "', '"), kOther);
  return int(at - names.begin());
}

/// A recipe of its material, else the answer would be another's, with the numbers of its structure.
Recipe recipe_to_answer_for(const std::string &file) {
  Recipe recipe = read_input(read_recipe(file)).recipe;
  stop_if_of_other_material(recipe);
  return recipe;
}

} // namespace

std::string in_percent(const Band &band, const char *format) {
  return fmt::format(fmt::runtime(format), kPercent * band.median, kPercent * band.low90,
                     kPercent * band.high90);
}

AskedFilms of_model(const FilmOptions &o) {
  AskedFilms out = {read_model(o.model), 0, {}, {}};
  const std::vector<double> &bank = out.model.bank.pressures();
  out.pressures = o.pressures.empty() ? spread_pressures(bank.front(), bank.back(), kOfRange)
                                      : pressures_of(o.pressures);
  out.material = material_of(o, out.model.calibration.materials);
  return out;
}

AskedFilms asked(const FilmOptions &o) {
  AskedFilms out = of_model(o);
  for (const std::string &file : o.recipes) {
    out.films.push_back(out.model.bank.film_of(recipe_to_answer_for(file)));
    out.films.back().material = out.material;
  }
  out.films = varied(out.films, o.vary, out.model.bank);
  check_covered(out.pressures, out.model.bank);
  return out;
}

AskedFilms asked_to_run(const FilmOptions &o) {
  const bool gap = !o.gaps.empty();
  const char *name = gap ? "--gap" : "--pressure";
  if (!o.vary.empty())
    throw Failure(kBadInput, "--runs goes with recipes as they are: without --vary.");
  const std::string &asked = gap ? o.gaps : o.pressures;
  if (asked.empty() || asked.find(':') != std::string::npos)
    throw Failure(kBadInput,
                  "--runs needs values of {} one by one: each is so many simulations. Give {} {}.",
                  name, name, gap ? "52,54" : "80,150");
  AskedFilms out = of_model(o);
  if (!gap && o.press_percent > 0.0 && out.pressures.size() < 2)
    throw Failure(kBadInput, "--press-percent with --runs needs the slope between pressures: give "
                             "two or more to --pressure, or leave it out.");
  for (const std::string &file : o.recipes) {
    out.films.push_back(out.model.bank.described(recipe_to_answer_for(file)));
    out.films.back().material = out.material;
  }
  return out;
}

nlohmann::ordered_json provenance(const FilmOptions &o) {
  nlohmann::ordered_json out = {{"calendem", version()},
                                {"hashes", "64-bit FNV-1a"},
                                {"model", o.model},
                                {"model_hash", hash_of_file(o.model)}};
  for (const std::string &file : o.recipes)
    out["recipes"].push_back({{"file", file}, {"hash", hash_of_file(file)}});
  return out;
}

/// Runs a recipe, by its place in the list.
ByRuns run_film(const AskedFilms &a, const FilmOptions &o, std::size_t recipe,
                const std::vector<double> &pressures) {
  StudyOptions study = o.study;
  study.folder = fmt::format("{}/runs/{}", o.folder, recipe + 1);
  fmt::print("{}: {}: {} runs, {} draws of the material at {} pressure{}\n", study.verb,
             o.recipes[recipe], o.runs * pressures.size(), o.runs, pressures.size(),
             pressures.size() == 1 ? "" : "s");
  return by_runs(a.model.bank, a.model.calibration, read_recipe(o.recipes[recipe]), a.material,
                 pressures, 0.01 * o.press_percent, o.runs, study);
}

std::vector<int> passes_of(const FilmOptions &o) {
  constexpr double kMost = 20;
  std::vector<int> out;
  for (const double passes : values_of("--passes", o.passes, "")) {
    if (passes != std::floor(passes) || passes > kMost || o.passes.find(':') != std::string::npos)
      throw Failure(kBadInput, "--passes is '{}'; give whole numbers from 1 to {:g}, as 1,2,3.",
                    o.passes, kMost);
    out.push_back(int(passes));
  }
  return out;
}

GapDraws run_film_at_gaps(const AskedFilms &a, const FilmOptions &o, std::size_t recipe,
                          const std::vector<double> &gaps, int passes) {
  StudyOptions study = o.study;
  study.folder = fmt::format("{}/runs/{}_passes_{}", o.folder, recipe + 1, passes);
  fmt::print("{}: {}: {} runs, {} draws of the material at {} gap{}, {} pass{}\n", study.verb,
             o.recipes[recipe], std::size_t(o.runs) * gaps.size(), o.runs, gaps.size(),
             gaps.size() == 1 ? "" : "s", passes, passes == 1 ? "" : "es");
  return runs_at_gaps(a.model.bank, a.model.calibration, read_recipe(o.recipes[recipe]), a.material,
                      gaps, passes, o.runs, study);
}

void MissedRuns::attempt(const std::string &recipe, const std::function<void()> &work) {
  try {
    work();
  } catch (const Failure &why) {
    texts_.push_back(fmt::format("{}: {}", recipe, why.what()));
    status_ = why.exit_status();
  }
}

void MissedRuns::stop_if_any(bool nothing) const {
  if (!texts_.empty())
    throw Failure(status_, "{}\n{}", fmt::join(texts_, "\n"),
                  nothing ? "Nothing is written but the runs that were made."
                          : "The rest is written.");
}

void add_film_options(CLI::App &verb, FilmOptions &o) {
  verb.add_option("MODEL", o.model, "model.json of calendem calibrate")->required();
  verb.add_option("RECIPE", o.recipes, "electrode recipes (TOML), uncalendered")->required();
  verb.add_option("-o,--output", o.folder, "folder for the page and the data")->required();
  verb.add_option(
      "--vary", o.vary,
      "NAME=VALUE,VALUE: give one of the bank's film parameters these values in turn; several "
      "--vary: every combination");
  verb.add_option("--material", o.material,
                  "name of the films' material, if the model was calibrated on several; other: "
                  "one that was not measured");
  verb.add_option("--press-percent", o.press_percent,
                  "standard deviation of the press's pressure [%]; default 0: exact")
      ->check(finite_range(0.0, 50.0, "%"));
}

void add_gap_options(CLI::App &verb, FilmOptions &o, const std::string &runs) {
  verb.add_option("--gap", o.gaps,
                  "um, instead of a pressure: thickness of the coating under load, without foil; "
                  "30,32 or 28:36")
      ->excludes(verb.get_option("--pressure"))
      ->excludes(verb.get_option("--press-percent"));
  verb.add_option("--passes", o.passes,
                  "passes under the roll, with " + runs +
                      ": 1,2,3; each reduces the film by the same thickness (default 1)")
      ->needs(verb.get_option("--gap"))
      ->needs(verb.get_option(runs));
}

CLI::Option *add_other_runs(CLI::App &verb, int &runs, const char *name, const char *instead_of,
                            const char *what) {
  CLI::Option *first = verb.get_option(instead_of);
  CLI::Option *other =
      verb.add_option(name, runs, what)->check(CLI::Range(kFewestOwnRuns, 400))->excludes(first);
  std::vector<CLI::Option *> of_both;
  for (CLI::Option *option : verb.get_options())
    if (option->remove_needs(first))
      of_both.push_back(option);
  verb.parse_complete_callback([of_both, first, other] {
    for (const CLI::Option *option : of_both)
      if (option->count() > 0 && first->count() + other->count() == 0)
        throw CLI::RequiresError(option->get_name(),
                                 first->get_name() + " or " + other->get_name());
  });
  return other;
}

void add_run_options(CLI::App &verb, int &runs, StudyOptions &study, const char *name,
                     const char *what) {
  CLI::Option *asked = verb.add_option(name, runs, what)->check(CLI::Range(kFewestOwnRuns, 400));
  study.verb = verb.get_name();
  study.liggghts = liggghts_program();
  verb.add_option("--jobs", study.jobs, "simulations at a time")
      ->check(CLI::Range(1, 4096))
      ->needs(asked);
  verb.add_option("--ranks", study.ranks, "MPI ranks of each simulation")
      ->check(CLI::Range(1, 4096))
      ->needs(asked);
  verb.add_option("--liggghts", study.liggghts, "program with the plugin, for these")->needs(asked);
}

} // namespace calendem
