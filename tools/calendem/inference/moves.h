// SPDX-License-Identifier: GPL-2.0-or-later
// Moves of the sampler's particles. Each leaves the posterior at the ensemble's temperature as it is.
#ifndef CALENDEM_INFERENCE_MOVES_H
#define CALENDEM_INFERENCE_MOVES_H

#include "inference/ensemble.h"
#include "inference/local_model.h"

namespace calendem::inference {

/// Local models of a material for several sizes of the discrepancy, about the particles' middle.
std::vector<LocalModel> local_models(Ensemble &ensemble, int material);

/// Takes an effect that acts, or none, away and puts another, none or the same with another
/// amplitude in its place, while the parameters move to make up for the change. Returns the accepted
/// share.
double move_switches(Ensemble &ensemble, int material, const std::vector<LocalModel> &models);

/// Moves the parameters of a material within the local model's posterior; `step` 0-1: 1 is a new
/// draw from it. Returns the accepted share.
double move_parameters(Ensemble &ensemble, int material, const std::vector<LocalModel> &models,
                       double step);

/// Moves the size of the discrepancy, its shares and the factors on stated errors.
void move_errors(Ensemble &ensemble);

} // namespace calendem::inference

#endif
