// SPDX-License-Identifier: GPL-2.0-or-later
// Which pairs of effects are worth an integral.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_PAIRS_H
#define CALENDEM_DIAGNOSE_INFERENCE_PAIRS_H

#include "diagnose/inference/which.h"

namespace calendem::inference {

/// A pair, and an estimate of ln of its evidence.
struct Promise {
  Hypothesis pair;
  double log_evidence = 0.0;
};

/// All pairs, the most promising first. The estimate is the mean of the likelihood over a grid of
/// both effects' scores, 16 points of the prior each, the base model linear about the fit of one of
/// them alone and integrated in closed form; of the two such estimates the larger. Two effects that
/// hide each other are found so, although neither fits alone. `so_far`: the single effects' fits.
std::vector<Promise> promising_pairs(const Problem &problem, const Which &so_far);

} // namespace calendem::inference

#endif
