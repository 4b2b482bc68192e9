// SPDX-License-Identifier: GPL-2.0-or-later
// What every part of the inference computes with: short names for vectors and matrices, minima,
// points that fill the unit cube evenly.
#ifndef CALENDEM_INFERENCE_NUMERICS_H
#define CALENDEM_INFERENCE_NUMERICS_H

#include <Eigen/Dense>
#include <cstdint>
#include <functional>

namespace calendem::inference {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using Cholesky = Eigen::LLT<Matrix>;

struct Minimum {
  Vector at;
  double value = 0.0;
};

/// Value, and the gradient into the second argument. May be infinite away from the start.
using WithGradient = std::function<double(const Vector &, Vector &)>;

/// A local minimum from `start` by NLopt's L-BFGS; stops when a step gains less than 1e-9, or after
/// 240 calls of the function.
Minimum minimise(const WithGradient &function, const Vector &start);

/// The gradient by central differences of step 1e-4.
WithGradient with_differences(const std::function<double(const Vector &)> &function);

/// dimension x count points in (0, 1): Boost's Sobol sequence (Joe and Kuo's direction numbers),
/// shifted modulo 1 by a vector that `shift` seeds (Cranley and Patterson 1976). 0: not shifted.
Matrix sobol_points(int dimension, int count, std::uint64_t shift);

/// Sobol's points as standard normal scores.
Matrix sobol_normals(int dimension, int count, std::uint64_t shift);

/// Quantile of the standard normal distribution, 0 < share < 1.
double normal_quantile(double share);

} // namespace calendem::inference

#endif
