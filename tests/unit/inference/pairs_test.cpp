// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "diagnose/inference/pairs.h"
#include "diagnose/inference/scatter.h"
#include "linear_world.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

// The base model's scores are far from 0 and recalibration takes up much of the effects. Where ln of
// the likelihood has the slope g along an amplitude of spread s, a grid with the mean m and the
// variance v of the scores is off by m g s + (v - 1) (g s)^2 / 2, and by less of higher order.
TEST(Pairs, TheEstimateIsTheEvidenceInALinearWorld) {
  LinearWorld world(6, 3, 4, 41);
  world.amplitude = 3.0;
  world.spread = 0.1;
  const Vector data = world.mean_of(0) + world.mean_of(3) - world.centre +
                      world.sensitivity * Vector{{2.0, -1.5, 1.0}};
  const Problem problem = world.problem(data);
  const std::vector<Promise> all = promising_pairs(problem, which(problem, quick()));
  ASSERT_EQ(all.size(), 6u);
  const Vector grid = sobol_normals(1, 16, 0).transpose();
  const double m = grid.mean(), v = grid.squaredNorm() / 16.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const int a = all[k].pair.on[0], b = all[k].pair.on[1];
    EXPECT_LT(a, b);
    if (k > 0) {
      EXPECT_LE(all[k].log_evidence, all[k - 1].log_evidence);
    }
    const Matrix &s = world.signatures;
    const Matrix covariance = world.covariance_of(a) + 0.01 * s.col(b) * s.col(b).transpose();
    const Cholesky factor(covariance);
    const Matrix lower = factor.matrixL();
    const Vector apart = data - world.mean_of(a) - world.mean_of(b) + world.centre;
    const double exact = log_student_t(factor.matrixL().solve(apart).squaredNorm(),
                                       2.0 * lower.diagonal().array().log().sum(), 6, kNormal);
    double off = 0.01;
    for (const int effect : all[k].pair.on) {
      const double slope = world.spread * std::fabs(s.col(effect).dot(factor.solve(apart)));
      off += std::fabs(m) * slope + 0.5 * std::fabs(v - 1.0) * slope * slope;
    }
    EXPECT_NEAR(all[k].log_evidence, exact, off) << all[k].pair.name;
    EXPECT_LT(off, 0.15);
  }
}

// Each of two decoys fits the sum of two effects better than either of them alone; only both
// together fit it.
TEST(Pairs, OneIsFoundAlthoughNeitherOfItsEffectsFitsBest) {
  LinearWorld world(12, 2, 6, 14);
  world.amplitude = 9.0;
  Matrix axes = Matrix::Zero(12, 6);
  axes.leftCols(2).setIdentity();
  for (int decoy = 2; decoy < 4; ++decoy) {
    axes.col(decoy).head(2).setConstant(std::sqrt(0.4));
    axes(decoy, decoy) = std::sqrt(0.2);
  }
  axes.bottomRightCorner(2, 2).setIdentity();
  world.signatures = Cholesky(world.covariance).matrixL() * axes;
  const Vector data = world.mean_of(0) + world.mean_of(1) - world.centre;
  WhichSettings settings = quick();
  settings.pairs = 2;
  settings.priors.pair_share = 0.2;
  const Which found = which(world.problem(data), settings);
  for (const char *half : {"effect 0", "effect 1"})
    for (const char *decoy : {"effect 2", "effect 3"})
      EXPECT_GT(found.of(decoy).evidence.log_evidence, found.of(half).evidence.log_evidence);
  EXPECT_EQ(found.claim, "effect 0 + effect 1");
  EXPECT_THROW(found.of("effect 4 + effect 5"), Failure); // not worth an integral
}

// A decoy fits best alone. The claim is an effect that acts with one of two alike ones: all its
// pairs are computed, although two were asked for.
TEST(Pairs, AllOfTheClaimedEffectAreComputed) {
  LinearWorld world(12, 2, 6, 15);
  world.amplitude = 9.0;
  Matrix axes = Matrix::Zero(12, 6);
  axes(0, 0) = 1.0;
  for (int alike = 1; alike < 3; ++alike) {
    axes(1, alike) = std::sqrt(0.99);
    axes(2, alike) = alike == 1 ? 0.1 : -0.1;
  }
  axes(0, 3) = axes(1, 3) = std::sqrt(0.4);
  axes(3, 3) = std::sqrt(0.2);
  axes(4, 4) = axes(5, 5) = 1.0;
  const Cholesky factor(world.covariance);
  world.signatures = factor.matrixL() * axes;
  Vector both = Vector::Zero(12);
  both.head(2).setConstant(9.0);
  const Problem problem = world.problem(world.centre + factor.matrixL() * both);
  WhichSettings settings = quick();
  settings.pairs = 2;
  settings.priors.pair_share = 0.5;
  const Which found = which(problem, settings);
  EXPECT_GT(found.of("effect 3").evidence.log_evidence, found.of("effect 0").evidence.log_evidence);
  ASSERT_EQ(found.claim, "effect 0") << found.why;
  EXPECT_LT(found.of("effect 0 + effect 4").probability, 0.01);
  ASSERT_EQ(found.beside.size(), 2u);
  EXPECT_EQ(found.beside[0].prior, found.beside[1].prior);
  // six single effects and fifteen pairs share the rest in halves; five pairs have the effect
  EXPECT_NEAR(found.beside[0].prior, (0.5 / 15.0) / (0.5 / 6.0 + 5.0 * 0.5 / 15.0), 1e-12);
  double places = 0.0;
  int unknown = 0;
  for (const Judged &j : found.judged)
    unknown += j.hypothesis.kind == Hypothesis::unknown;
  for (const auto &[place, share] : found.of("unknown").of_place)
    places += share;
  EXPECT_EQ(unknown, 1);
  EXPECT_NEAR(places, 1.0, 1e-12);
}

} // namespace
} // namespace calendem::inference
