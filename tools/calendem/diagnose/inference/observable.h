// SPDX-License-Identifier: GPL-2.0-or-later
// What experiment and simulation both give: a list of numbers, each with its place in the process.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_OBSERVABLE_H
#define CALENDEM_DIAGNOSE_INFERENCE_OBSERVABLE_H

#include "diagnose/inference/numerics.h"
#include <string>
#include <vector>

namespace calendem::inference {

/// One number. A curve is several that differ in `coordinate` only.
struct ObservableId {
  std::string name;        ///< with its unit, as in curve.csv
  std::string stage;       ///< compression, dwell, relaxation, ...
  std::string condition;   ///< id of the experiment's condition
  double coordinate = 0.0; ///< of a point of a curve, scaled to 0-1 over the curve
};

/// An experiment's values, in scales in which their errors are about normal (take the logarithm or
/// the logit before, of bank and experiment alike).
struct ObservableVector {
  std::vector<ObservableId> of;
  Vector values;
  Matrix covariance; ///< of measurement, and of numerics where known; square of the values' units
};

/// The observables of one name, stage and condition: a scalar or a curve.
struct Block {
  std::string name, stage, condition;
  std::vector<int> members; ///< places in the list, in its order
};

/// In the order of first appearance.
std::vector<Block> blocks_of(const std::vector<ObservableId> &all);

/// "name|stage|condition|coordinate": a column of the bank's table.
std::string key_of(const ObservableId &observable);

/// Places of `wanted` in `all`. Throws Failure(2) that names every one that is not there.
std::vector<int> places_in(const std::vector<ObservableId> &all,
                           const std::vector<ObservableId> &wanted);

/// Throws Failure(2): sizes that differ, values that are no numbers, a covariance that is not
/// symmetric and positive definite.
void check(const ObservableVector &experiment);

} // namespace calendem::inference

#endif
