// SPDX-License-Identifier: GPL-2.0-or-later
// Films by runs of their own, each with the material of one draw of the calibration on a packing of
// its own: where the bank does not have them, and to confirm what its emulators say.
#ifndef CALENDEM_PREDICT_OWN_RUNS_H
#define CALENDEM_PREDICT_OWN_RUNS_H

#include "predict/by_gap.h"
#include "simulate/study.h"
#include <functional>

namespace calendem {

constexpr int kFewestOwnRuns = 4; // of a band

/// The recipe may be pressed with a draw's material: the case that follows is not refused.
bool can_be_run(const FilmBank &bank, const Draw &draw, const Recipe &recipe, int material);

/// Places of `runs` of `count` draws at equal distances; one that cannot be run makes way for the next
/// that can. If none can, it stays and its runs are refused.
std::vector<std::size_t> spread_draws(std::size_t count, int runs,
                                      const std::function<bool(std::size_t)> &can_be_run);

/// `runs` draws of the calibration, so chosen.
std::vector<Draw> some_draws(const FilmBank &bank, const Calibration &calibration,
                             const Recipe &recipe, int material, int runs);

/// The runs: for each draw one to each pressure. Any electrode of `material`, a place in
/// Draw::materials; the bank's case.
Study own_runs(const FilmBank &bank, const std::vector<Draw> &draws, const Recipe &recipe,
               int material, const std::vector<double> &pressures);

/// The runs under a roll: for each draw one to each gap [um], in `passes` that reduce the film's
/// thickness in equal steps.
Study own_runs_at_gaps(const FilmBank &bank, const std::vector<Draw> &draws, const Recipe &recipe,
                       int material, const std::vector<double> &gaps, int passes);

/// A film by runs of its own.
struct ByRuns {
  PredictedFilm predicted;
  PredictionsOf of; ///< at its pressures
};

/// Adds what an error of the press's pressure adds (`pressure_sd` of its logarithm): the slope is
/// that of the mean of all draws between the neighbours of each of two pressures or more, ascending.
void add_press_error(Predictions &draws, const std::vector<double> &pressures, double pressure_sd);

/// Makes the runs in `options.folder`; the same call goes on where it was. To what a run gives, the
/// model error is added as the calibration left it, and that of the press; packings and parameters
/// scatter the runs themselves. Throws Failure(3) where fewer than kFewestOwnRuns draws have all
/// their runs.
ByRuns by_runs(const FilmBank &bank, const Calibration &calibration, const Recipe &recipe,
               int material, const std::vector<double> &pressures, double pressure_sd, int runs,
               const StudyOptions &options);

/// Gaps by runs to them, draws x gaps. The model error changes the pressure that a gap takes: the
/// emulators tell what that changes in the run's springback, cracks and tortuosity.
GapDraws from_runs_at_gaps(const FilmBank &bank, const Calibration &calibration, GapDraws at,
                           const std::vector<Draw> &draws,
                           const std::vector<std::vector<bank::PressedFilm>> &runs);

/// Makes these runs under a roll. Throws as by_runs, and Failure(2) as under_gaps.
GapDraws runs_at_gaps(const FilmBank &bank, const Calibration &calibration, const Recipe &recipe,
                      int material, const std::vector<double> &gaps, int passes, int runs,
                      const StudyOptions &options);

/// A measured film, run again: total porosity after release, 0-1.
struct Confirmed {
  std::string film;
  double pressure = 0.0; ///< [MPa]
  double measured = 0.0, sd = 0.0;
  int runs = 0;
  double mean = 0.0, low = 0.0, high = 0.0; ///< of the runs
  double emulated = 0.0;                    ///< mean of the emulators for the same draws
  double error = 0.0; ///< standard error of mean - emulated, from the scatter of the runs
};

/// Runs draws of the calibration on its film number `film`, to each pressure at which its porosity
/// was measured. Throws as by_runs.
std::vector<Confirmed> confirmed_by_runs(const FilmBank &bank, const Calibration &calibration,
                                         int film, const Recipe &recipe, int runs,
                                         const StudyOptions &options);

} // namespace calendem

#endif
