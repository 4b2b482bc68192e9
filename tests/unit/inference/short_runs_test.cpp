// SPDX-License-Identifier: GPL-2.0-or-later
// A name needs more than that nothing like it was run so far.
#include "diagnose/inference/which.h"
#include "linear_world.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

/// Two effects with a cosine of `cosine`; the second was run up to an amplitude of 40, the first up
/// to `end`. The truth is `amplitude` of the second.
Which found(double cosine, double end, double amplitude, bool instrument = false) {
  LinearWorld world(12, 1, 2, 31);
  world.sensitivity.setZero();
  world.covariance.setIdentity();
  const Vector one = world.signatures.col(0).normalized();
  const Vector off = world.signatures.col(1) - world.signatures.col(1).dot(one) * one;
  world.signatures.col(0) = one;
  world.signatures.col(1) = cosine * one + std::sqrt(1.0 - cosine * cosine) * off.normalized();
  Problem problem = world.problem(world.centre + amplitude * world.signatures.col(1));
  const double ends[] = {end, 40.0};
  for (std::size_t e = 0; e < 2; ++e)
    problem.effects[e].parameters[0].prior = {Prior::uniform, 0.0, ends[e]};
  problem.effects[0].computed = instrument;
  problem.predict = [&world, effects = problem.effects](const Vector &,
                                                        const std::vector<Applied> &on) {
    Prediction out{world.centre, Vector::Zero(world.centre.size())};
    for (const Applied &a : on)
      out.mean += effects[std::size_t(a.effect)].parameters[0].prior.value(a.scores[0]) *
                  world.signatures.col(a.effect);
    return out;
  };
  WhichSettings settings;
  settings.noise = false;
  settings.evidence.samples = 128;
  settings.pairs = 0;
  settings.beside = 0;
  Which w = which(problem, settings);
  EXPECT_EQ(w.claim, "effect 1") << w.why;
  set_short_runs(w, problem);
  decide(w, settings, 2);
  return w;
}

TEST(ShortRuns, AnEffectThatOnlyItsRunsReachIsNotNamed) {
  const Which w = found(0.9, 8.0, 20.0);
  EXPECT_EQ(w.claim, "undecided");
  EXPECT_NE(w.why.find("effect 0, which looks like it (cosine 0.90), reaches 0.4 of this gap"),
            std::string::npos)
      << w.why;
  ASSERT_EQ(w.of("effect 1").short_runs.size(), 1u);
  // the end of the range is that of the last run: 0.9987 of it
  EXPECT_NEAR(w.of("effect 1").short_runs[0].reached, 0.4, 0.01);
}

TEST(ShortRuns, ItIsNamedWhereOthersWereRunAsFarOrLookOtherwiseOrAreInstruments) {
  EXPECT_EQ(found(0.9, 12.0, 20.0).claim, "effect 1");
  EXPECT_EQ(found(0.8, 8.0, 20.0).claim, "effect 1");
  EXPECT_EQ(found(0.9, 8.0, 20.0, true).claim, "effect 1");
}

} // namespace
} // namespace calendem::inference
