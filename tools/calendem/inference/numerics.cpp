// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/numerics.h"
#include "base/random.h"
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <memory>
#include <nlopt.h>

namespace calendem::inference {

namespace {

constexpr double kGain = 1e-9; // smaller ones end the search
constexpr int kCalls = 240;    // of the function, if it does not end before
constexpr double kDifference = 1e-4;

/// What NLopt asks for, and the least of it so far.
struct Search {
  const WithGradient &function;
  Minimum best;
};

double value_of(unsigned n, const double *x, double *slopes, void *data) {
  Search &search = *static_cast<Search *>(data);
  const Vector at = Vector::Map(x, n);
  Vector gradient = Vector::Zero(n);
  const double value = search.function(at, gradient);
  const bool finite = std::isfinite(value) && gradient.allFinite();
  if (finite && value < search.best.value)
    search.best = {at, value};
  if (slopes != nullptr)
    Vector::Map(slopes, n) = finite ? gradient : Vector(Vector::Zero(n));
  return finite ? value : HUGE_VAL;
}

} // namespace

Minimum minimise(const WithGradient &function, const Vector &start) {
  Search search{function, {start, INFINITY}};
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> lbfgs(
      nlopt_create(NLOPT_LD_LBFGS, unsigned(start.size())), nlopt_destroy);
  nlopt_set_min_objective(lbfgs.get(), value_of, &search);
  nlopt_set_ftol_abs(lbfgs.get(), kGain);
  nlopt_set_maxeval(lbfgs.get(), kCalls);
  Vector x = start;
  double unused = 0.0;
  nlopt_optimize(lbfgs.get(), x.data(), &unused); // where no step gains any more it says failure
  return search.best;
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

namespace {

constexpr std::uint64_t kShiftsStream = 0x50b01; // of the stream of shifts
constexpr double kEdge = 1e-12;                  // quantiles of 0 and 1 are infinite

} // namespace

Matrix sobol_points(int dimension, int count, std::uint64_t shift) {
  Matrix points(dimension, count);
  if (dimension == 0)
    return points;
  Vector by = Vector::Zero(dimension);
  Random random(shift, kShiftsStream);
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
