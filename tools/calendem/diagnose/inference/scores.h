// SPDX-License-Identifier: GPL-2.0-or-later
// How good a series of probabilistic diagnoses was, once the truths are known.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_SCORES_H
#define CALENDEM_DIAGNOSE_INFERENCE_SCORES_H

#include <functional>
#include <utility>
#include <vector>

namespace calendem::inference {

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

/// Area under the receiver operating characteristic: the chance that a positive case scores higher
/// than a negative one, ties count half. NaN without both kinds. Hanley and McNeil, Radiology 143
/// (1982) 29.
double auroc(const std::vector<double> &scores, const std::vector<bool> &positive);

/// Interval of a statistic of cases by drawing whole clusters (cases that share a truth, a packing)
/// with replacement; percentiles. `statistic` gets the places of the cases drawn, and may return
/// NaN for draws it has no value for. Davison and Hinkley 1997, section 3.8.
std::pair<double, double>
clustered_bootstrap(const std::vector<int> &cluster_of_case,
                    const std::function<double(const std::vector<int> &)> &statistic,
                    double confidence = 0.9, int draws = 2000, unsigned long long seed = 1);

/// Exact interval of a proportion, `hits` of `trials`. Clopper and Pearson, Biometrika 26 (1934)
/// 404.
std::pair<double, double> clopper_pearson(int hits, int trials, double confidence = 0.9);

} // namespace calendem::inference

#endif
