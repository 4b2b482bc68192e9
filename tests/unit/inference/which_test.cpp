// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/which.h"
#include "linear_world.h"
#include "support/with_all.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

/// Probabilities of none and three effects, by importance sampling, in worlds drawn from the prior.
struct ClaimCounts {
  int worlds = 0, claims = 0, wrong = 0, covered = 0, intervals = 0, inadequate = 0;
  double expected_right = 0.0, variance = 0.0;
  int right = 0;
};

ClaimCounts calibrate(int worlds) {
  ClaimCounts c;
  WhichSettings settings = quick();
  settings.priors.unknown = 0.0;
  settings.priors.none = 0.25;
  for (int w = 0; w < worlds; ++w) {
    LinearWorld world(6, 2, 3, std::uint64_t(500 + w));
    world.amplitude = 2.5;
    Random random(std::uint64_t(w), 8);
    const int truth = int(random.uniform() * 4) - 1;
    Vector scores(3);
    for (double &s : scores)
      s = random.normal();
    Vector mean = world.centre + world.sensitivity * scores.head(2);
    if (truth >= 0)
      mean += (world.amplitude + world.spread * scores[2]) * world.signatures.col(truth);
    const Which found = which(world.problem(world.draw(mean, world.covariance, random)), settings);
    const std::string name = truth < 0 ? "none" : "effect " + std::to_string(truth);
    const Judged &best = found.judged.front(), &own = found.of(name);
    c.right += best.hypothesis.name == name;
    c.expected_right += best.probability;
    c.variance += best.probability * (1.0 - best.probability);
    c.claims += found.claim != "undecided" && found.claim != "unknown";
    c.wrong += found.claim != "undecided" && found.claim != "unknown" && found.claim != name;
    c.inadequate += own.adequacy_p < 0.1;
    for (int j = 0; j < own.evidence.mean.size(); ++j, ++c.intervals)
      c.covered += std::fabs(scores[j] - own.evidence.mean[j]) <
                   1.6448536 * std::sqrt(own.evidence.covariance(j, j));
  }
  c.worlds = worlds;
  return c;
}

// Truths drawn from the prior: probabilities are frequencies, 90 % intervals cover 90 %, adequacy
// is uniform. All within three standard deviations of binomial counts (intervals of one world are
// correlated: at most as if they were equal).
TEST(Which, IsCalibratedInLinearWorlds) {
  const ClaimCounts c = calibrate(calendem_test::with_all(300, 100));
  EXPECT_NEAR(c.right, c.expected_right, 3.0 * std::sqrt(c.variance));
  EXPECT_NEAR(c.covered / double(c.intervals), 0.9, 3.0 * std::sqrt(0.09 / c.worlds));
  EXPECT_NEAR(c.inadequate / double(c.worlds), 0.1, 3.0 * std::sqrt(0.09 / c.worlds));
  EXPECT_GT(c.claims, c.worlds / 30);
  EXPECT_LE(c.wrong, 0.2 * c.claims + 3.0 * std::sqrt(0.16 * c.claims)); // a claim is 80 % sure
  RecordProperty("claims", c.claims);
  RecordProperty("wrong", c.wrong);
}

// Truths are none, an unknown that no data show, or one that sits anywhere, in the shares of their
// priors where nothing known is in the table: what is too small to be seen is not called none more
// surely than it is none.
TEST(Which, TheUnknownIsCalibratedWhereMuchOfItIsTooSmallToBeSeen) {
  WhichSettings settings = quick();
  settings.priors.none = 0.5;
  settings.priors.unknown = 0.5;
  double expected = 0.0, variance = 0.0;
  int unknown = 0;
  const int worlds = calendem_test::with_all(300, 200);
  for (int w = 0; w < worlds; ++w) {
    const LinearWorld world(8, 2, 0, std::uint64_t(4100 + w));
    Random random(std::uint64_t(w), 28);
    Vector mean = world.draw(
        world.centre,
        Matrix(world.sensitivity * world.sensitivity.transpose() + 1e-9 * world.covariance),
        random);
    const bool acts = random.uniform() < 0.5;
    const double of_place = random.uniform(), size = kUnknownSize.value(random.normal());
    if (acts && of_place > 0.4) {
      const int only = of_place > 0.7 ? -1 : int(random.uniform() * 8);
      for (Eigen::Index f = 0; f < 8; ++f)
        mean[f] += only < 0 || only == f
                       ? size * std::sqrt(world.covariance(f, f)) * random.normal()
                       : 0.0;
    }
    unknown += acts;
    const Which found = which(world.problem(world.draw(mean, world.covariance, random)), settings);
    const double p = found.of("unknown").probability;
    expected += p;
    variance += p * (1.0 - p);
  }
  EXPECT_NEAR(unknown, expected, 3.0 * std::sqrt(variance));
  RecordProperty("expected", std::to_string(expected));
}

