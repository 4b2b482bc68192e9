// SPDX-License-Identifier: GPL-2.0-or-later
// The answer that a posterior allows: one rule on its draws.
#ifndef CALENDEM_INFERENCE_VERDICT_H
#define CALENDEM_INFERENCE_VERDICT_H

#include "inference/active_effects.h"

namespace calendem::inference {

struct Verdict {
  enum Kind {
    explained,    ///< by `effects`, each of which acts
    one_of,       ///< `effects`: which of them acts, these data do not say
    unknown,      ///< nothing of the table
    nothing_seen, ///< nothing that these data could show
    undecided     ///< `credible` lists what is left
  };
  Kind kind = undecided;
  std::vector<Switch> effects;
  double probability = 0.0; ///< of the answer
  double adequacy = 0.0;    ///< posterior predictive p-value
  double strongest = 0.0;   ///< largest Bayes factor of an effect
  DiscrepancyEvidence discrepancy;
  std::vector<RankedHypothesis> credible; ///< sets of effects that reach 95 %
};

struct VerdictSettings {
  double certain = 0.8;   ///< probability of a name
  double adequate = 0.01; ///< least p-value beside a name
  double unseen = 3.0;    ///< largest Bayes factor of what is not seen
};

/// Names effects that act with `certain` if the data are adequate; else a group of which one acts;
/// else something unknown if the discrepancy is visible with `certain` and the data speak for it;
/// else nothing, if neither an effect nor the discrepancy gained by more than `unseen`.
Verdict verdict_of(const PosteriorProblem &problem, const Posterior &posterior, int material,
                   double adequacy, const VerdictSettings &settings = {});

} // namespace calendem::inference

#endif
