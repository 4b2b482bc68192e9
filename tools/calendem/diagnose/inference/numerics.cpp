// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/numerics.h"
#include "base/random.h"
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/sobol.hpp>
#include <cmath>

namespace calendem::inference {

namespace {

constexpr double kGain = 1e-9;   // smaller ones end the search
constexpr double kArmijo = 1e-4; // of the promised descent that a step must keep
constexpr double kLongest = 2.0; // step, in any one variable: they are logarithms or scores
constexpr int kHalvings = 30;    // of a step
constexpr double kDifference = 1e-4;

/// Shortens `step` until the value falls enough; false: it does not.
bool descend(const WithGradient &function, const Vector &step, double slope, Minimum &best,
             Vector &gradient) {
  double length = 1.0;
  for (int k = 0; k < kHalvings; ++k, length *= 0.5) {
    Vector there_gradient(step.size());
    const Vector there = best.at + length * step;
    const double value = function(there, there_gradient);
    if (std::isfinite(value) && there_gradient.allFinite() &&
        value <= best.value + kArmijo * length * slope) {
      best = {there, value};
      gradient = there_gradient;
      return true;
    }
  }
  return false;
}

} // namespace

Minimum minimise(const WithGradient &function, const Vector &start, int most) {
  const auto n = start.size();
  Vector gradient(n);
  Minimum best{start, function(start, gradient)};
  Matrix inverse = Matrix::Identity(n, n);
  bool fresh = true; // no curvature seen yet
  for (int k = 0; k < most && n > 0; ++k) {
    Vector step = -inverse * gradient;
    if (step.dot(gradient) >= 0.0) {
      inverse.setIdentity();
      step = -gradient;
    }
    step *= std::min(1.0, kLongest / std::max(step.cwiseAbs().maxCoeff(), 1e-300));
    const Minimum before = best;
    const Vector old_gradient = gradient;
    if (!descend(function, step, step.dot(gradient), best, gradient)) {
      if (fresh)
        break;
      inverse.setIdentity();
      fresh = true;
      continue;
    }
    const Vector s = best.at - before.at, y = gradient - old_gradient;
    const double sy = s.dot(y);
    if (sy > 1e-12 * s.norm() * y.norm()) {
      if (fresh)
        inverse *= sy / y.squaredNorm();
      fresh = false;
      const Matrix left = Matrix::Identity(n, n) - s * y.transpose() / sy;
      inverse = left * inverse * left.transpose() + s * s.transpose() / sy;
    }
    if (before.value - best.value < kGain)
      break;
  }
  return best;
}

WithGradient with_differences(const std::function<double(const Vector &)> &function) {
  return [function](const Vector &x, Vector &gradient) {
    Vector at = x;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      at[i] = x[i] + kDifference;
      const double above = function(at);
      at[i] = x[i] - kDifference;
      gradient[i] = (above - function(at)) / (2.0 * kDifference);
      at[i] = x[i];
    }
    return function(x);
  };
}

Matrix hessian(const WithGradient &function, const Vector &at, double step) {
  const auto n = at.size();
  Matrix second(n, n);
  Vector moved = at, above(n), below(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    moved[i] = at[i] + step;
    function(moved, above);
    moved[i] = at[i] - step;
    function(moved, below);
    moved[i] = at[i];
    second.col(i) = (above - below) / (2.0 * step);
  }
  return 0.5 * (second + second.transpose());
}

namespace {

constexpr std::uint64_t kPurpose = 0x50b01; // of the stream of shifts
constexpr double kEdge = 1e-12;             // quantiles of 0 and 1 are infinite

} // namespace

Matrix sobol_points(int dimension, int count, std::uint64_t shift) {
  Matrix points(dimension, count);
  if (dimension == 0)
    return points;
  Vector by = Vector::Zero(dimension);
  Random random(shift, kPurpose);
  for (double &b : by)
    b = shift == 0 ? 0.0 : random.uniform();
  boost::random::sobol sequence(static_cast<std::size_t>(dimension));
  for (int k = 0; k < count; ++k)
    for (int j = 0; j < dimension; ++j) {
      const double p = double(sequence()) / 18446744073709551616.0 + by[j];
      points(j, k) = std::clamp(p - std::floor(p), kEdge, 1.0 - kEdge);
    }
  return points;
}

double normal_quantile(double share) {
  static const boost::math::normal normal;
  return quantile(normal, share);
}

Matrix sobol_normals(int dimension, int count, std::uint64_t shift) {
  return sobol_points(dimension, count, shift).unaryExpr(&normal_quantile);
}

} // namespace calendem::inference
