// SPDX-License-Identifier: GPL-2.0-or-later
// Base parameters where something unknown acts: it may move what they move, too.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_BASE_BESIDE_UNKNOWN_H
#define CALENDEM_DIAGNOSE_INFERENCE_BASE_BESIDE_UNKNOWN_H

#include "base/random.h"
#include "diagnose/inference/which.h"

namespace calendem::inference {

/// `count` of the columns, evenly spaced from a random one on.
Matrix spread_over(const Matrix &draws, Eigen::Index count, Random &random);

/// Draws of the base parameters' scores [base parameters x count], each beside one draw of the
/// unknown's posterior (its size, and what effects beside it do). The evidence keeps the discrepancy
/// off what recalibration can do, for there nothing tells the two apart; the parameters must not
/// profit from that. Here the discrepancy has the covariance `anywhere` (of one standard deviation,
/// times the draw's size squared). Candidates come from a t distribution about the posterior of a
/// linear model, where Gauss and Newton's steps from the unknown's mode lead,
///   precision 1 + J^T C^-1 J, mean precision^-1 J^T C^-1 (observed - predicted + J at),
/// C the errors' covariance and the discrepancy's; one of 16 is taken with a probability
/// proportional to its posterior density over the density that it was drawn from. Kennedy and
/// O'Hagan, J. R. Stat. Soc. B 63 (2001) 425, section 4.5, for one size at a time;
/// sampling-importance resampling: Rubin, Bayesian Statistics 3 (1988) 395.
Matrix base_beside_unknown(const Problem &problem, const Judged &unknown, const Matrix &anywhere,
                           Eigen::Index count, Random &random);

} // namespace calendem::inference

#endif
