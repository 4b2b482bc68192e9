// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/which.h"
#include "linear_world.h"
#include "support/with_all.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

WhichSettings few_samples() {
  WhichSettings s;
  s.noise = false;
  s.evidence.samples = 128;
  return s;
}

std::vector<UnknownPlace> like(const Problem &problem, const Which &w) {
  std::vector<UnknownPlace> out;
  for (const UnknownPlace &p : unknown_places(problem, w, {}, Priors()))
    if (p.name.rfind("like ", 0) == 0)
      out.push_back(p);
  return out;
}

// Expected squared length of the departure is a quarter of the signature's, in the metric in which
// recalibration is free; it has no part in what recalibration can do, and no size to be found.
TEST(UnknownPlaces, WhatActsLikeAnEffectDepartsByHalfItsLength) {
  LinearWorld world(8, 2, 3, 5);
  world.amplitude = 6.0;
  const Problem problem = world.problem(world.mean_of(1));
  const Which w = which(problem, few_samples());
  const Judged &known = w.of("effect 1");
  const Linearised base = linearise(problem, known.evidence.mode.head(2));
  const Cholesky factor(recalibrated_covariance(base));
  const double amplitude = world.amplitude + world.spread * known.evidence.mode[2];
  const double length = factor.matrixL().solve(amplitude * world.signatures.col(1)).squaredNorm();
  bool found = false;
  for (const UnknownPlace &p : like(problem, w)) {
    EXPECT_EQ(p.hypothesis.kind, Hypothesis::unknown);
    EXPECT_EQ(Likelihood(problem, p.hypothesis, p.unknown).dimension(), 3);
    if (p.name != "like effect 1")
      continue;
    found = true;
    EXPECT_NEAR(factor.solve(p.unknown).trace(), 0.25 * length, 1e-9 * length);
    const Matrix seen = world.sensitivity.transpose() * Cholesky(base.covariance).solve(p.unknown);
    EXPECT_LT(seen.norm(), 1e-6 * p.unknown.norm());
  }
  EXPECT_TRUE(found);
}

// All shares of the prior that are computed, those of effects too far behind missing.
TEST(UnknownPlaces, SharesSumToAtMostOne) {
  LinearWorld world(8, 2, 4, 6);
  world.amplitude = 1.0;
  const Problem problem = world.problem(world.centre);
  const Which w = which(problem, few_samples());
  double sum = 0.0, alike = 0.0;
  for (const UnknownPlace &p : unknown_places(problem, w, {0, 1, 2, 3}, Priors()))
    sum += p.share;
  for (const UnknownPlace &p : like(problem, w))
    alike += p.share;
  // Pairs too far behind have at most a tenth of 0.48.
  EXPECT_LE(sum, 1.0 + 1e-12);
  EXPECT_GT(sum, 1.0 - 0.048 - 1e-12);
  EXPECT_LE(alike, 0.48 + 1e-12);
  double places = 0.0;
  for (const auto &[place, share] : w.of("unknown").of_place)
    places += share;
  EXPECT_NEAR(places, 1.0, 1e-12);
}

// In as many worlds each, an effect that departs from the known one by half of its length, at right
// angles to what is known, is rarely called it; its exact copy is.
TEST(UnknownPlaces, WhatOnlyActsLikeAnEffectIsRarelyNamed) {
  int called = 0, named = 0;
  const int worlds = calendem_test::with_all(60, 20);
  for (int k = 0; k < worlds; ++k) {
    LinearWorld world(12, 2, 3, std::uint64_t(700 + k));
    world.amplitude = 8.0;
    const Problem exact = world.problem(world.mean_of(0));
    named += which(exact, few_samples()).claim == "effect 0";
    Random random(std::uint64_t(k), 10);
    Vector off(12);
    for (double &v : off)
      v = random.normal();
    const Cholesky factor(world.covariance);
    const auto white = [&](const Vector &v) { return Vector(factor.matrixL().solve(v)); };
    for (const Vector &known : {Vector(world.sensitivity.col(0)), Vector(world.sensitivity.col(1)),
                                Vector(world.signatures.col(0))})
      off -= white(off).dot(white(known)) / white(known).squaredNorm() * known;
    off *= 0.5 * world.amplitude / white(off).norm();
    const Vector mean = world.mean_of(0) + off;
    called +=
        which(world.problem(world.draw(mean, world.covariance, random)), few_samples()).claim ==
        "effect 0";
  }
  EXPECT_EQ(named, worlds);
  EXPECT_LE(called, 0.1 * worlds + 3.0 * std::sqrt(0.1 * 0.9 * worlds)); // gate: a tenth
  RecordProperty("called", called);
}

} // namespace
} // namespace calendem::inference
