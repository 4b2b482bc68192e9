// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/chances.h"
#include "diagnose/inference/scatter.h"
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr double kSmallestChance = 1e-280; // beyond, sqrt(square) serves: it has the same limit

} // namespace

double chance_beyond(double square, int n, double degrees_of_freedom) {
  if (!(square > 0.0))
    return 1.0;
  if (degrees_of_freedom >= kNormal)
    return cdf(complement(boost::math::chi_squared(n), square));
  return cdf(complement(boost::math::fisher_f(n, degrees_of_freedom), square / n));
}

double equivalent_z(double square, int n) {
  const double chance = n == 1 ? 0.0 : chance_beyond(square, n, kNormal);
  if (chance < kSmallestChance)
    return std::sqrt(square);
  return quantile(complement(boost::math::normal(), 0.5 * chance));
}

} // namespace calendem::inference
