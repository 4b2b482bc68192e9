// SPDX-License-Identifier: GPL-2.0-or-later
// The content's integral, its moments, and the chance to be kept.
#include "physics/cbd_gradient.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {

const double kSlopes[] = {-1.0, -0.3, 0.0, 0.5, 1.0};

/// Simpson's rule, exact for cubics, of content times z^power from 0 to `top`.
double integral(const CbdGradient &g, int power, double top) {
  const auto at = [&](double z) { return g.content(z) * std::pow(z, power); };
  return top / 6.0 * (at(0.0) + 4.0 * at(0.5 * top) + at(top));
}

TEST(CbdGradient, ShareBelowIsTheIntegralOfTheContent) {
  for (const double slope : kSlopes)
    for (const double z : {0.0, 0.2, 0.7, 1.0})
      EXPECT_NEAR((CbdGradient{slope}.share_below(z)), integral({slope}, 0, z), 1e-15) << slope;
}

TEST(CbdGradient, SlopeIsTheSurfacesContentLessTheCollectorsOverTheirSum) {
  for (const double slope : kSlopes) {
    const CbdGradient g{slope};
    EXPECT_NEAR((g.content(1.0) - g.content(0.0)) / (g.content(1.0) + g.content(0.0)), slope,
                1e-15);
    EXPECT_NEAR(CbdGradient::slope_of(integral(g, 1, 1.0)), slope, 1e-15);
  }
}

// sd of 3 (2 z - 1) of one sphere is 6 sd(z).
TEST(CbdGradient, ScatterIsThatOfTheMeanOfHeights) {
  for (const double slope : kSlopes) {
    const double mean = integral({slope}, 1, 1.0),
                 variance = integral({slope}, 2, 1.0) - mean * mean;
    EXPECT_NEAR((CbdGradient{slope}.scatter(100.0)), 6.0 * std::sqrt(variance / 100.0), 1e-14);
  }
}

TEST(CbdGradient, SpheresAreKeptInProportionToTheContent) {
  for (const double slope : kSlopes)
    for (const double z : {0.0, 0.3, 1.0}) {
      const CbdGradient g{slope};
      EXPECT_NEAR(g.kept(z) * (1.0 + std::fabs(slope)), g.content(z), 1e-15);
      EXPECT_LE(g.kept(z), 1.0);
    }
}

// Requirement: without a gradient no placement changes, to the last bit.
TEST(CbdGradient, OfZeroKeepsEverySphere) {
  for (const double z : {-0.1, 0.0, 1.0 / 3.0, 1.0, 1.1})
    EXPECT_EQ(CbdGradient{}.kept(z), 1.0);
}

} // namespace
