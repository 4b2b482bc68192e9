// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/sobol_points.h"
#include "base/random.h"
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/sobol.hpp>

namespace calendem::inference {
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
