// SPDX-License-Identifier: GPL-2.0-or-later
// What was measured beside what the models give for it, in the observables' own units.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_PREDICTIONS_H
#define CALENDEM_DIAGNOSE_INFERENCE_PREDICTIONS_H

#include "diagnose/inference/model.h"
#include "diagnose/inference/which.h"

namespace calendem::inference {

/// All vectors are of `of`, in the units of the observables.
struct Predictions {
  std::string best; ///< the most probable hypothesis that makes a prediction
  std::vector<ObservableId> of;
  Vector measured, sd_measurement;
  Vector sd;    ///< of measurement and packings
  Vector base;  ///< of the base model where it fits best: recalibrated, no effect on
  Vector after; ///< of `best` where it fits best, recalibrated too
};

/// From the emulators at the modes of the two hypotheses. What the emulators' features leave out of
/// a curve is that of the bank's mean curve.
Predictions predictions(const Model &model, const Problem &problem, const Which &which,
                        const Vector &measured);

/// The most probable hypothesis that makes a prediction: none, an effect, a pair.
const Judged &best_predicting(const Which &which);

} // namespace calendem::inference

#endif
