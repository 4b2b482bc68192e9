// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/rerun.h"
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using inference::Matrix;
using inference::Vector;

/// n observables, each a block, measured as 0 with a standard deviation of 1.
HeldOut blocks(int n) {
  HeldOut h;
  for (int k = 0; k < n; ++k)
    h.blocks.push_back({"o" + std::to_string(k), "relaxation", "p", {k}});
  h.measured = Vector::Zero(n);
  h.sd = Vector::Ones(n);
  return h;
}

TEST(HeldOutGap, NoiseAndScatterAreTakenOff) {
  // mean square 9, less 1 of the measurement and 0.5 of the packings
  EXPECT_NEAR(gap_of(blocks(2), Vector::Constant(2, 3.0), Vector::Constant(2, 0.5)), std::sqrt(7.5),
              1e-14);
  EXPECT_EQ(gap_of(blocks(2), Vector::Constant(2, 0.9), Vector::Zero(2)), 0.0);
}

TEST(HeldOutGap, ACurveCountsAsMuchAsANumber) {
  HeldOut h = blocks(3);
  h.blocks = {{"curve", "compression", "p", {0, 1}}, {"porosity", "relaxation", "p", {2}}};
  Vector mean(3);
  mean << 5.0, 5.0, 1.0; // squares less noise: 24, 24 | 0
  EXPECT_NEAR(gap_of(h, mean, Vector::Zero(3)), std::sqrt(12.0), 1e-14);
}

TEST(HeldOutGap, SquareErrorOfTheMeanIsThatOfThePackings) {
  Matrix packings(1, 4);
  packings << 9, 11, 9, 11; // variance 4/3, of the mean 1/3
  EXPECT_NEAR(gap_of_packings(blocks(1), packings).value, std::sqrt(100.0 - 1.0 - 1.0 / 3.0),
              1e-13);
}

TEST(HeldOutGap, ShrinkageIsOneLessTheRatioAndNothingWhereThereIsNoGap) {
  const Matrix before = Matrix::Constant(2, 3, 10.0), after = Matrix::Constant(2, 3, 5.0);
  EXPECT_NEAR(shrinkage_of(blocks(2), before, after).value, 1.0 - std::sqrt(24.0 / 99.0), 1e-14);
  EXPECT_EQ(shrinkage_of(blocks(2), before, before).value, 0.0);
  EXPECT_TRUE(std::isnan(shrinkage_of(blocks(2), Matrix::Zero(2, 3), after).value));
}

// A sample of two cells scatters by itself: packings of variance 4/3 add 2/3 to its own 1.
TEST(HeldOutGap, TheSamplesOwnScatterIsNoise) {
  Matrix packings(1, 4);
  packings << 9, 11, 9, 11;
  HeldOut h = blocks(1);
  add_sample_scatter({packings, packings}, 2.0, h);
  EXPECT_NEAR(h.sd[0], std::sqrt(1.0 + 2.0 / 3.0), 1e-14);
  HeldOut large = blocks(1);
  add_sample_scatter({packings}, 1e12, large);
  EXPECT_NEAR(large.sd[0], 1.0, 1e-10);
}

TEST(HeldOutGap, NoiseFloorIsTheRootOfAChiSquaredLessItsMean) {
  // one observable, packings all alike: chi^2(1) is below 3.84 with 95 %; 1000 resamples know that
  // quantile within 0.25 (two standard errors: sqrt(0.95 * 0.05 / 1000) / density 0.0298).
  const double floor = noise_floor(blocks(1), Matrix::Zero(1, 4));
  EXPECT_NEAR(floor * floor, 3.84 - 1.0, 0.47);
}

/// Share of worlds whose 90 % interval holds the true shrinkage; scatter of packings 1.
/// `common`: share of its variance that all observables of a packing have in common.
double coverage(int packings, int worlds, double gap_before, double gap_after, double common) {
  boost::random::mt19937 random(7);
  boost::random::normal_distribution<double> normal;
  const int n = 8;
  int held = 0;
  for (int w = 0; w < worlds; ++w) {
    HeldOut h = blocks(n);
    Matrix before(n, packings), after(n, packings);
    for (int i = 0; i < n; ++i) {
      h.measured[i] = normal(random);
      for (int k = 0; k < packings; ++k) {
        before(i, k) = gap_before + std::sqrt(1.0 - common) * normal(random);
        after(i, k) = gap_after + std::sqrt(1.0 - common) * normal(random);
      }
    }
    for (int k = 0; k < packings; ++k) {
      before.col(k).array() += std::sqrt(common) * normal(random);
      after.col(k).array() += std::sqrt(common) * normal(random);
    }
    const Estimate e = shrinkage_of(h, before, after);
    const double truth = 1.0 - gap_after / gap_before;
    held += e.low90 <= truth && truth <= e.high90;
  }
  return double(held) / worlds;
}

TEST(HeldOutGap, NinetyPercentIntervalsHoldTheTruthAsOftenAsTheDesignAsks) {
  // 80-97 % of the intervals are asked for; 400 worlds know the share within 0.02.
  for (const double after : {3.0, 6.0})
    for (const double common : {0.0, 0.5})
      for (const int packings : {4, 8}) {
        const double share = coverage(packings, 400, 6.0, after, common);
        const std::string world =
            fmt::format("{} packings, {} common, after {}", packings, common, after);
        std::cout << world << ": " << share << "\n";
        EXPECT_GE(share, 0.80) << world;
        EXPECT_LE(share, 0.97) << world;
      }
}

} // namespace
