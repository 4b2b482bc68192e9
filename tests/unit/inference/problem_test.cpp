// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/problem.h"
#include "linear_world.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

// A linear world of one base parameter with a t distribution: means of n draws scatter by sd /
// sqrt(n), covariances about by sqrt((2 + excess) / n), excess 6 / (nu - 4) the t distribution's;
// both to four of these.
TEST(Problem, DrawnFeaturesHaveThePredictionsMeanAndCovariance) {
  const LinearWorld world(3, 1, 2, 5);
  Problem problem = world.problem(Vector::Zero(3));
  problem.degrees_of_freedom = 12.0;
  constexpr int n = 20000;
  const Vector base = Vector::Constant(1, 0.7);
  const std::vector<Applied> on = {{1, Vector::Constant(1, -0.4)}};
  const Vector expected = problem.predict(base, on).mean;
  Random random(3, 8);
  Matrix off(3, n);
  for (int k = 0; k < n; ++k)
    off.col(k) = drawn(problem, base, on, random) - expected;
  // Whitened: covariance nu / (nu - 2) I.
  off = Cholesky(world.covariance).matrixL().solve(off).eval();
  const double variance = 12.0 / 10.0, excess = 6.0 / 8.0;
  EXPECT_LT(off.rowwise().mean().cwiseAbs().maxCoeff(), 4.0 * std::sqrt(variance / n));
  const Matrix covariance = off * off.transpose() / n;
  EXPECT_LT((covariance - variance * Matrix::Identity(3, 3)).cwiseAbs().maxCoeff(),
            4.0 * variance * std::sqrt((2.0 + excess) / n));
}

TEST(Problem, WithoutAnEffectTheOthersKeepTheirPredictions) {
  const LinearWorld world(3, 1, 3, 5);
  const Problem all = world.problem(Vector::Zero(3));
  const Problem less = without_effect(all, 1);
  ASSERT_EQ(less.effects.size(), 2u);
  EXPECT_EQ(less.effects[0].name, "effect 0");
  EXPECT_EQ(less.effects[1].name, "effect 2");
  const Vector base = Vector::Constant(1, 0.3), at = Vector::Constant(1, 1.5);
  EXPECT_EQ(less.predict(base, {{0, at}}).mean, all.predict(base, {{0, at}}).mean);
  EXPECT_EQ(less.predict(base, {{1, at}}).mean, all.predict(base, {{2, at}}).mean);
}

} // namespace
} // namespace calendem::inference
