// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/shown.h"
#include "commands/commands.h"
#include "film_commands/film_commands.h"
#include "film_commands/films_asked.h"
#include <fmt/format.h>

namespace calendem {
namespace {

struct DesignOptions : FilmOptions {
  double porosity = 0.0, within = 1.0, cracked_below = 100.0, tortuosity_below = kMostTortuosity;
  bool by_runs = false; ///< instead of the bank's emulators
};

SetBy set_by(const FilmOptions &o) { return o.gaps.empty() ? SetBy::Pressure : SetBy::Gap; }

void note_outside(const GapDraws &draws, Design &d) {
  if (const double outside = draws.below[d.best] + draws.above[d.best]; outside >= 0.01)
    d.predicted.beyond.push_back(fmt::format(
        "with {:.0f} % the gap takes a pressure outside the bank's; {} at its end",
        kPercent * outside,
        draws.runs > 0 ? "the model error is that" : "cracks and springback are those"));
}

Design designed(const Film &film, const PredictedFilm &predicted,
                const std::vector<Chance> &chances) {
  Design d;
  d.film = film;
  d.predicted = predicted;
  d.chances = chances;
  d.best = best_of(chances);
  return d;
}

Design designed(const FilmBank &bank, const GapDraws &draws, const Target &target) {
  Design d = designed(draws.film, film_at_gaps(bank, draws),
                      chances_from(draws.gaps, numbers_at_gaps(draws), target));
  note_outside(draws, d);
  return d;
}

/// What a film offers at the pressures or gaps asked for.
Design design_of(const AskedFilms &a, const FilmOptions &o, const Film &film,
                 const Target &target) {
  const FilmBank &bank = a.model.bank;
  const Calibration &c = a.model.calibration;
  if (set_by(o) == SetBy::Gap)
    return designed(bank, under_gaps(bank, c, film, values_of("--gap", o.gaps, "um")), target);
  const double error = o.press_percent / kPercent;
  return designed(film, predicted(bank, c, film, a.pressures, error),
                  chances(bank, c, film, a.pressures, error, target));
}

/// Designs from runs at each of the pressures; under a roll in so many passes, at each of the gaps.
Design design_by_runs(const AskedFilms &a, const FilmOptions &o, std::size_t recipe,
                      const Target &target, int passes, const std::vector<double> &at) {
  if (passes > 0)
    return designed(a.model.bank, run_film_at_gaps(a, o, recipe, at, passes), target);
  const ByRuns own = run_film(a, o, recipe, at);
  return designed(own.predicted.film, own.predicted, chances_from(at, own.of, target));
}

void say_confirmed(const Confirmation &c) {
  const std::string passes = c.passes == 0 ? ""
                                           : fmt::format(" in {} pass{} under the roll", c.passes,
                                                         c.passes == 1 ? "" : "es");
  fmt::print(
      "  run {} times{}, each with another draw of the material on another packing: it meets "
      "the target with {:.0f} %: porosity {}, cracked particles {}\n",
      c.predicted.runs, passes, kPercent * c.chance.all,
      in_percent(c.predicted.after[0], "{:.1f} % ({:.1f} to {:.1f})"),
      in_percent(c.predicted.cracked[0], "{:.0f} % ({:.0f} to {:.0f})"));
}

/// Pressing makes no film more porous.
void check_target(const AskedFilms &a, double porosity) {
  const std::vector<bank::Input> &of = a.model.bank.film();
  for (const Film &f : a.films)
    for (std::size_t k = 0; k < of.size(); ++k)
      if (of[k].keys.front() == kPorosityKey && f.recipe[k] <= porosity)
        throw Failure(kBadInput, "--porosity {:g}: {} has {:g} % before pressing. Ask for less.",
                      porosity, f.name, f.recipe[k]);
}

/// The answer for a film, in words.
void say(const Design &d, SetBy by, const Target &target) {
  const bool gap = by == SetBy::Gap;
  const char *unit = gap ? "um" : "MPa";
  const int decimals = gap ? 1 : 0;
  const Chance &best = d.chances[d.best];
  const std::string there =
      in_percent(d.predicted.after[d.best], "porosity {:.1f} % (90 %: {:.1f} to {:.1f})") +
      in_percent(d.predicted.cracked[d.best], ", cracked particles {:.0f} % ({:.0f} to {:.0f})");
  if (kPercent * best.all < 1.0)
    fmt::print("{0}: no {1} from {2:.{6}f} to {3:.{6}f} {4} meets the target (less than 1 %); at "
               "{5:.{6}f} {4}: {7}\n",
               d.film.name, gap ? "gap" : "pressure", d.chances.front().at, d.chances.back().at,
               unit, best.at, decimals, there);
  else
    fmt::print(
        "{}: {:.{}f} {} meets the target with {:.0f} % (with {:.0f} % or more for four of five "
        "materials that fit the data): {}\n",
        d.film.name, best.at, decimals, unit, kPercent * best.all, kPercent * best.assured, there);
  if (target.cracked_below < 1.0)
    fmt::print("  the porosity with {:.0f} %, the cracked particles with {:.0f} %\n",
               kPercent * best.porosity, kPercent * best.cracked);
  if (target.tortuosity_below < kMostTortuosity) {
    const Band &tau = d.predicted.tortuosity[d.best];
    fmt::print("  the tortuosity factor with {:.0f} %: {:.2f} ({:.2f} to {:.2f})\n",
               kPercent * best.tortuosity, tau.median, tau.low90, tau.high90);
  }
  for (const Confirmation &c : d.confirmed)
    say_confirmed(c);
  for (const std::string &text : d.predicted.beyond)
    fmt::print("  note: {}\n", text);
}

void write(const AskedFilms &a, const DesignOptions &o, const Target &target,
           const std::vector<Design> &designs) {
  nlohmann::ordered_json json = to_json(a.model.bank, target, set_by(o), designs);
  json["provenance"] = provenance(o);
  make_output_folder(o.folder);
  write_file(o.folder + "/design.json", json.dump(1) + "\n");
  write_file(o.folder + "/design.html", design_page(target, set_by(o), designs, json));
}

/// By runs of every recipe, written after each.
std::vector<Design> designs_by_runs(const AskedFilms &a, const DesignOptions &o,
                                    const Target &target, const std::vector<int> &passes,
                                    MissedRuns &missed) {
  std::vector<Design> out;
  for (const int n : passes)
    for (std::size_t k = 0; k < o.recipes.size(); ++k)
      missed.attempt(o.recipes[k], [&] {
        out.push_back(design_by_runs(a, o, k, target, n,
                                     n > 0 ? values_of("--gap", o.gaps, "um") : a.pressures));
        if (n > 1)
          out.back().film.name += fmt::format(", {} passes", n);
        write(a, o, target, out);
      });
  if (out.empty())
    missed.stop_if_any(true);
  return out;
}

/// By the bank's emulators; the proposals are confirmed by runs if that is asked for.
std::vector<Design> designs_by_bank(const AskedFilms &a, const DesignOptions &o,
                                    const Target &target, const std::vector<int> &passes,
                                    MissedRuns &missed) {
  std::vector<Design> out;
  for (const Film &f : a.films)
    out.push_back(design_of(a, o, f, target));
  write(a, o, target, out); // runs may fail
  for (std::size_t k = 0; o.runs > 0 && k < out.size(); ++k)
    for (const int n : passes)
      missed.attempt(o.recipes[k], [&] {
        Design &d = out[k];
        const Design run = design_by_runs(a, o, k, target, n, {d.chances[d.best].at});
        d.confirmed.push_back({n, run.predicted, run.chances.front()});
        write(a, o, target, out);
      });
  return out;
}

void run_design(const DesignOptions &o) {
  if (!o.by_runs && o.runs > 0 && (!o.vary.empty() || o.press_percent > 0.0))
    throw Failure(kBadInput, "--confirm runs recipes as they are: without --vary and "
                             "--press-percent.");
  const AskedFilms a = o.by_runs ? asked_to_run(o) : asked(o);
  check_target(a, o.porosity);
  const Target target = {o.porosity / kPercent, o.within / kPercent, o.cracked_below / kPercent,
                         o.tortuosity_below};
  const std::vector<int> passes = set_by(o) == SetBy::Gap ? passes_of(o) : std::vector<int>{0};
  MissedRuns missed;
  const std::vector<Design> designs = o.by_runs ? designs_by_runs(a, o, target, passes, missed)
                                                : designs_by_bank(a, o, target, passes, missed);
  for (const Design &d : designs)
    say(d, set_by(o), target);
  fmt::print("page: {0}/design.html\ndata: {0}/design.json\n", o.folder);
  missed.stop_if_any();
}

} // namespace

void set_up_design(CLI::App &verb) {
  auto o = std::make_shared<DesignOptions>();
  add_film_options(verb, *o);
  verb.add_option("--porosity", o->porosity, "wanted total porosity after release [%]")
      ->required()
      ->check(finite_range(1.0, 79.0, "%"));
  verb.add_option("--within", o->within, "allowed deviation from it in points (default 1)")
      ->check(finite_range(0.01, 20.0, "points"));
  verb.add_option("--cracked-below", o->cracked_below,
                  "limit of the cracked particles [%]; default: none")
      ->check(finite_range(0.1, 100.0, "%"));
  verb.add_option("--tortuosity-below", o->tortuosity_below,
                  "limit of the tortuosity factor of the pores through the plane; default: none")
      ->check(finite_range(1.0, kMostTortuosity));
  verb.add_option("--pressure", o->pressures,
                  "MPa to choose from: a list or a range; default: the bank's");
  add_run_options(verb, o->runs, o->study, "--confirm",
                  "number of simulations of each recipe at the pressure or gap proposed, each with "
                  "another draw of the material on another packing");
  add_gap_options(verb, *o, "--confirm");
  const CLI::Option *runs =
      add_other_runs(verb, o->runs, "--runs", "--confirm",
                     "number of simulations of each recipe at each pressure or gap, instead of the "
                     "bank's emulators: "
                     "for electrodes that the bank does not have, such as other particle sizes");
  verb.callback([o, runs] {
    o->by_runs = runs->count() > 0;
    run_design(*o);
  });
}

} // namespace calendem
