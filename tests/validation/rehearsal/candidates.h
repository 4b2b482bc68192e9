// SPDX-License-Identifier: GPL-2.0-or-later
// Single changes of a model that simpler methods choose from, and what they make of a film's readings.
#ifndef CALENDEM_TESTS_REHEARSAL_CANDIDATES_H
#define CALENDEM_TESTS_REHEARSAL_CANDIDATES_H

#include "diagnose/diagnosis.h"

namespace calendem {

/// A change and the effects that act with it.
struct Candidate {
  int change = -1; ///< place in Changes::all; -1: the model as it is
  std::vector<int> acting;
};

/// The model, then each change of an effect or of the press.
std::vector<Candidate> candidates_of(const Diagnosis &d);

/// Predictions of the film under several scores of the parameters and of the amplitudes that act.
inference::FilmPredictions predicted_with(const Diagnosis &d, const Candidate &c,
                                          const inference::Matrix &scores,
                                          const inference::Matrix &amplitudes);

/// What each candidate but the model, of middling amplitude, changes in the readings of the recalibrated
/// model's mean film: readings x changes.
inference::Matrix mean_changes(const Diagnosis &d, const std::vector<Candidate> &all);

/// One standard deviation of the readings' errors in each observable: readings x observables.
inference::Matrix deviations_of(const Diagnosis &d);

} // namespace calendem

#endif
