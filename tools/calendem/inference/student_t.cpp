// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/student_t.h"
#include "physics/pi.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace calendem::inference {

double log_student_t(double square, double log_determinant, int n, double nu) {
  if (nu >= kNormal)
    return -0.5 * (n * std::log(2.0 * kPi) + log_determinant + square);
  return std::lgamma(0.5 * (nu + n)) - std::lgamma(0.5 * nu) -
         0.5 * (n * std::log(nu * kPi) + log_determinant) -
         0.5 * (nu + n) * std::log1p(square / nu);
}

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
