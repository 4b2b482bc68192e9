// SPDX-License-Identifier: GPL-2.0-or-later
// What data that were not measured would tell between hypotheses.
#ifndef CALENDEM_INFERENCE_FURTHER_DATA_H
#define CALENDEM_INFERENCE_FURTHER_DATA_H

#include "inference/posterior.h"

namespace calendem::inference {

/// What a measurement is expected to be worth.
struct ExpectedGain {
  double information = 0.0; ///< loss of entropy of the hypotheses [nats]
  double probability = 0.0; ///< of the right hypothesis
};

/// `film` of the problem has further data behind its measured ones, whose observed values do not
/// matter; `further`: places among them that are measured together. `hypotheses`: a number from 0 on
/// for each draw. Under each hypothesis the data are taken as normal, with moments over its draws and
/// given what was measured.
std::vector<ExpectedGain> expected_gains(const PosteriorProblem &problem,
                                         const Posterior &posterior, int film,
                                         Eigen::Index measured,
                                         const std::vector<std::vector<int>> &further,
                                         const std::vector<int> &hypotheses);

} // namespace calendem::inference

#endif
