// SPDX-License-Identifier: GPL-2.0-or-later
// Where the gap lies once the base model is recalibrated.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_WHERE_H
#define CALENDEM_DIAGNOSE_INFERENCE_WHERE_H

#include "diagnose/inference/problem.h"

namespace calendem::inference {

/// A block of features: one observable of one stage and condition.
struct WhereRow {
  int block = 0;
  double z = 0.0;     ///< predicted - observed in standard deviations that recalibration leaves;
                      ///< of a curve the |z| of equal chance, with the sign of its mean
  double share = 0.0; ///< of the sum over blocks of squared distances
  bool significant = false;
};

/// Two blocks that the base parameters can meet one at a time but not together.
struct Conflict {
  int one = 0, other = 0; ///< blocks
  double p = 1.0;         ///< of both together
};

/// Base parameters from one stage alone.
struct StageFit {
  std::string stage;
  Vector scores, sd;
};

struct Where {
  std::vector<WhereRow> rows; ///< largest |z| first
  double threshold = 0.0; ///< of |z|, crossed by any block in 5 % of all experiments without gap
  Matrix conflict;        ///< blocks x blocks: p of matching both; diagonal: of one alone
  std::vector<Conflict> conflicts; ///< p below 0.01 / number of pairs, each alone above 0.01
  std::vector<StageFit> stages;
};

struct WhereSettings {
  double false_alarm = 0.05; ///< of the whole table
  int simulations = 10000;
  unsigned long long seed = 1;
};

/// With `base` linearised at the recalibrated parameters. The residual after recalibration has the
/// covariance S (S + J J^T)^-1 S; thresholds come from simulated residuals, t-distributed.
Where where(const Problem &problem, const Linearised &base, const WhereSettings &settings);

/// Features of each block, truncation residuals too.
std::vector<std::vector<int>> features_by_block(const Problem &problem);

} // namespace calendem::inference

#endif