TEST(Which, NullsAreRarelyCalledAnEffect) {
  WhichSettings settings = quick();
  const int worlds = calendem_test::with_all(300, 100);
  int effects = 0, none = 0, unknown = 0;
  for (int w = 0; w < worlds; ++w) {
    const LinearWorld world(8, 2, 4, std::uint64_t(900 + w));
    Random random(std::uint64_t(w), 9);
    const Which found =
        which(world.problem(world.draw(world.centre, world.covariance_of(-1), random)), settings);
    none += found.claim == "none";
    unknown += found.claim == "unknown";
    effects += found.claim.rfind("effect", 0) == 0;
  }
  EXPECT_LE(effects, 0.03 * worlds + 3.0 * std::sqrt(0.03 * 0.97 * worlds)); // gate: 3 %
  EXPECT_LE(unknown, 0.03 * worlds + 3.0 * std::sqrt(0.03 * 0.97 * worlds));
  EXPECT_GE(none, 0.5 * worlds);
}

TEST(Which, AStrongEffectIsNamedAndWithoutItsHypothesisItIsUnknown) {
  LinearWorld world(10, 2, 3, 11);
  world.amplitude = 10.0;
  const Vector data = world.mean_of(1);
  const Which found = which(world.problem(data), quick());
  EXPECT_EQ(found.claim, "effect 1");
  EXPECT_EQ(found.set95, std::vector<std::string>{"effect 1"});
  EXPECT_GT(found.inclusion.at("effect 1"), 0.98); // a hundredth is left for what nothing predicts
  for (const Sensitivity &s : found.sensitivity)
    EXPECT_EQ(s.claim, "effect 1") << s.change;
  Problem without = world.problem(data);
  without.effects.resize(1);
  EXPECT_EQ(which(without, quick()).claim, "unknown");
}

// An effect that does nothing but make its emulators uncertain, by 2 per unit of score: without the
// determinant its amplitude grows until the data are within the errors. The least of
// 40.5 / v + 8 ln v + (v - 1) / 4 is at 0.25 v^2 + 8 v = 40.5.
TEST(Which, AdequacyCountsWhatUncertainEmulatorsCost) {
  LinearWorld world(8, 1, 1, 21);
  world.covariance.setIdentity();
  world.signatures.setZero();
  world.sensitivity.setZero();
  Vector data = world.centre;
  data[6] += 4.5;
  data[7] -= 4.5;
  Problem problem = world.problem(data);
  problem.predict = [certain = problem.predict](const Vector &base,
                                                const std::vector<Applied> &on) {
    Prediction p = certain(base, on);
    for (const Applied &a : on)
      p.variance.setConstant(4.0 * a.scores[0] * a.scores[0]);
    return p;
  };
  const Which found = which(problem, quick());
  const double v = (std::sqrt(64.0 + 40.5) - 8.0) / 0.5;
  EXPECT_NEAR(found.of("none").adequacy_p, chance_beyond(40.5, 8, kNormal), 1e-9);
  EXPECT_NEAR(found.of("effect 0").adequacy_p,
              chance_beyond(40.5 / v + (v - 1.0) / 4.0, 8, kNormal), 1e-3);
}

