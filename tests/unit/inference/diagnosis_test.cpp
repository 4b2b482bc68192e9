// SPDX-License-Identifier: GPL-2.0-or-later
// The whole way on a bank from formulas: learn, recalibrate, weigh, say.
#include "diagnose/inference/diagnosis.h"
#include "support/with_all.h"
#include "synthetic_bank.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace calendem::inference {
namespace {

constexpr double kPackingScatter = 0.04, kMeasured = 0.04;

DiagnosisSettings quick_diagnosis() {
  DiagnosisSettings s;
  s.which.evidence.samples = 256;
  s.where.simulations = 2000;
  return s;
}

Candidate dwell() {
  return {"dwell",
          2.0,
          {synthetic_observables().back()},
          Matrix::Constant(1, 1, kMeasured * kMeasured)};
}
Candidate second_scale() { // another measurement of what is known already
  return {"porosity again",
          1.0,
          {synthetic_observables()[kCurve]},
          Matrix::Constant(1, 1, kMeasured * kMeasured)};
}

/// What is learnt once for all experiments with these observables, without some of the effects.
struct Laboratory {
  Bank bank = synthetic_bank(40, kPackingScatter);
  std::unique_ptr<Model> model;
  explicit Laboratory(const std::vector<std::string> &without,
                      const std::vector<Candidate> &candidates = {}) {
    for (const std::string &name : without) {
      bank.runs.erase(std::remove_if(bank.runs.begin(), bank.runs.end(),
                                     [&](const BankRun &r) { return r.effect == name; }),
                      bank.runs.end());
      bank.effects.erase(std::remove_if(bank.effects.begin(), bank.effects.end(),
                                        [&](const ModelledEffect &e) { return e.name == name; }),
                         bank.effects.end());
    }
    model =
        std::make_unique<Model>(bank, experiment("", 0.0, 1), quick_diagnosis().model, candidates);
  }
  static ObservableVector experiment(const std::string &effect, double a, std::uint64_t seed) {
    return synthetic_experiment(effect, a, seed, kPackingScatter, kMeasured);
  }
  Diagnosis diagnose(const std::string &effect, double a, std::uint64_t seed,
                     const std::vector<PointNoise> &point_noise = {}) const {
    return inference::diagnose(*model, bank, experiment(effect, a, seed).values, quick_diagnosis(),
                               point_noise);
  }
};

// Experiments without a gap: false claims within three binomial standard deviations of the gate
// of 3 %. A weak effect cannot be excluded in all of them, so some stay undecided.
TEST(Diagnosis, NoGapIsNoneOrUndecided) {
  const Laboratory lab({"viscous"});
  const int experiments = calendem_test::with_all(15, 5);
  int none = 0, wrong = 0;
  for (int seed = 1; seed <= experiments; ++seed) {
    const Diagnosis d = lab.diagnose("", 0.0, std::uint64_t(seed));
    none += d.which.claim == "none";
    wrong += d.which.claim != "none" && d.which.claim != "undecided";
    EXPECT_EQ(d.which.judged.front().hypothesis.name, "none") << seed;
  }
  EXPECT_GT(2 * none, experiments);
  EXPECT_LE(wrong, experiments * 0.03 + 3.0 * std::sqrt(experiments * 0.03 * 0.97));
}

TEST(Diagnosis, AnEffectIsNamedWithItsPlaceAndParameters) {
  const Laboratory lab({"viscous"});
  for (const char *effect : {"plasticity", "friction"}) {
    const Diagnosis d = lab.diagnose(effect, 0.7, 5);
    EXPECT_EQ(d.which.judged.front().hypothesis.name, effect) << d.which.why;
    ASSERT_EQ(d.effects.size(), 1u);
    EXPECT_EQ(d.effects[0].effect, effect);
    EXPECT_LT(d.effects[0].low90, d.effects[0].mode);
    EXPECT_LT(d.effects[0].mode, d.effects[0].high90);
    EXPECT_GT(d.which.adequacy_p, 0.01);
    EXPECT_TRUE(d.where.rows[0].significant);
    const Judged &best = d.which.of(effect);
    const double amplitude = lab.bank.effects[0].parameters[0].prior.value(best.evidence.mode[2]);
    EXPECT_NEAR(amplitude, 0.7, 0.15) << effect;
    EXPECT_EQ(d.effects[0].mode, amplitude);
    EXPECT_LT(d.parameters[0].low90, d.parameters[0].high90);
  }
}

// With so few features what only acts like an effect cannot always be excluded: at more than four
// times the detection limit it is named in at least half of the experiments, and nothing else is.
TEST(Diagnosis, AnEffectIsNamedOrUndecidedButNoOther) {
  const Laboratory lab({"viscous"});
  int named = 0, experiments = 0;
  for (const char *effect : {"plasticity", "friction"})
    for (int seed = 1; seed <= calendem_test::with_all(8, 3); ++seed, ++experiments) {
      const Diagnosis d = lab.diagnose(effect, 0.7, std::uint64_t(seed));
      named += d.which.claim == effect;
      EXPECT_TRUE(d.which.claim == effect || d.which.claim == "undecided") << d.which.claim;
      EXPECT_EQ(d.which.judged.front().hypothesis.name, effect) << seed;
    }
  EXPECT_GE(2 * named, experiments);
}

TEST(Diagnosis, WhatNoCandidateExplainsIsUnknown) {
  const Laboratory without({"viscous", "friction"});
  EXPECT_EQ(without.diagnose("friction", 0.9, 5).which.claim, "unknown");
  // Outside the span of all runs: the truncation residual shows it. Large errors would too, but not
  // where the points of the release scatter as their error says.
  const Laboratory lab({});
  EXPECT_EQ(lab.diagnose("oscillation", 0.9, 6).which.claim, "undecided");
  const Diagnosis d = lab.diagnose("oscillation", 0.9, 6, {{"p150", 0.2, Vector::Ones(30)}});
  EXPECT_EQ(d.which.claim, "unknown");
  EXPECT_EQ(d.blocks[d.where.rows[0].block].name, "ln pressure");
  EXPECT_TRUE(d.where.rows[0].significant);
}

TEST(Diagnosis, TwinsAreIndistinguishableAndTheMeasurementThatSeparatesThemIsNamed) {
  const Laboratory lab({}, {second_scale(), dwell()});
  const Diagnosis d = lab.diagnose("plasticity", 0.8, 7);
  EXPECT_EQ(d.which.claim, "undecided");
  ASSERT_EQ(d.confounding.indistinguishable.size(), 1u);
  const auto &twins = d.confounding.indistinguishable[0];
  for (const char *name : {"plasticity", "viscous"})
    EXPECT_EQ(std::count(twins.begin(), twins.end(), name), 1) << name;
  EXPECT_GT(d.confounding.cosine(0, 2), 0.99);
  EXPECT_LT(d.confounding.log_odds(0, 2), 3.0);
  ASSERT_EQ(d.next.size(), 2u);
  EXPECT_EQ(d.next[0].what, "dwell");
  EXPECT_GT(d.next[0].expected_probability, d.next[0].now + 0.3);
  EXPECT_NEAR(d.next[1].expected_probability, d.next[1].now, 0.1);
}

// Effects that no run can teach: the packings' scatter drowns them, and so little is known that no
// claim may rest on it.
TEST(Diagnosis, EmulatorsThatArePoorAreSaidToBe) {
  Bank bank = synthetic_bank(12, kPackingScatter);
  Random random(1, 1);
  for (auto &r : bank.runs)
    if (r.effect == "friction")
      for (double &v : r.values)
        v += 2.0 * random.normal();
  const ObservableVector e = Laboratory::experiment("", 0.0, 1);
  const Model model(bank, e, {});
  EXPECT_EQ(model.poor_effects(), std::vector<std::string>{"friction"});
}

// Runs that scatter by more than the effect changes them: a single one cannot be predicted, but the
// expectation, which a large sample shows, can be learnt from enough of them.
TEST(Diagnosis, EmulatorsAreJudgedByWhatCanBeLearnt) {
  const auto with_runs = [](int runs) {
    Bank bank = synthetic_bank(runs, kPackingScatter);
    Random random(1, 1);
    for (auto &r : bank.runs)
      if (r.effect == "friction")
        for (double &v : r.values)
          v += 0.4 * random.normal();
    ModelSettings large;
    large.packings_in_sample = 1e6;
    return Model(bank, Laboratory::experiment("", 0.0, 1), large);
  };
  const Model few = with_runs(12), many = with_runs(120);
  EXPECT_EQ(few.poor_effects(), std::vector<std::string>{"friction"});
  EXPECT_EQ(many.poor_effects(), std::vector<std::string>());
  const EmulatorQuality &friction = many.quality()[2];
  EXPECT_EQ(friction.effect, "friction");
  EXPECT_GT(friction.error, 1.0);
  double missed = 0.0, all = 0.0; // of single runs
  for (const Quality &q : friction.feature) {
    missed += q.error * q.error;
    all += q.spread * q.spread;
  }
  EXPECT_LT(1.0 - missed / all, 0.5);
}

TEST(Diagnosis, SameBytesTwice) {
  const auto bytes = [] {
    return to_json(Laboratory({}, {dwell()}).diagnose("plasticity", 0.5, 8), "sample").dump();
  };
  EXPECT_EQ(bytes(), bytes());
}

} // namespace
} // namespace calendem::inference
