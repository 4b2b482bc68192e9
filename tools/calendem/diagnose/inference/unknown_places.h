// SPDX-License-Identifier: GPL-2.0-or-later
// Where an effect that no table has may act, and how.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_UNKNOWN_PLACES_H
#define CALENDEM_DIAGNOSE_INFERENCE_UNKNOWN_PLACES_H

#include "diagnose/inference/which.h"

namespace calendem::inference {

struct UnknownPlace {
  std::string name;
  double share = 1.0; ///< of the unknown's prior
  Matrix unknown;     ///< covariance of the discrepancy
  Hypothesis hypothesis;
};

/// All that are worth computing: their shares sum to less than 1 where others cannot matter.
/// `best`: the effects beside which the unknown is sought; `so_far`: hypotheses with their
/// evidence.
std::vector<UnknownPlace> unknown_places(const Problem &problem, const Which &so_far,
                                         const std::vector<int> &best, const Priors &priors);

} // namespace calendem::inference

#endif
