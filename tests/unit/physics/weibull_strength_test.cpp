// SPDX-License-Identifier: GPL-2.0-or-later
// Statistics of fixed seeds: each interval is four standard errors wide on either side, so that one
// seed in 16 000 would miss it; the seeds are fixed, so the tests cannot flicker.
#include "physics/weibull_strength.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

using namespace calendem;

namespace {

constexpr int kDraws = 10000;

// Strengths of a chain's bonds: tags 1-2, 2-3, ... as in a real body.
std::vector<double> chain(double modulus, std::uint64_t seed) {
  std::vector<double> x(kDraws);
  for (int n = 0; n < kDraws; ++n)
    x[n] = weibull_factor(modulus, seed, n + 1, n + 2);
  return x;
}

// Maximum likelihood: 1/m = sum x^m ln x / sum x^m - mean ln x, by bisection.
double fitted_modulus(const std::vector<double> &x) {
  double mean_log = 0.0;
  for (double v : x)
    mean_log += std::log(v) / x.size();
  double low = 0.1, high = 200.0;
  for (int n = 0; n < 100; ++n) {
    const double m = 0.5 * (low + high);
    double s0 = 0.0, s1 = 0.0;
    for (double v : x) {
      s0 += std::pow(v, m);
      s1 += std::pow(v, m) * std::log(v);
    }
    (s1 / s0 - mean_log - 1.0 / m > 0.0 ? high : low) = m;
  }
  return 0.5 * (low + high);
}

double fitted_scale(const std::vector<double> &x, double m) {
  double sum = 0.0;
  for (double v : x)
    sum += std::pow(v, m) / x.size();
  return std::pow(sum, 1.0 / m);
}

} // namespace

// Requirement: shape and scale are recovered from 1e4 bonds. Asymptotic standard errors of the
// maximum-likelihood estimates: 0.7797 m/sqrt(N) and 1.0526 x0/(m sqrt(N)).
TEST(WeibullStrength, ShapeAndScaleRecovered) {
  for (double m : {1.5, 3.0, 8.0, 20.0})
    for (std::uint64_t seed : {1ULL, 77ULL, 123456789ULL}) {
      const std::vector<double> x = chain(m, seed);
      const double fit = fitted_modulus(x);
      EXPECT_NEAR(fit, m, 4.0 * 0.7797 * m / std::sqrt(kDraws));
      const double x0 = 1.0 / std::tgamma(1.0 + 1.0 / m);
      EXPECT_NEAR(fitted_scale(x, fit), x0, 4.0 * 1.0526 * x0 / (m * std::sqrt(kDraws)));
    }
}

// Requirement: the mean factor is 1. Standard error from the law's variance.
TEST(WeibullStrength, MeanIsOne) {
  for (double m : {1.5, 3.0, 8.0}) {
    double mean = 0.0;
    for (double v : chain(m, 5))
      mean += v / kDraws;
    const double g1 = std::tgamma(1.0 + 1.0 / m), g2 = std::tgamma(1.0 + 2.0 / m);
    EXPECT_NEAR(mean, 1.0, 4.0 * std::sqrt((g2 / (g1 * g1) - 1.0) / kDraws));
  }
}

// Requirement: the whole distribution is Weibull, not only two of its numbers: Kolmogorov-Smirnov,
// critical value 2.23/sqrt(N) at a level of 1e-4.
TEST(WeibullStrength, WholeDistribution) {
  std::vector<double> x = chain(4.0, 9);
  std::sort(x.begin(), x.end());
  const double x0 = 1.0 / std::tgamma(1.25);
  double largest = 0.0;
  for (int n = 0; n < kDraws; ++n) {
    const double law = 1.0 - std::exp(-std::pow(x[n] / x0, 4.0));
    largest = std::max(
        {largest, std::fabs(law - double(n) / kDraws), std::fabs(law - double(n + 1) / kDraws)});
  }
  EXPECT_LT(largest, 2.23 / std::sqrt(kDraws));
}

// Requirement: bonds that share a sphere, and equal bonds of other seeds, are independent:
// |correlation| below 4/sqrt(N).
TEST(WeibullStrength, NeighboursAndSeedsAreIndependent) {
  const auto correlation = [](auto first, auto second) {
    double sum = 0.0;
    for (int n = 1; n <= kDraws; ++n)
      sum += 12.0 * (first(n) - 0.5) * (second(n) - 0.5) / kDraws; // uniform: variance 1/12
    return std::fabs(sum);
  };
  const double limit = 4.0 / std::sqrt(kDraws);
  const auto here = [](int n) { return pair_uniform(1, n, n + 1); };
  EXPECT_LT(correlation(here, [](int n) { return pair_uniform(1, n + 1, n + 2); }), limit);
  EXPECT_LT(correlation(here, [](int n) { return pair_uniform(1, n, n + 2); }), limit);
  EXPECT_LT(correlation(here, [](int n) { return pair_uniform(2, n, n + 1); }), limit);
}

// Requirement: the strength belongs to the pair, whichever side asks; another seed gives another.
TEST(WeibullStrength, OrderOfTagsDoesNotMatter) {
  for (int a = 1; a < 100; ++a)
    for (int b = a + 1; b < 100; ++b) {
      ASSERT_EQ(weibull_factor(5.0, 3, a, b), weibull_factor(5.0, 3, b, a));
      ASSERT_NE(weibull_factor(5.0, 3, a, b), weibull_factor(5.0, 4, a, b));
    }
}

// Requirement: a published seed means the same strengths on every machine and in later versions (up
// to the last bits of pow and log).
TEST(WeibullStrength, NumbersOfSplitMix) {
  // first outputs of the reference generator (Vigna, splitmix64.c) from state 0
  EXPECT_EQ(split_mix(0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(split_mix(0x9e3779b97f4a7c15ULL), 0x6e789e6aa1b965f4ULL);
}

TEST(WeibullStrength, ModulusZeroSwitchesScatterOff) {
  EXPECT_EQ(weibull_factor(0.0, 1, 2, 3), 1.0);
}
