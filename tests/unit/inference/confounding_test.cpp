// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/confounding.h"
#include "diagnose/inference/which.h"
#include "linear_world.h"
#include "physics/pi.h"
#include <boost/math/tools/minima.hpp>
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

/// Signatures in white noise, linear in amplitudes with these priors; without base parameters.
/// The world is referred to.
Problem linear_problem(LinearWorld &world, const std::vector<Prior> &priors) {
  world.centre.setZero();
  world.covariance.setIdentity();
  Problem problem = world.problem(Vector::Zero(world.centre.size()));
  for (std::size_t e = 0; e < priors.size(); ++e)
    problem.effects[e].parameters[0].prior = priors[e];
  problem.predict = [&world, priors](const Vector &, const std::vector<Applied> &on) {
    const auto n = world.centre.size();
    Prediction out{Vector::Zero(n), Vector::Zero(n)};
    for (const Applied &a : on)
      out.mean += priors[std::size_t(a.effect)].value(a.scores[0]) * world.signatures.col(a.effect);
    return out;
  };
  return problem;
}

// Signatures with a known angle in white noise, without base parameters.
TEST(Confounding, CosinesOddsAndLimitsInClosedForm) {
  LinearWorld world(3, 0, 2, 1);
  world.signatures << 1.0, 0.6, 0.0, 0.8, 0.0, 0.0;
  const Prior any{Prior::uniform, 0.0, 10.0};
  Problem problem = linear_problem(world, {any, any});
  Which w;
  w.base = linearise(problem, Vector());
  ConfoundingSettings settings;
  settings.amplitudes = 100;
  const Confounding c = confounding(problem, w, settings);
  EXPECT_NEAR(c.cosine(0, 1), 0.6, 1e-9);
  EXPECT_NEAR(c.log_odds(0, 2), 0.5 * 25.0, 1e-6);
  EXPECT_NEAR(c.log_odds(0, 1), 0.5 * 25.0 * 0.64, 1e-6); // rival at 3: on the grid
  // sin^2 a^2 / 2 = 3; the rival's grid of 0.1 costs less than 0.05^2 / 2.
  EXPECT_NEAR(c.limits[0].amplitude, std::sqrt(6.0 / 0.64), 0.02);
  EXPECT_EQ(c.limits[0].rival, "effect 1");
  EXPECT_NEAR(c.limits[0].against_none, std::sqrt(6.0), 0.02);
  // Alone: a^2 / 2 = 3 + ln(10 / sqrt(2 pi)), the width of its prior over the data's of 1.
  problem.effects.resize(1);
  const Confounding alone = confounding(problem, w, settings);
  EXPECT_NEAR(alone.limits[0].amplitude,
              std::sqrt(6.0 + 2.0 * std::log(10.0 / std::sqrt(2.0 * kPi))), 0.02);
  EXPECT_EQ(alone.limits[0].rival, "none");
  EXPECT_NEAR(alone.limits[0].against_none, std::sqrt(6.0), 0.02);
}

// An effect that may have either sign imitates one of the opposite signature.
TEST(Confounding, ARivalMayHaveTheOtherSign) {
  LinearWorld world(2, 0, 2, 1);
  world.signatures << 1.0, -1.0, 0.0, 0.0;
  const Problem problem =
      linear_problem(world, {{Prior::uniform, 0.0, 10.0}, {Prior::uniform, -10.0, 10.0}});
  Which w;
  w.base = linearise(problem, Vector());
  const Confounding c = confounding(problem, w, {});
  EXPECT_NEAR(c.log_odds(0, 1), 0.0, 0.5 * std::pow(0.5 * 10.0 / 24.0, 2)); // half a step away
  EXPECT_NEAR(c.log_odds(0, 2), 12.5, 1e-6);
}

// Below zero the second effect hides behind the first, above it nothing does: what counts is the
// farther limit, sin^2 a^2 / 2 = 3.
TEST(Confounding, ALimitHoldsOnBothSidesOfZero) {
  LinearWorld world(2, 0, 2, 1);
  world.signatures << -0.8, 1.0, 0.6, 0.0;
  const Problem problem =
      linear_problem(world, {{Prior::uniform, 0.0, 10.0}, {Prior::uniform, -10.0, 10.0}});
  Which w;
  w.base = linearise(problem, Vector());
  ConfoundingSettings settings;
  settings.amplitudes = 100;
  const Confounding c = confounding(problem, w, settings);
  EXPECT_NEAR(c.limits[1].amplitude, std::sqrt(6.0 / 0.36), 0.02);
  EXPECT_EQ(c.limits[1].rival, "effect 0");
  EXPECT_NEAR(c.limits[1].against_none, std::sqrt(6.0), 0.02);
}

// One feature of variance 1, r (e^b - 1) of the base parameter b, and an amplitude of 0 to 10
// added: the base model follows further than its tangent r b at 0. The least of (a - r (e^b - 1))^2
// + b^2 is 6 at the limit a.
TEST(Confounding, LimitsAllowForWhatRecalibrationCanReallyReach) {
  const double r = 0.5;
  LinearWorld world(1, 1, 1, 1);
  world.covariance.setIdentity();
  Problem problem = world.problem(Vector::Zero(1));
  problem.effects[0].parameters[0].prior = {Prior::uniform, 0.0, 10.0};
  problem.predict = [&](const Vector &base, const std::vector<Applied> &on) {
    Prediction out{Vector::Constant(1, r * std::expm1(base[0])), Vector::Zero(1)};
    for (const Applied &a : on)
      out.mean[0] += problem.effects[0].parameters[0].prior.value(a.scores[0]);
    return out;
  };
  Which w;
  w.base = linearise(problem, Vector::Zero(1));
  ConfoundingSettings settings;
  settings.amplitudes = 400; // steps of 0.025
  const auto least = [&](double a) {
    const auto square = [&](double b) { return std::pow(a - r * std::expm1(b), 2) + b * b; };
    return boost::math::tools::brent_find_minima(square, 0.0, 5.0, 40).second;
  };
  double low = 0.0, high = 10.0;
  while (high - low > 1e-9)
    (least(0.5 * (low + high)) < 6.0 ? low : high) = 0.5 * (low + high);
  EXPECT_GT(low, 1.2 * std::sqrt(6.0 * (1.0 + r * r))); // the tangent's
  EXPECT_NEAR(confounding(problem, w, settings).limits[0].against_none, low, 0.025);
}

// A base parameter that moves the features as the effect does takes it up, as far as its prior lets
// it.
TEST(Confounding, RecalibrationAbsorbs) {
  LinearWorld world(2, 1, 1, 1);
  world.centre.setZero();
  world.covariance.setIdentity();
  world.sensitivity << 2.0, 0.0;
  world.signatures << 1.0, 0.0;
  const Problem problem = world.problem(Vector::Zero(2));
  Which w;
  w.base = linearise(problem, Vector::Zero(1));
  // 1/(1 + 4) of the squared length is left.
  EXPECT_NEAR(confounding(problem, w, {}).absorbed[0], 0.8, 1e-9);
  EXPECT_NEAR(beyond_recalibration(w.base, Matrix::Identity(2, 2))(0, 0), 0.0, 1e-8);
  EXPECT_NEAR(beyond_recalibration(w.base, Matrix::Identity(2, 2))(1, 1), 1.0, 1e-8);
}

} // namespace
} // namespace calendem::inference