// Part of what is unknown may look like a known effect: without the rest it would be named.
TEST(Which, AnUnknownBesideAKnownEffectIsUnknown) {
  LinearWorld world(12, 2, 3, 13);
  world.amplitude = 10.0;
  Problem problem = world.problem(world.mean_of(1) + world.mean_of(2) - world.centre);
  problem.effects.resize(2);
  WhichSettings settings = quick();
  settings.beside = 2;
  const Which found = which(problem, settings);
  EXPECT_EQ(found.claim, "unknown");
  EXPECT_GT(found.of("unknown").probability, 0.95);
  EXPECT_EQ(found.of("unknown").place, "beside effect 1");
  EXPECT_LT(found.inclusion.at("effect 1"), 0.05);
}

TEST(Which, TwoEffectsAtOnceAreAPair) {
  LinearWorld world(12, 2, 4, 12);
  world.amplitude = 9.0;
  const Vector data = world.mean_of(0) + world.mean_of(2) - world.centre;
  WhichSettings settings = quick();
  settings.pairs = 2;
  settings.priors.pair_share = 0.2;
  const Which found = which(world.problem(data), settings);
  EXPECT_EQ(found.claim, "effect 0 + effect 2");
  EXPECT_GT(found.inclusion.at("effect 2"), 0.98); // a hundredth is left for what nothing predicts
}

TEST(Which, UnderstatedNoise) {
  const LinearWorld world(20, 1, 2, 13);
  Random random(2, 2);
  const Vector data = world.draw(world.centre, 12.0 * world.covariance, random);
  WhichSettings settings = quick();
  settings.noise = true;
  settings.priors.unknown = 0.0;
  EXPECT_EQ(which(world.problem(data), settings).claim, "noise");
}

// The rule on given evidence.
TEST(Decide, ClaimRuleAndPriors) {
  const auto judged = [](Hypothesis::Kind kind, std::vector<int> on, const char *name,
                         double log_evidence, double p) {
    Judged j;
    j.hypothesis = {kind, std::move(on), name, 0.0};
    j.evidence.log_evidence = log_evidence;
    j.adequacy_p = p;
    return j;
  };
  const auto decided = [&](double log_a, double p_a, double p_none, const WhichSettings &settings,
                           double samples = 200.0) {
    Which w;
    w.judged = {judged(Hypothesis::none, {}, "none", 0.0, p_none),
                judged(Hypothesis::unknown, {}, "unknown", -20.0, 1.0),
                judged(Hypothesis::effects, {0}, "a", log_a, p_a),
                judged(Hypothesis::effects, {1}, "b", -20.0, p_a)};
    for (Judged &j : w.judged) {
      j.evidence.samples = 1024;
      j.evidence.effective_samples = samples;
    }
    decide(w, settings, 2);
    return w;
  };
  WhichSettings s;
  s.noise = false;
  const Which a = decided(6.0, 0.5, 0.5, s);
  EXPECT_EQ(a.claim, "a");
  // a: 0.35 * 0.9 / 2 = 0.1575 times e^6; none: 0.4; unknown: what a best p of 0.5 gives it.
  const double by_misfit = 0.25 * 0.25 * 0.1 * std::pow(0.5, -0.9) / (0.4 + 2.0 * 0.1575);
  EXPECT_NEAR(a.judged[0].probability,
              0.1575 * std::exp(6.0) / (0.1575 * std::exp(6.0) + 0.4) / (1.0 + by_misfit), 1e-8);
  EXPECT_EQ(decided(0.5, 0.5, 0.5, s).claim, "undecided");
  EXPECT_EQ(decided(6.0, 0.03, 0.5, s).claim, "undecided");
  EXPECT_EQ(decided(6.0, 0.03, 0.03, s).claim, "undecided"); // too bad to claim, not to be unknown
  EXPECT_EQ(decided(6.0, 0.005, 0.005, s).claim, "undecided");
  const Which nothing_fits = decided(6.0, 1e-5, 1e-6, s);
  EXPECT_EQ(nothing_fits.claim, "unknown");
  EXPECT_EQ(nothing_fits.set95, std::vector<std::string>{"unknown"});
  EXPECT_EQ(decided(6.0, 0.5, 0.5, s, 12.0).claim, "undecided"); // an integral few samples carry
  Which noise;
  noise.judged = {judged(Hypothesis::none, {}, "none", 0.0, 0.5),
                  judged(Hypothesis::noise, {}, "noise", 20.0, 0.0)};
  decide(noise, s, 0);
  EXPECT_EQ(noise.claim, "noise");
  WhichSettings single_numbers = s;
  single_numbers.noise_seen = false;
  decide(noise, single_numbers, 0);
  EXPECT_EQ(noise.claim, "undecided");
  EXPECT_NE(noise.why.find("give a curve"), std::string::npos);
  noise.judged[0].evidence.samples = 1024;
  noise.judged[0].evidence.effective_samples = 12.0;
  decide(noise, s, 0);
  EXPECT_EQ(noise.claim, "undecided");
  s.poor = {"a"};
  EXPECT_EQ(decided(6.0, 0.5, 0.5, s).claim, "undecided");
  s.poor = {"b"};
  EXPECT_EQ(decided(6.0, 0.5, 0.5, s).claim, "a");
  s.priors.weight["a"] = 0.0;
  EXPECT_EQ(decided(6.0, 0.5, 0.5, s).claim, "none");
}

