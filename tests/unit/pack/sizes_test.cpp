// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/body.h"
#include "physics/pi.h"
#include "support.h"
#include <numeric>

namespace {
using namespace calendem;
using calendem_test::cell;

double volume(const std::vector<double> &d) {
  double sum = 0.0;
  for (double x : d)
    sum += kPi / 6.0 * x * x * x;
  return sum;
}

// Diameter below which `share` of the sample's volume lies; `d` is sorted, largest first.
double percentile(const std::vector<double> &d, double share) {
  double sum = 0.0;
  for (size_t k = d.size(); k-- > 0;) {
    sum += kPi / 6.0 * d[k] * d[k] * d[k];
    if (sum >= share * volume(d))
      return d[k];
  }
  return d.front();
}

TEST(SizeLaw, HasTheVolumePercentilesOfThePaperSMaterial) {
  const SizeLaw law{4.35, 0.487, 1.3, 16.2};
  EXPECT_NEAR(law.volume_quantile(0.1), 4.6, 0.05);
  EXPECT_NEAR(law.volume_quantile(0.5), 8.3, 0.05);
  EXPECT_NEAR(law.volume_quantile(0.9), 13.4, 0.05);
}

TEST(SizeLaw, QuantileInvertsTheLaw) {
  const SizeLaw law{4.35, 0.487, 1.3, 16.2};
  EXPECT_NEAR(law.quantile(1e-12), 1.3, 1e-6);
  EXPECT_NEAR(law.quantile(1.0 - 1e-12), 16.2, 1e-3);
  EXPECT_NEAR(law.volume_above(law.volume_quantile(0.7)), 0.3, 1e-9);
  EXPECT_EQ(law.volume_above(20.0), 0.0);
  EXPECT_NEAR(law.volume_above(0.1), 1.0, 1e-12);
}

TEST(DrawDiameters, SampleOnThePaperSCellFollowsTheLaw) {
  const Recipe recipe = cell(30.166);
  const SizeLaw law = measured_law(recipe);
  const double wanted = recipe.area() * recipe.am_column();
  Random random(1, 1);
  const std::vector<double> d = draw_diameters(recipe, wanted, random);
  EXPECT_NEAR(volume(d) / wanted, 1.0, 0.02); // before it is made exact in whole primaries
  for (double q : {0.1, 0.5, 0.9})            // one body is up to 6 % of the volume
    EXPECT_NEAR(percentile(d, q) / law.volume_quantile(q), 1.0, 0.07) << q;
}

TEST(DrawDiameters, EverySeedGivesASmallCellTheSameMix) {
  const Recipe recipe = cell(15.0);
  for (int seed = 1; seed <= 20; ++seed) {
    Random random(seed, 1);
    const std::vector<double> d =
        draw_diameters(recipe, recipe.area() * recipe.am_column(), random);
    EXPECT_GE(d.size(), 50u);
    SizeLaw law = measured_law(recipe);
    law.high = recipe.largest_body();
    EXPECT_LE(d.front(), law.high);
    EXPECT_NEAR(percentile(d, 0.5) / law.volume_quantile(0.5), 1.0, 0.05) << seed;
  }
}

TEST(DrawDiameters, RefusesACellThatHoldsNoParticle) {
  Recipe recipe = cell(5.0);
  recipe.min_diameter = 3.0;
  Random random(1, 1);
  EXPECT_THROW(draw_diameters(recipe, 1000.0, random), Failure);
}

TEST(PrimaryCounts, AddUpExactlyAndKeepTheSizes) {
  const std::vector<double> d = {9.0, 7.0, 5.0, 3.0, 2.0, 1.5, 1.3};
  const double cells = volume(d) / std::pow(1.28, 3);
  const int total = static_cast<int>(std::lround(cells));
  const std::vector<int> counts = primary_counts(d, 1.28, total);
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), total);
  for (size_t k = 0; k < d.size(); ++k) {
    EXPECT_GE(counts[k], 1);
    EXPECT_NEAR(counts[k], kPi / 6.0 * std::pow(d[k] / 1.28, 3), 1.5) << d[k];
  }
}

// 20 bodies of a third of a primary and one of two cannot all be kept in 8 primaries.
TEST(PrimaryCounts, TinyBodiesAreLeftOutRatherThanTheLargestSpent) {
  std::vector<double> d(20, 1.28 * std::cbrt(2.0 / kPi));
  d.insert(d.begin(), 1.28 * std::cbrt(12.0 / kPi));
  const std::vector<int> counts = primary_counts(d, 1.28, 8);
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 8);
  EXPECT_GE(*std::min_element(counts.begin(), counts.end()), 1);
}

} // namespace
