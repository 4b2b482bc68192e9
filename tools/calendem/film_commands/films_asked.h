// SPDX-License-Identifier: GPL-2.0-or-later
// What predict and design have in common on the command line: the model, the films that are asked
// for, and runs of their own.
#ifndef CALENDEM_FILM_COMMANDS_FILMS_ASKED_H
#define CALENDEM_FILM_COMMANDS_FILMS_ASKED_H

#include "base/messages.h"
#include "predict/files.h"
#include "predict/prediction.h"
#include <CLI/CLI.hpp>
#include <functional>

namespace calendem {

constexpr int kOfRange = 25; ///< values at equal ratios

struct FilmOptions {
  std::string model, folder;
  std::vector<std::string> recipes, vary;
  std::string pressures, gaps, passes = "1", material; ///< no pressures: the range of the bank's
  double press_percent = 0.0;
  int runs = 0; ///< of each film's own at each pressure; 0: the bank's emulators
  StudyOptions study;
};

void add_film_options(CLI::App &verb, FilmOptions &options);
/// Adds the options of runs of their own; `name`, `what`: of the option that asks for them.
void add_run_options(CLI::App &verb, int &runs, StudyOptions &study, const char *name,
                     const char *what);
/// Another option that asks for them, instead of the first.
CLI::Option *add_other_runs(CLI::App &verb, int &runs, const char *name, const char *instead_of,
                            const char *what);

/// --gap instead of --pressure, and --passes with runs of a film's own (`runs`: of that option).
void add_gap_options(CLI::App &verb, FilmOptions &options, const std::string &runs);

struct AskedFilms {
  Model model;
  int material = 0; ///< place in Draw::materials
  std::vector<Film> films;
  std::vector<double> pressures;
};

/// "20,50,80" or "20:300", which is kOfRange values, ascending. Without a unit what is
/// wrong is said of whole numbers. Throws Failure(2).
std::vector<double> values_of(const std::string &option, const std::string &text,
                              const std::string &unit);

/// Median and 90 % interval of a share in percent, by a format of three numbers.
std::string in_percent(const Band &band, const char *format = "{:5.1f} ({:.1f} to {:.1f})");

/// Model and pressures, no films yet.
AskedFilms of_model(const FilmOptions &options);
/// With the films, which the bank must have. Throws Failure(2).
AskedFilms asked(const FilmOptions &options);

/// With the films of any electrode, to be run. Throws Failure(2) where what is asked cannot be run.
AskedFilms asked_to_run(const FilmOptions &options);

nlohmann::ordered_json provenance(const FilmOptions &options);

/// Runs a recipe, by its place in the list.
ByRuns run_film(const AskedFilms &asked, const FilmOptions &options, std::size_t recipe,
                const std::vector<double> &pressures);

/// Runs it at gaps, under a roll.
GapDraws run_film_at_gaps(const AskedFilms &asked, const FilmOptions &options, std::size_t recipe,
                          const std::vector<double> &gaps, int passes);
/// Numbers of passes, ascending. Throws Failure(2).
std::vector<int> passes_of(const FilmOptions &options);

/// What could not be run of a recipe; the others go on.
class MissedRuns {
public:
  /// Does the work of a recipe; keeps why it failed.
  void attempt(const std::string &recipe, const std::function<void()> &work);
  /// After all that there is was written; `nothing`: there is nothing.
  void stop_if_any(bool nothing = false) const;

private:
  std::vector<std::string> texts_;
  ExitStatus status_ = kDone;
};

} // namespace calendem

#endif
