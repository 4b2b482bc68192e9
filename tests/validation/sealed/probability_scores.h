// SPDX-License-Identifier: GPL-2.0-or-later
// Proper scores of probabilities, and the exact interval of a share.
#ifndef CALENDEM_TESTS_VALIDATION_SEALED_PROBABILITY_SCORES_H
#define CALENDEM_TESTS_VALIDATION_SEALED_PROBABILITY_SCORES_H

#include <utility>
#include <vector>

namespace calendem {

/// Mean of -ln p(truth) [nats], 0 is perfect. Rows: probabilities of the classes; a truth that was
/// given less than `floor` counts as `floor`. Good, J. R. Stat. Soc. B 14 (1952) 107.
double log_score(const std::vector<std::vector<double>> &probabilities,
                 const std::vector<int> &truths, double floor = 1e-6);

/// Mean over cases of sum over classes (p - [truth])^2, 0 to 2. Brier, Mon. Weather Rev. 78
/// (1950) 1.
double brier_score(const std::vector<std::vector<double>> &probabilities,
                   const std::vector<int> &truths);

/// 1 - Brier score / that of always giving `reference`; 1 perfect, 0 no better than the reference.
double brier_skill(const std::vector<std::vector<double>> &probabilities,
                   const std::vector<int> &truths, const std::vector<double> &reference);

/// Exact interval of a proportion, `hits` of `trials`. Clopper and Pearson, Biometrika 26 (1934)
/// 404.
std::pair<double, double> clopper_pearson(int hits, int trials, double confidence = 0.9);

} // namespace calendem

#endif
