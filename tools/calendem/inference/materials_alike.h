// SPDX-License-Identifier: GPL-2.0-or-later
// How much one material says about another before the data. Scores of any two have the material
// correlation rho. In each effect a material follows what all have in common with the probability
// sqrt(rho), and two that follow agree; others have it with its own probability.
#ifndef CALENDEM_INFERENCE_MATERIALS_ALIKE_H
#define CALENDEM_INFERENCE_MATERIALS_ALIKE_H

#include "inference/posterior.h"

namespace calendem::inference {

/// A normal distribution of a score.
struct ScorePrior {
  double mean = 0.0, variance = 1.0;
};
/// Given the sum of the scores that others have.
ScorePrior score_given(double sum, int others, double correlation);

/// ln of the odds that an effect acts in a material, given in how many others it acts and not.
double log_odds_given(double probability, int acting, int not_acting, double correlation);

/// What a material may be, given the others of a draw.
struct MaterialPrior {
  Vector mean;     ///< of the scores of its parameters
  double variance; ///< of each of them
  std::vector<ScorePrior> amplitudes;
  Vector log_odds; ///< of the effects
};
MaterialPrior material_given(const PosteriorProblem &problem, const Draw &draw, int material);

/// ln density of the scores and effects of all materials that were measured, but for a constant.
double log_density_of_materials(const PosteriorProblem &problem, const Draw &draw);

/// The draw with one more material, drawn given the others.
Draw with_another_material(const PosteriorProblem &problem, const Draw &draw, std::uint64_t seed,
                           std::uint64_t purpose);

} // namespace calendem::inference

#endif