Judged given(Hypothesis::Kind kind, std::vector<int> on, const char *name, double log_evidence) {
  Judged j;
  j.hypothesis = {kind, std::move(on), name, 0.0};
  j.evidence.log_evidence = log_evidence;
  return j;
}

// The density of the best p where something unknown acts is 0.1 p^-0.9, against 1: a quarter of
// the unknown's prior of 0.25 with that of all that predicts, 0.75, none and the effect.
TEST(Decide, WhatFitsBadlySpeaksForTheUnknownByDegrees) {
  for (const double p : {0.5, 0.05, 0.011, 0.009, 1e-3, 1e-6}) {
    Which w;
    w.judged = {given(Hypothesis::none, {}, "none", 0.0), given(Hypothesis::effects, {0}, "a", 2.0),
                given(Hypothesis::unknown, {}, "unknown", -1.0)};
    w.judged[0].adequacy_p = w.judged[1].adequacy_p = p;
    WhichSettings s;
    s.noise = false;
    decide(w, s, 1);
    const double known = 0.4 + 0.35 * std::exp(2.0);
    const double by_misfit = 0.25 * 0.25 * 0.1 * std::pow(p, -0.9) * known / 0.75;
    const double unknown = 0.75 * 0.25 * std::exp(-1.0) + by_misfit;
    EXPECT_NEAR(w.of("unknown").probability, unknown / (unknown + known), 1e-12) << p;
    EXPECT_NEAR(w.of("unknown").by_misfit, by_misfit / unknown, 1e-12) << p;
  }
}

// Split over pairs, no set has 0.8; the effect in all of them has.
TEST(Decide, AnEffectIsNamedByWhatAllItsPairsHave) {
  const auto decided = [](double log_b, double p = 0.5, double log_ac = 7.0) {
    Which w;
    w.judged = {given(Hypothesis::none, {}, "none", 0.0),
                given(Hypothesis::effects, {0}, "a", 4.0),
                given(Hypothesis::effects, {1}, "b", log_b),
                given(Hypothesis::effects, {2}, "c", 0.0),
                given(Hypothesis::effects, {0, 1}, "a + b", 7.0),
                given(Hypothesis::effects, {0, 2}, "a + c", log_ac),
                given(Hypothesis::unknown, {}, "unknown", 0.0)};
    for (Judged &j : w.judged)
      j.adequacy_p = j.hypothesis.name == "none" ? 1.0 : p;
    WhichSettings s;
    s.noise = false;
    decide(w, s, 3);
    return w;
  };
  const Which w = decided(0.0);
  EXPECT_LT(w.judged.front().probability, 0.5);
  EXPECT_EQ(w.claim, "a") << w.why;
  EXPECT_NE(w.why.find("together with something else"), std::string::npos) << w.why;
  EXPECT_GT(w.inclusion.at("a"), 0.9);
  EXPECT_LT(w.inclusion.at("b"), 0.6);
  // Pairs have e^3 times the evidence of a alone, and 0.1 of its prior among the three of them.
  const double pair = 0.1 * std::exp(3.0), alone = 0.9;
  ASSERT_EQ(w.beside.size(), 2u);
  EXPECT_EQ(w.beside[0].effect, "b");
  EXPECT_NEAR(w.beside[0].probability, pair / (2.0 * pair + alone), 1e-12);
  EXPECT_NEAR(w.beside[0].prior, 0.1 / 1.1, 1e-12);
  // Excluded: less than a twentieth of the evidence of all in which a acts without c.
  const double rest = (pair + alone) / (0.1 + alone); // over that of a alone
  const double least = 4.0 + std::log(0.05 * rest);
  for (const bool excluded : {false, true}) {
    const Which without_c = decided(0.0, 0.5, least + (excluded ? -0.01 : 0.01));
    ASSERT_EQ(without_c.beside.size(), excluded ? 1u : 2u);
    EXPECT_EQ(without_c.beside[0].effect, "b");
  }
  const Which open = decided(6.0); // b alone does as well
  EXPECT_EQ(open.claim, "undecided");
  EXPECT_TRUE(open.beside.empty());
  char most[16]; // not that of the most probable set
  std::snprintf(most, sizeof most, "has %.3g;",
                std::max(open.inclusion.at("a"), open.inclusion.at("b")));
  EXPECT_NE(open.why.find(most), std::string::npos) << open.why;
  EXPECT_EQ(decided(0.0, 0.03).claim, "undecided");
}

