// SPDX-License-Identifier: GPL-2.0-or-later
// Minimum of a smooth function of a few variables: BFGS with a backtracking line search
// (Nocedal and Wright, Numerical Optimization, 2006, algorithms 3.1 and 6.1).
#ifndef CALENDEM_DIAGNOSE_INFERENCE_QUASI_NEWTON_H
#define CALENDEM_DIAGNOSE_INFERENCE_QUASI_NEWTON_H

#include "diagnose/inference/linear.h"
#include <functional>

namespace calendem::inference {

struct Minimum {
  Vector at;
  double value = 0.0;
};

/// Value, and the gradient into the second argument. May be infinite away from the start.
using WithGradient = std::function<double(const Vector &, Vector &)>;

/// A local minimum from `start`; stops when a step gains less than 1e-9, or after `most` steps.
Minimum minimise(const WithGradient &function, const Vector &start, int most = 60);

/// The gradient by central differences of step 1e-4.
WithGradient with_differences(const std::function<double(const Vector &)> &function);

/// The second derivatives by central differences of the gradient.
Matrix hessian(const WithGradient &function, const Vector &at, double step);

} // namespace calendem::inference

#endif
