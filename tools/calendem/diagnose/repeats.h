// SPDX-License-Identifier: GPL-2.0-or-later
// Several specimens pressed alike are one condition that is known better: its mean, what they
// scatter by, and readings that stand out.
#ifndef CALENDEM_DIAGNOSE_REPEATS_H
#define CALENDEM_DIAGNOSE_REPEATS_H

#include "diagnose/bank_points.h"

namespace calendem {

/// Mean of values that scatter by about `sd`, as far as these do: the scatter is `sd`'s, worth four
/// values, and theirs; errors follow a t distribution of four degrees of freedom, so that one that
/// stands out counts little (Lange, Little and Taylor, J. Am. Stat. Assoc. 84 (1989) 881).
struct RobustMean {
  double value = 0.0;
  double sd = 0.0;             ///< of the values about the mean
  double count = 0.0;          ///< values that count: sum of the weights
  std::vector<double> weights; ///< 0 to 1
};
RobustMean robust_mean(const std::vector<double> &values, double sd);

/// Conditions of other specimens at the same pressure (2 %) become one, with the first one's id.
/// Readings that hardly count, and specimens that scatter more than is stated, are reported.
std::vector<CoveredCondition> pooled_repeats(const Experiment &experiment,
                                             const std::vector<CoveredCondition> &all,
                                             std::vector<std::string> &not_said);

} // namespace calendem

#endif
