// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "commands/films_asked.h"
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kPercent = 100.0;

struct DesignOptions : FilmOptions {
  double porosity = 0.0, within = 1.0, cracked_below = 100.0, tortuosity_below = kMostTortuosity;
};

/// The proposal of a recipe, run.
void confirm(const AskedFilms &a, const FilmOptions &o, std::size_t recipe, const Target &target,
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
             d.confirmed->runs, kPercent * d.confirmed_chance.all, kPercent * after.median,
             kPercent * after.low90, kPercent * after.high90, kPercent * cracked.median,
             kPercent * cracked.low90, kPercent * cracked.high90);
}

/// Pressing makes no film more porous.
void check_target(const AskedFilms &a, double porosity) {
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
  if (kPercent * best.all < 1.0)
    fmt::print("{}: no pressure from {:.0f} to {:.0f} MPa meets the target (less than 1 %); at "
               "{:.0f} MPa: {}\n",
               d.film.name, d.chances.front().pressure, d.chances.back().pressure, best.pressure,
               there);
  else
    fmt::print("{}: {:.0f} MPa meets the target with {:.0f} % (assured: {:.0f} %): {}\n",
               d.film.name, best.pressure, kPercent * best.all, kPercent * best.assured, there);
  if (target.cracked_below < 1.0)
    fmt::print("  the porosity with {:.0f} %, the cracked particles with {:.0f} %\n",
               kPercent * best.porosity, kPercent * best.cracked);
  if (target.tortuosity_below < kMostTortuosity) {
    const Band &tau = d.predicted.tortuosity[d.best];
    fmt::print("  the tortuosity factor with {:.0f} %: {:.2f} ({:.2f} to {:.2f})\n",
               kPercent * best.tortuosity, tau.median, tau.low90, tau.high90);
  }
  if (d.confirmed)
    say_confirmed(d);
  for (const std::string &text : d.predicted.beyond)
    fmt::print("  note: {}\n", text);
}

void run_design(const DesignOptions &o) {
  if (o.runs > 0 && (!o.vary.empty() || o.press_percent > 0.0))
    throw Failure(kBadInput, "--confirm runs recipes as they are: without --vary and "
                             "--press-percent.");
  const AskedFilms a = asked(o);
  check_target(a, o.porosity);
  const Target target = {o.porosity / kPercent, o.within / kPercent, o.cracked_below / kPercent,
                         o.tortuosity_below};
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
  MissedRuns missed;
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

} // namespace

void add_design_verb(CLI::App &app) {
  auto o = std::make_shared<DesignOptions>();
  CLI::App *verb = app.add_subcommand(
      "design", "Choose the pressure that meets a target, with the probability that it does");
  add_film_options(*verb, *o);
  verb->add_option("--porosity", o->porosity, "wanted total porosity after release [%]")
      ->required()
      ->check(finite_range(1.0, 79.0));
  verb->add_option("--within", o->within, "points of porosity that it may be off (default 1)")
      ->check(finite_range(0.01, 20.0));
  verb->add_option("--cracked-below", o->cracked_below, "cracked particles [%]; default: any")
      ->check(finite_range(0.1, 100.0));
  verb->add_option("--tortuosity-below", o->tortuosity_below,
                   "tortuosity factor of the pores through the plane; default: any")
      ->check(finite_range(1.0, kMostTortuosity));
  verb->add_option("--pressure", o->pressures, "MPa to choose from: a list or a range");
  add_run_options(*verb, o->runs, o->study, "--confirm",
                  "so many simulations of each recipe at the pressure proposed, each with another "
                  "draw of the material on another packing");
  verb->callback([o] { run_design(*o); });
}

} // namespace calendem
