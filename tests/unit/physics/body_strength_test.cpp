// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/body_strength.h"

#include <gtest/gtest.h>
#include <vector>

using namespace calendem;

namespace {

constexpr int kBodies = 100000;

std::vector<double> logarithms(double scatter, std::uint64_t seed) {
  std::vector<double> z;
  for (int body = 1; body <= kBodies; ++body)
    z.push_back(std::log(body_scatter_factor(scatter, seed, body)));
  return z;
}

double mean(const std::vector<double> &x, int power = 1, double about = 0.0) {
  double sum = 0.0;
  for (const double v : x)
    sum += std::pow(v - about, power);
  return sum / double(x.size());
}

TEST(BodyStrength, OffIsOneExactly) {
  for (int body = 1; body <= 100; ++body) {
    EXPECT_EQ(body_scatter_factor(0.0, 3, body), 1.0);
    EXPECT_EQ(body_size_factor(0.0, 4.35, 0.1 * body), 1.0);
  }
}

// Weibull modulus 3: strength as 1/d; the reference has the strength that is set; eight equal
// volumes in one are weaker by 8^(-1/m).
TEST(BodyStrength, LargeBodiesAreWeaker) {
  EXPECT_DOUBLE_EQ(body_size_factor(1.0, 4.0, 8.0), 0.5);
  EXPECT_DOUBLE_EQ(body_size_factor(1.0, 4.0, 2.0), 2.0);
  for (const double m : {1.0, 2.5, 5.0, 30.0}) {
    EXPECT_EQ(body_size_factor(3.0 / m, 4.35, 4.35), 1.0);
    EXPECT_NEAR(body_size_factor(3.0 / m, 4.35, 8.7), std::pow(8.0, -1.0 / m), 1e-15);
  }
}

// Four standard errors: mean 1 (variance exp(s^2) - 1), and of the logarithm mean -s^2/2 (s^2/n),
// sd s (s^2/2n), skewness 0 (6/n), kurtosis 3 (24/n).
TEST(BodyStrength, ScatterIsLognormalOfMeanOne) {
  const double root = std::sqrt(double(kBodies));
  for (const double s : {0.05, 0.3, 1.0})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const std::vector<double> logs = logarithms(s, seed);
      std::vector<double> factors;
      for (const double x : logs)
        factors.push_back(std::exp(x));
      EXPECT_NEAR(mean(factors), 1.0, 4.0 * std::sqrt(std::exp(s * s) - 1.0) / root);
      const double m = mean(logs), sd = std::sqrt(mean(logs, 2, m));
      EXPECT_NEAR(m, -0.5 * s * s, 4.0 * s / root);
      EXPECT_NEAR(sd, s, 4.0 * s / (std::sqrt(2.0) * root));
      EXPECT_NEAR(mean(logs, 3, m) / std::pow(sd, 3), 0.0, 4.0 * std::sqrt(6.0) / root);
      EXPECT_NEAR(mean(logs, 4, m) / std::pow(sd, 4), 3.0, 4.0 * std::sqrt(24.0) / root);
    }
}

// Correlation of neighbours' numbers, of seeds, and with the numbers of bonds: 0 within four
// standard errors.
TEST(BodyStrength, IsDrawnApart) {
  const std::vector<double> one = logarithms(1.0, 7), other = logarithms(1.0, 8);
  double next = 0.0, seeds = 0.0, bonds = 0.0;
  for (int k = 0; k + 1 < kBodies; ++k) {
    next += (one[k] + 0.5) * (one[k + 1] + 0.5) / kBodies;
    seeds += (one[k] + 0.5) * (other[k] + 0.5) / kBodies;
    bonds += (one[k] + 0.5) * (pair_uniform(7, k + 1, k + 1) - 0.5) * std::sqrt(12.0) / kBodies;
  }
  const double tolerance = 4.0 / std::sqrt(double(kBodies));
  EXPECT_NEAR(next, 0.0, tolerance);
  EXPECT_NEAR(seeds, 0.0, tolerance);
  EXPECT_NEAR(bonds, 0.0, tolerance);
}

} // namespace
