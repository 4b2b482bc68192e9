// SPDX-License-Identifier: GPL-2.0-or-later
// Which effects act in a material, read from the draws of a posterior.
#ifndef CALENDEM_INFERENCE_ACTIVE_EFFECTS_H
#define CALENDEM_INFERENCE_ACTIVE_EFFECTS_H

#include "inference/local_model.h"

namespace calendem::inference {

/// Quantiles of a score or value over the draws.
struct CredibleRange {
  double median = 0.0, low90 = 0.0, high90 = 0.0;
};
CredibleRange credible_range(const std::vector<double> &values, const std::vector<double> &weights);

/// An effect of a material or a fault of one of its films.
struct ActiveEffect {
  Switch at;
  double probability = 0.0;  ///< that it acts, alone or with others
  double bayes_factor = 0.0; ///< its odds over those before the data; 0 if it is known to act
  CredibleRange score;       ///< of its amplitude, where it acts
};
/// In the order of `switches_of`.
std::vector<ActiveEffect> active_effects(const PosteriorProblem &problem,
                                         const Posterior &posterior, int material);

/// All effects that act, and no others.
struct RankedHypothesis {
  std::vector<Switch> effects; ///< empty: none
  double probability = 0.0;
};
/// Most probable first, until they reach `share`; effects that are known to act are left out.
std::vector<RankedHypothesis> ranked_hypotheses(const PosteriorProblem &problem,
                                                const Posterior &posterior, int material,
                                                double share = 0.95);

/// Range of a parameter's score over the draws.
CredibleRange parameter_range(const Posterior &posterior, int parameter, int material);

} // namespace calendem::inference

#endif
