// SPDX-License-Identifier: GPL-2.0-or-later
// The sample's film beside the bank's: thicker, or another electrode's.
#ifndef CALENDEM_DIAGNOSE_SAMPLE_FILM_H
#define CALENDEM_DIAGNOSE_SAMPLE_FILM_H

#include "diagnose/bank_points.h"

namespace calendem {

/// The bank's films as those of another electrode: a run with what that electrode's runs differ by on
/// average, at the run's pressure. As they are if the bank stands for no other electrode.
class OtherFilm {
public:
  explicit OtherFilm(const BankTable &bank); ///< must outlive it
  SimulatedRun operator()(const SimulatedRun &run) const;

private:
  std::vector<std::pair<PointRuns, PointRuns>> pairs_; ///< of the bank, of the electrode
  std::vector<double> pressures_;
};

/// How thick the bank's films are beside the experiment's, without pores: mean of the base points,
/// or of the runs of the electrode that the bank stands for.
/// What a run's loading differs from that is a base parameter, not a film of another recipe. NaN
/// without base points.
double film_ratio(const Experiment &experiment, const BankTable &bank);

struct FullCellChange {
  inference::Vector change;     ///< of all observables; empty: none
  inference::Matrix covariance; ///< of the change at other parameters
};

/// Mean of runs of the same parameters on the full cell less those on the bank's, and what a
/// further one would scatter about it. A film is more porous at its faces, in layers that do not
/// grow with it: the change goes with 1 / loading, and is 0 for a sample of the bank's own loading.
/// None with fewer than two points; NaN for what fewer than two of them have. What is done is
/// reported in `not_said`.
FullCellChange full_cell_change(const Experiment &experiment, const BankTable &bank,
                                const std::vector<CoveredCondition> &all,
                                std::vector<std::string> &not_said);

} // namespace calendem

#endif
