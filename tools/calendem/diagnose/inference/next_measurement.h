// SPDX-License-Identifier: GPL-2.0-or-later
// Which further measurement would distinguish the leading hypotheses.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_NEXT_MEASUREMENT_H
#define CALENDEM_DIAGNOSE_INFERENCE_NEXT_MEASUREMENT_H

#include "diagnose/inference/which.h"

namespace calendem::inference {

/// A measurement that could be made. In `extended` the features are those of the diagnosis followed
/// by the new ones, `observed` holds the former only, and effects are the same.
struct Extension {
  std::string what;
  double cost = 0.0; ///< in any one unit
  Problem extended;
};

struct NextMeasurement {
  std::string what;
  double cost = 0.0;
  double now = 0.0;                  ///< expected probability of the right hypothesis as it is
  double expected_probability = 0.0; ///< and with the measurement
  double per_cost = 0.0;             ///< gain over cost; 0 where no cost is given
};

struct NextSettings {
  int leading = 5;       ///< hypotheses at most
  double covered = 0.99; ///< of probability, by those
  int simulations = 400; ///< of the new data, for each of them
  unsigned long long seed = 1;
};

/// Largest expected probability first. Under each leading hypothesis the new features are normal
/// with the moments of its posterior draws, given what was observed; new data are drawn from each
/// hypothesis in turn and judged by all (expected posterior probability of the true model, Lindley,
/// Ann. Math. Stat. 27 (1956) 986 with another utility).
std::vector<NextMeasurement> next_measurements(const Which &which,
                                               const std::vector<Extension> &candidates,
                                               const NextSettings &settings);

} // namespace calendem::inference

#endif
