// SPDX-License-Identifier: GPL-2.0-or-later
// The difference between two experiments, one before and one after a change: what the model leaves
// out of both, the press's errors and the bank's numerics cancel.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_CHANGE_H
#define CALENDEM_DIAGNOSE_INFERENCE_CHANGE_H

#include "diagnose/inference/model.h"

namespace calendem::inference {

/// What is known of the base parameters' scores: normal.
struct KnownBase {
  Vector mean;
  Matrix covariance;
};

/// Of the base model recalibrated on an experiment. `predicted`: the observables there.
KnownBase recalibrated(const Model &model, const Vector &values, Vector &predicted);

/// `model` is of the differences' observables with their covariance; `values`: `predicted` and what
/// changed. Predictions are `predicted` and the difference that an effect makes at base parameters
/// as known; without an effect nothing changes, whatever they are. Two pieces scatter twice.
Problem change_of(const Model &model, const Vector &values, const Vector &predicted,
                  const KnownBase &base);

} // namespace calendem::inference

#endif
