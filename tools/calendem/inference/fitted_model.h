// SPDX-License-Identifier: GPL-2.0-or-later
// A model alone: some effects act, no fault, no discrepancy, errors as stated. What its recalibration
// leaves of the data, and whether that is more than noise leaves.
#ifndef CALENDEM_INFERENCE_FITTED_MODEL_H
#define CALENDEM_INFERENCE_FITTED_MODEL_H

#include "inference/posterior.h"

namespace calendem::inference {

/// The problem in which these effects (places) act for certain and nothing else; faults in one film
/// alone. Effects of the new problem are these, in their order.
PosteriorProblem problem_of_model(const PosteriorProblem &problem, const std::vector<int> &acting,
                                  int film);

/// Amplitudes of all effects of a problem, of which only these have one.
Matrix with_others_off(const Matrix &amplitudes, const std::vector<int> &acting,
                       std::size_t effects);

/// Effects of the user's model: `is_of_model`.
std::vector<int> effects_of_model(const PosteriorProblem &problem);

/// The data of all films, one behind another.
struct FittedModel {
  std::vector<int> acting; ///< places of effects in the problem that it was made of
  Posterior posterior;     ///< its draws
  Vector residual;         ///< measured - predicted, mean over the draws
  Matrix covariance;       ///< all errors of the data, mean over the draws
  /// Covariance of `residual` in worlds where the model is true: errors less what recalibration
  /// makes up for, C - cov(prediction over the draws); exact if all is linear and normal.
  Matrix expected;
};
FittedModel fit_model(const PosteriorProblem &problem, const std::vector<int> &acting, int film,
                      const SamplerSettings &settings);

/// 2000 columns of noise with this covariance, the same each time.
Matrix noise_of(const Matrix &covariance);

/// What is left of a block of data.
struct BlockResidual {
  int block = 0;
  double residual = 0.0; ///< predicted - measured; of several data their rms with the mean's sign
  double sd = 0.0;       ///< of the errors, rms
  double z = 0.0;        ///< of a normal variable as improbable, with the sign of `residual`
  double share = 0.0;    ///< part of the sum of squares of all z
  bool significant = false;
  int worst = 0; ///< datum that is farthest off in its errors
};
struct ResidualTable {
  std::vector<BlockResidual> rows; ///< of the blocks, in their order
  double threshold = 0.0;          ///< of |z|: the largest of the table passes it by chance in 5 %
};
ResidualTable residual_table(const FittedModel &model, const std::vector<Block> &blocks);

/// Root mean square of residuals in their errors, each block counting the same.
struct StandardisedGap {
  double value = 0.0;
  double noise = 0.0;      ///< what a true model leaves, in the mean ...
  double noise_most = 0.0; ///< ... and at most, with 95 %
};
StandardisedGap standardised_gap(const FittedModel &model, const std::vector<Block> &blocks);

} // namespace calendem::inference

#endif
