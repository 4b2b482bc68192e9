// SPDX-License-Identifier: GPL-2.0-or-later
// The error model of an experiment: several specimens pressed alike are one condition that is known
// better; errors that several observables share are terms of known size in the covariance, and lines
// of the page's budget.
#ifndef CALENDEM_DIAGNOSE_ERROR_MODEL_H
#define CALENDEM_DIAGNOSE_ERROR_MODEL_H

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

constexpr const char *kPressureOfThePress = "pressure of the press";

/// The covariance is the sum of column column^T.
struct ErrorTerm {
  std::string name;
  inference::Matrix columns; ///< observables x independent errors
};

/// Errors of the observables of all conditions in order. `points`: those of the bank, whose base
/// model says what an error of porosity does to each.
/// pressure: the press's, common to all. loading, initial porosity, porosity under pressure,
/// thickness: of a specimen, common to its conditions. Of a condition's curve: the first touch,
/// common to its points; drift, growing from there to the end of the release. Between the bank's
/// pressures: what interpolation is off by (error_between_runs), common to a condition's values
/// after release, and to those under load. Those of the bank's file (numerics): common to all, if
/// the experiment was made on a press.
std::vector<ErrorTerm> error_terms(const Experiment &experiment, const BankSpec &bank,
                                   const std::vector<CoveredCondition> &all,
                                   const std::vector<PointRuns> &points);

/// Sum over the terms.
inference::Matrix covariance_of(const std::vector<ErrorTerm> &terms, Eigen::Index observables);

} // namespace calendem

#endif
