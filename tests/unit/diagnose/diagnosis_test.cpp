// SPDX-License-Identifier: GPL-2.0-or-later
// The whole way on a bank from formulas: learn, recalibrate, weigh, say.
#include "diagnose/diagnosis.h"
#include "synthetic_bank.h"
#include <chrono>
#include <gtest/gtest.h>

namespace calendem::diagnose {
namespace {

constexpr double kScatter = 0.04, kNoise = 0.04;

Settings quick() {
  Settings s;
  s.which.evidence.samples = 256;
  s.where.simulations = 4000;
  return s;
}

Candidate dwell() {
  return {"dwell", 2.0, {synthetic_observables().back()}, Matrix::Constant(1, 1, kNoise * kNoise)};
}
Candidate second_scale() { // another measurement of what is known already
  return {"porosity again",
          1.0,
          {synthetic_observables()[kCurve]},
          Matrix::Constant(1, 1, kNoise * kNoise)};
}

/// The bank, with one effect left out of the candidates where `without` names it.
struct Laboratory {
  Bank bank = synthetic_bank(40, kScatter);
  explicit Laboratory(const std::vector<std::string> &without) {
    for (const std::string &name : without) {
      bank.runs.erase(std::remove_if(bank.runs.begin(), bank.runs.end(),
                                     [&](const Run &r) { return r.effect == name; }),
                      bank.runs.end());
      bank.effects.erase(std::remove_if(bank.effects.begin(), bank.effects.end(),
                                        [&](const Effect &e) { return e.name == name; }),
                         bank.effects.end());
    }
  }
  Diagnosis diagnose(const ObservableVector &e,
                     const std::vector<Candidate> &candidates = {}) const {
    const Model model(bank, e, quick().model, candidates);
    return diagnose::diagnose(model, bank, e.values, quick());
  }
};

TEST(Diagnosis, NoGapIsNone) {
  const Laboratory lab({"viscous"});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto t0 = std::chrono::steady_clock::now();
    const Diagnosis d = lab.diagnose(synthetic_experiment("", 0.0, seed, kScatter, kNoise));
    printf("%g s %s\n",
           std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count(),
           to_json(d).c_str());
    EXPECT_EQ(d.which.claim, "none") << d.which.why;
    EXPECT_FALSE(d.where.rows[0].significant);
    EXPECT_GT(d.emulators[0].q2, 0.9);
  }
}

TEST(Diagnosis, AnEffectIsNamed) {
  const Laboratory lab({"viscous"});
  for (const char *effect : {"plasticity", "friction"}) {
    const Diagnosis d = lab.diagnose(synthetic_experiment(effect, 0.7, 5, kScatter, kNoise));
    EXPECT_EQ(d.which.claim, effect) << d.which.why << to_json(d);
    EXPECT_GT(d.which.adequacy_p, 0.01);
  }
}

TEST(Diagnosis, WhatNoCandidateExplainsIsUnknown) {
  const Laboratory without({"viscous", "friction"});
  EXPECT_EQ(
      without.diagnose(synthetic_experiment("friction", 0.9, 5, kScatter, kNoise)).which.claim,
      "unknown");
  // Outside the span of all runs: only the truncation residual can show it.
  const Laboratory lab({});
  EXPECT_EQ(lab.diagnose(synthetic_experiment("oscillation", 0.9, 6, kScatter, kNoise)).which.claim,
            "unknown");
}

TEST(Diagnosis, TwinsAreNotToldApartAndTheMeasurementThatDoesIsNamed) {
  const Laboratory lab({});
  const Diagnosis d = lab.diagnose(synthetic_experiment("plasticity", 0.8, 7, kScatter, kNoise),
                                   {second_scale(), dwell()});
  EXPECT_EQ(d.which.claim, "undecided");
  ASSERT_EQ(d.confounding.indistinguishable.size(), 1u);
  auto twins = d.confounding.indistinguishable[0];
  std::sort(twins.begin(), twins.end());
  EXPECT_EQ(twins, (std::vector<std::string>{"plasticity", "viscous"}));
  ASSERT_EQ(d.next.size(), 2u);
  EXPECT_EQ(d.next[0].what, "dwell");
  EXPECT_GT(d.next[0].expected_probability, 0.9);
  EXPECT_LT(d.next[1].expected_probability, d.next[1].now + 0.1);
}

TEST(Diagnosis, SameBytesTwice) {
  const ObservableVector e = synthetic_experiment("plasticity", 0.5, 8, kScatter, kNoise);
  const std::string once = to_json(Laboratory({}).diagnose(e, {dwell()}));
  EXPECT_EQ(once, to_json(Laboratory({}).diagnose(e, {dwell()})));
}

} // namespace
} // namespace calendem::diagnose