// An effect whose posterior lies to 3/4 below its limit: what of it can be seen is a quarter.
TEST(Decide, EffectsTooSmallToBeSeenCountAsNone) {
  LinearWorld world(2, 0, 1, 1);
  Problem problem = world.problem(Vector::Zero(2));
  problem.effects[0].parameters[0].prior = {Prior::uniform, 0.0, 1.0};
  const Prior &p = problem.effects[0].parameters[0].prior;
  // priors 0.4, 0.35 and 0.25: none is left 0.6, the effect 0.32, the unknown 0.08
  const auto decided = [&](double limit, double none = 0.6, double effect = 0.32,
                           double adequacy = 1.0) {
    Which w;
    const auto add = [&](Hypothesis::Kind kind, std::vector<int> on, const char *name, double of) {
      Judged j;
      j.hypothesis = {kind, std::move(on), name, 0.0};
      j.evidence.log_evidence = std::log(of);
      j.evidence.draws.resize(Eigen::Index(j.hypothesis.on.size()), 4);
      for (Eigen::Index k = 0; k < j.evidence.draws.size(); ++k)
        j.evidence.draws(0, k) = p.score(0.2 * double(k + 1)); // 0.2, 0.4, 0.6, 0.8
      j.adequacy_p = kind == Hypothesis::none ? adequacy : 1.0;
      w.judged.push_back(j);
    };
    add(Hypothesis::none, {}, "none", none / 0.4);
    add(Hypothesis::effects, {0}, "effect 0", effect / 0.35);
    // 3/4 of it by evidence, the rest by the best p, whose density at 1 is 0.1
    const double by_misfit = 0.0625 * 0.1 * (none + effect) / 0.75;
    add(Hypothesis::unknown, {}, "unknown", (1.0 - none - effect - by_misfit) / 0.75 / 0.25);
    set_limits(w, problem, {limit});
    decide(w, {}, 1);
    return w;
  };
  EXPECT_NEAR(decided(0.7).none_to_be_seen, 0.6 + 0.75 * 0.32, 1e-12);
  EXPECT_EQ(decided(0.7).claim, "none");
  for (const Sensitivity &s : decided(0.7).sensitivity) {
    const bool less = s.change == "none halved" || s.change == "unknown doubled";
    EXPECT_EQ(s.claim, less ? "undecided" : "none") << s.change;
  }
  EXPECT_NEAR(decided(0.5).none_to_be_seen, 0.76, 1e-12); // half of it could be seen
  EXPECT_EQ(decided(0.5).claim, "undecided");
  EXPECT_NEAR(decided(std::nan("")).none_to_be_seen, 0.92, 1e-12); // nothing of it ever
  EXPECT_EQ(decided(std::nan(""), 0.6, 0.1).claim, "undecided");   // the unknown is not none
  EXPECT_EQ(decided(0.7, 0.6, 0.32, 0.001).claim, "undecided");    // it does not fit
  EXPECT_EQ(decided(std::nan(""), 0.3, 0.62).claim, "undecided");  // the effect leads
}

} // namespace
} // namespace calendem::inference
