// SPDX-License-Identifier: GPL-2.0-or-later
// Errors that several observables of an experiment share: of the press, of a specimen, of the bank's
// numerics. Each is a term of known size in the covariance, and a line of the page's budget.
#ifndef CALENDEM_DIAGNOSE_ERROR_TERMS_H
#define CALENDEM_DIAGNOSE_ERROR_TERMS_H

#include "diagnose/bank_points.h"

namespace calendem {

constexpr const char *kPressureOfThePress = "pressure of the press";

/// The covariance is the sum of column column^T.
struct ErrorTerm {
  std::string name;
  inference::Matrix columns; ///< observables x independent errors
};

/// Of the observables of all conditions in order. `points`: those of the bank, whose base model
/// says what an error of porosity does to each.
/// pressure: the press's, common to all. loading, initial porosity, porosity under pressure,
/// thickness: of a specimen, common to its conditions. drift: of a condition's curve, growing from
/// the first touch to the end of the release. Those of the bank's file (numerics): common to all, if
/// the experiment was made on a press.
std::vector<ErrorTerm> error_terms(const Experiment &experiment, const BankSpec &bank,
                                   const std::vector<CoveredCondition> &all,
                                   const std::vector<PointRuns> &points);

/// Sum over the terms.
inference::Matrix covariance_of(const std::vector<ErrorTerm> &terms, Eigen::Index observables);

} // namespace calendem

#endif
