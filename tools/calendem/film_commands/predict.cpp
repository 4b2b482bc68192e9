// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/shown.h"
#include "film_commands/film_commands.h"
#include "film_commands/films_asked.h"
#include "predict/by_gap.h"
#include <fmt/format.h>

namespace calendem {
namespace {

std::vector<PredictedFilm> by_emulators(const AskedFilms &a, const FilmOptions &o) {
  std::vector<PredictedFilm> films;
  for (const Film &f : a.films)
    films.push_back(
        predicted(a.model.bank, a.model.calibration, f, a.pressures, o.press_percent / kPercent));
  return films;
}

std::vector<PredictedFilm> films_by_runs(const AskedFilms &a, const FilmOptions &o,
                                         MissedRuns &missed) {
  std::vector<PredictedFilm> films;
  for (std::size_t k = 0; k < o.recipes.size(); ++k)
    missed.attempt(o.recipes[k],
                   [&] { films.push_back(run_film(a, o, k, a.pressures).predicted); });
  if (films.empty())
    missed.stop_if_any(true);
  return films;
}

void say(const AtGap &at) {
  fmt::print("  {:6.1f} um  {:5.0f} ({:.0f} to {:.0f})  {}  {}\n", at.gap, at.pressure.median,
             at.pressure.low90, at.pressure.high90, in_percent(at.after), in_percent(at.cracked));
  for (const auto &[share, where] : {std::pair(at.below, "below"), std::pair(at.above, "above")})
    if (share >= 0.01)
      fmt::print("    note: with {:.0f} % the pressure lies {} the bank's; its band ends there\n",
                 kPercent * share, where);
}

std::vector<GapDraws> films_at_gaps(const AskedFilms &a, const FilmOptions &o, MissedRuns &missed) {
  const std::vector<double> gaps = values_of("--gap", o.gaps, "um");
  std::vector<GapDraws> out;
  if (o.runs == 0) {
    for (const Film &f : a.films) {
      out.push_back(under_gaps(a.model.bank, a.model.calibration, f, gaps));
      check_reached(out.back());
    }
    return out;
  }
  for (const int passes : passes_of(o))
    for (std::size_t k = 0; k < o.recipes.size(); ++k)
      missed.attempt(o.recipes[k], [&] {
        out.push_back(run_film_at_gaps(a, o, k, gaps, passes));
        out.back().film.name += fmt::format(", {} pass{}", passes, passes == 1 ? "" : "es");
      });
  if (out.empty())
    missed.stop_if_any(true);
  return out;
}

void say_what_the_bank_lacks(const FilmBank &bank) {
  if (const std::string cut = bank.powder_cut_off(); !cut.empty())
    fmt::print("note: {}\n", cut);
}

void run_predict_at_gaps(const FilmOptions &o) {
  AskedFilms a = o.runs > 0 ? asked_to_run(o) : asked(o);
  MissedRuns missed;
  std::vector<std::vector<AtGap>> all;
  const std::vector<GapDraws> draws = films_at_gaps(a, o, missed);
  a.films.clear();
  for (const GapDraws &d : draws) {
    a.films.push_back(d.film);
    all.push_back(at_gaps(d));
  }
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
    for (const std::string &text : beyond_at_gaps(a.model.bank, a.films[k], all[k].front().runs))
      fmt::print("  note: {}\n", text);
  }
  say_what_the_bank_lacks(a.model.bank);
  fmt::print("page: {0}/gap.html\ntable: {0}/gap.csv\n", o.folder);
  missed.stop_if_any();
}

void run_predict(const FilmOptions &o) {
  if (!o.gaps.empty()) {
    run_predict_at_gaps(o);
    return;
  }
  const AskedFilms a = o.runs > 0 ? asked_to_run(o) : asked(o);
  MissedRuns missed;
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
      fmt::print("  {:6.1f} MPa  {}  {}\n", f.pressures[k], in_percent(f.after[k]),
                 in_percent(f.cracked[k]));
    for (const std::string &text : f.beyond)
      fmt::print("  note: {}\n", text);
  }
  say_what_the_bank_lacks(a.model.bank);
  fmt::print("page: {0}/prediction.html\ntable: {0}/prediction.csv\n", o.folder);
  missed.stop_if_any();
}

} // namespace

void set_up_predict(CLI::App &verb) {
  auto o = std::make_shared<FilmOptions>();
  add_film_options(verb, *o);
  verb.add_option("--pressure", o->pressures,
                  "MPa: 20,50,80 or a range 20:300; default: the bank's range");
  add_run_options(
      verb, o->runs, o->study, "--runs",
      "number of simulations of each recipe at each pressure or gap, each with another draw of "
      "the material, instead of the bank's emulators: for electrodes and pressures "
      "that the bank does not have");
  add_gap_options(verb, *o, "--runs");
  verb.callback([o] { run_predict(*o); });
}

} // namespace calendem
