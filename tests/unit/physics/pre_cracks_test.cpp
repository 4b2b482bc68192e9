// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/pre_cracks.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {

constexpr int kBonds = 10000;

int cracked(double fraction, std::uint64_t seed) {
  int n = 0;
  for (int k = 1; k <= kBonds; ++k)
    n += pre_crack_factor(fraction, seed, k, k + 1) < 1.0;
  return n;
}

TEST(PreCracks, OffLeavesEveryBondAsItIs) { EXPECT_EQ(cracked(0.0, 1), 0); }

// Binomial: four standard deviations either side.
TEST(PreCracks, AreAsManyAsAsked) {
  for (const double f : {0.02, 0.1, 0.5})
    for (const std::uint64_t seed : {1, 2, 3})
      EXPECT_NEAR(cracked(f, seed), f * kBonds, 4.0 * std::sqrt(f * (1.0 - f) * kBonds));
}

TEST(PreCracks, GrowWithTheFractionAndKeepThoseThatWereThere) {
  for (int k = 1; k <= kBonds; ++k) {
    if (pre_crack_factor(0.1, 5, k, k + 1) < 1.0) {
      EXPECT_EQ(pre_crack_factor(0.2, 5, k, k + 1), kNoStrength);
    }
  }
}

TEST(PreCracks, DoNotDependOnTheOrderOfTags) {
  for (int k = 1; k <= 100; ++k)
    EXPECT_EQ(pre_crack_factor(0.3, 9, k, 2 * k + 1), pre_crack_factor(0.3, 9, 2 * k + 1, k));
}

// Cracked bonds have the same Weibull strengths as others: mean uniform 1/2 within four standard
// errors (1/sqrt(12 n)).
TEST(PreCracks, AreDrawnApartFromTheScatter) {
  double sum = 0.0;
  int n = 0;
  for (int k = 1; k <= kBonds; ++k)
    if (pre_crack_factor(0.3, 1, k, k + 1) < 1.0) {
      sum += pair_uniform(1, k, k + 1);
      ++n;
    }
  EXPECT_NEAR(sum / n, 0.5, 4.0 / std::sqrt(12.0 * n));
}

} // namespace
