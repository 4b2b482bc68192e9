// SPDX-License-Identifier: GPL-2.0-or-later
// Intervals over all hypotheses hold as often as they say, whatever the answer is.
#include "diagnose/inference/averaged.h"
#include "diagnose/inference/base_beside_unknown.h"
#include "diagnose/inference/hypothesis.h"
#include "linear_world.h"
#include "support/with_all.h"
#include <gtest/gtest.h>
#include <set>

namespace calendem::inference {
namespace {

const Prior kScores{Prior::normal, 0.0, 1.0}; // values are the scores
const std::vector<Parameter> kBase{{"one", kScores, false}, {"two", kScores, false}};

bool holds(double low, double high, double truth) { return low <= truth && truth <= high; }

/// Share of the 90 % intervals that hold, of both base parameters.
struct Coverage {
  int worlds = 0, over_all = 0, of_the_best = 0;

  void add(const Which &found, const Vector &truth) {
    const std::vector<ParameterRange> ranges = parameter_ranges(kBase, found);
    const Evidence &best = found.judged.front().evidence;
    ++worlds;
    for (int j = 0; j < 2; ++j) {
      const double half = 1.6448536 * std::sqrt(best.covariance(j, j));
      over_all +=
          holds(ranges[std::size_t(j)].all.low90, ranges[std::size_t(j)].all.high90, truth[j]);
      of_the_best += holds(best.mean[j] - half, best.mean[j] + half, truth[j]);
    }
  }
  double share(int held) const { return held / (2.0 * worlds); }
  /// Three standard deviations if both intervals of a world were one.
  double tolerance() const { return 3.0 * std::sqrt(0.09 / worlds); }
};

// None and three effects, one of which does what the first base parameter does: what the data leave
// undecided is open in the parameters, too.
TEST(Averaged, IntervalsHoldWhereTheAnswerIsUndecided) {
  WhichSettings settings = quick();
  settings.priors.unknown = 0.0;
  settings.priors.none = 0.25;
  Coverage undecided;
  const int worlds = calendem_test::with_all(400, 200);
  for (int w = 0; w < worlds; ++w) {
    LinearWorld world(6, 2, 3, std::uint64_t(2500 + w));
    world.amplitude = 2.5;
    world.signatures.col(0) = 0.9 * world.sensitivity.col(0) + 0.3 * world.signatures.col(0);
    Random random(std::uint64_t(w), 18);
    const int truth = int(random.uniform() * 4) - 1;
    Vector scores(3);
    for (double &s : scores)
      s = random.normal();
    Vector mean = world.centre + world.sensitivity * scores.head(2);
    if (truth >= 0)
      mean += (world.amplitude + world.spread * scores[2]) * world.signatures.col(truth);
    const Which found = which(world.problem(world.draw(mean, world.covariance, random)), settings);
    if (found.claim == "undecided")
      undecided.add(found, scores);
  }
  ASSERT_GT(undecided.worlds, worlds / 4);
  EXPECT_NEAR(undecided.share(undecided.over_all), 0.9, undecided.tolerance());
  EXPECT_LT(undecided.share(undecided.of_the_best), 0.9 - undecided.tolerance());
}

/// The features in which an unknown drawn from its prior acts: none in a quarter of the worlds, all
/// in half of the others, else those of one stage (2 of 22 places) or one feature.
Vector drawn_places(int features, Random &random) {
  if (random.uniform() < 0.25)
    return Vector::Zero(features);
  if (random.uniform() < 0.5)
    return Vector::Ones(features);
  const int place = int(random.uniform() * (2 + 2 * features));
  Vector mask = Vector::Zero(features);
  for (int f = 0; f < features; ++f)
    mask[f] = place < 2 ? f % 2 == place : f == (place - 2) / 2;
  return mask;
}

// The unknown moves what the base parameters move, too.
TEST(Averaged, IntervalsHoldBesideSomethingUnknown) {
  WhichSettings settings = quick();
  settings.priors.unknown = 1.0;
  settings.priors.none = 0.0;
  Coverage c;
  const int worlds = calendem_test::with_all(200, 100);
  for (int w = 0; w < worlds; ++w) {
    const LinearWorld world(10, 2, 0, std::uint64_t(3000 + w));
    Random random(std::uint64_t(w), 19);
    Vector scores(2);
    for (double &s : scores)
      s = random.normal();
    const double size = kUnknownSize.value(random.normal());
    const Vector sd = world.covariance.diagonal().cwiseSqrt();
    Vector mean = world.centre + world.sensitivity * scores;
    const Vector mask = drawn_places(10, random);
    for (Eigen::Index f = 0; f < mask.size(); ++f)
      mean[f] += mask[f] * size * sd[f] * random.normal();
    c.add(which(world.problem(world.draw(mean, world.covariance, random)), settings), scores);
  }
  EXPECT_NEAR(c.share(c.over_all), 0.9, c.tolerance());
  EXPECT_LT(c.share(c.of_the_best), 0.9 - c.tolerance());
}

// n features that all move by the parameter, errors of 1, and an offset of size s common to all:
// the parameter is known to 1 / (1 + n / (1 + s^2 n)), not to 1 / (1 + n).
TEST(Averaged, WhatTheUnknownMayDoInAParametersPlaceIsNotKnown) {
  constexpr int kFeatures = 4, kDraws = 20000;
  constexpr double kSize = 3.0;
  LinearWorld world(kFeatures, 1, 1, 1);
  world.covariance.setIdentity();
  world.sensitivity.setOnes();
  const Vector data = world.centre + Vector::Constant(kFeatures, 5.0);
  const Problem problem = world.problem(data);
  Judged unknown;
  unknown.hypothesis = {Hypothesis::unknown, {}, "unknown", 0.0};
  unknown.evidence.draws = Matrix::Constant(2, kDraws, kUnknownSize.score(kSize));
  unknown.evidence.mode = Vector::Zero(2);
  Random random(3, 3);
  const Matrix draws =
      base_beside_unknown(problem, unknown, Matrix::Ones(kFeatures, kFeatures), kDraws, random);
  const double weight = kFeatures / (1.0 + kSize * kSize * kFeatures);
  const double mean = draws.row(0).mean(), variance = 1.0 / (1.0 + weight);
  EXPECT_NEAR(mean, 5.0 * weight * variance, 3.0 * std::sqrt(variance / kDraws));
  EXPECT_NEAR((draws.row(0).array() - mean).square().mean(), variance,
              3.0 * variance * std::sqrt(2.0 / kDraws));
}

// Features that bend with the parameter, and emulators that err more the farther it is from zero: moments by
// the sum over a grid. The effect beside moves them, too, and its emulator errs by as much as it acts.
TEST(Averaged, BesideTheUnknownParametersBendAndEffectsErr) {
  constexpr int kFeatures = 3, kDraws = 20000;
  LinearWorld world(kFeatures, 1, 1, 5);
  world.covariance = 0.09 * Matrix::Identity(kFeatures, kFeatures);
  world.sensitivity << 1.0, 0.6, -0.4;
  world.signatures.setConstant(0.2);
  const Vector centre = world.centre, bend = Eigen::Vector3d(0.5, -0.3, 0.2);
  Problem problem = world.problem(centre + Eigen::Vector3d(2.2, 0.8, -0.6));
  problem.predict = [&](const Vector &base, const std::vector<Applied> &on) {
    Prediction p{centre + world.sensitivity * base + bend * base[0] * base[0],
                 Vector::Constant(kFeatures, 0.02 * base[0] * base[0])};
    for (const Applied &a : on) {
      p.mean += (world.amplitude + a.scores[0]) * world.signatures.col(a.effect);
      p.variance.array() += 0.04;
    }
    return p;
  };
  Judged unknown;
  unknown.hypothesis = {Hypothesis::unknown, {0}, "unknown", 0.0};
  unknown.hypothesis.size = 1.0;
  unknown.evidence.mode = Vector::Zero(2);
  Random random(3, 3);
  unknown.evidence.draws = Matrix::Zero(2, 10);
  const Matrix anywhere = 0.25 * Matrix::Ones(kFeatures, kFeatures);
  const Matrix draws = base_beside_unknown(problem, unknown, anywhere, kDraws, random);
  double sum = 0.0, first = 0.0, second = 0.0;
  for (double s = -6.0; s <= 6.0; s += 0.002) {
    const Prediction p = problem.predict(Vector::Constant(1, s), {{0, Vector::Zero(1)}});
    const Cholesky factor(covariance_about(problem, p) + anywhere);
    const double square = factor.matrixL().solve(problem.observed - p.mean).squaredNorm();
    const double weight =
        std::exp(-0.5 * (square + s * s)) / Matrix(factor.matrixL()).determinant();
    sum += weight;
    first += weight * s;
    second += weight * s * s;
  }
  const double mean = first / sum, variance = second / sum - mean * mean;
  EXPECT_NEAR(draws.row(0).mean(), mean, 3.0 * std::sqrt(variance / kDraws));
  EXPECT_NEAR((draws.row(0).array() - mean).square().mean(), variance,
              3.0 * variance * std::sqrt(2.0 / kDraws));
}

TEST(Averaged, DrawsAreTakenFromAllOfThem) {
  const Matrix all = Vector::LinSpaced(10, 0.0, 9.0).transpose();
  Random random(1, 2);
  EXPECT_EQ(spread_over(all, 10, random), all);
  std::set<double> firsts;
  for (int k = 0; k < 200; ++k) { // any of five is missed once in 10^19
    const Matrix two = spread_over(all, 2, random);
    EXPECT_EQ(two(0, 1) - two(0, 0), 5.0);
    firsts.insert(two(0, 0));
  }
  EXPECT_EQ(firsts.size(), 5u);
}

} // namespace
} // namespace calendem::inference
