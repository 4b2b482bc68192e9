// SPDX-License-Identifier: GPL-2.0-or-later
// A film that the bank does not have, by runs of its own: each with the material of one draw of the
// calibration, on a packing of its own.
#ifndef CALENDEM_PREDICT_BY_RUNS_H
#define CALENDEM_PREDICT_BY_RUNS_H

#include "predict/prediction.h"
#include "simulate/study.h"

namespace calendem {

constexpr int kFewestOwnRuns = 4; // of a band

/// `runs` draws at equal distances among the calibration's.
std::vector<Draw> some_draws(const Calibration &calibration, int runs);

/// The runs: for each draw one to each pressure. Any electrode; the bank's case.
Study own_runs(const FilmBank &bank, const std::vector<Draw> &draws, const Recipe &recipe,
               const std::vector<double> &pressures);

/// A film by runs of its own.
struct ByRuns {
  PredictedFilm predicted;
  GuessesOf of; ///< at its pressures
};

/// Makes the runs in `options.folder`; the same call goes on where it was. To what a run gives, the
/// model error is added as the calibration left it; packings and parameters scatter the runs
/// themselves. Throws Failure(3) where fewer than kFewestOwnRuns draws have all their runs.
ByRuns by_runs(const FilmBank &bank, const Calibration &calibration, const Recipe &recipe,
               const std::vector<double> &pressures, int runs, const StudyOptions &options);

} // namespace calendem

#endif
