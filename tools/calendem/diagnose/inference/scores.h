// SPDX-License-Identifier: GPL-2.0-or-later
// How good a series of probabilistic diagnoses was, once the truths are known.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_SCORES_H
#define CALENDEM_DIAGNOSE_INFERENCE_SCORES_H

#include <functional>
#include <utility>
#include <vector>

namespace calendem::inference {

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

} // namespace calendem::inference

#endif
