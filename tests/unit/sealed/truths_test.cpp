// SPDX-License-Identifier: GPL-2.0-or-later
// Draws of a round.
#include "base/messages.h"
#include "diagnose/bank/bank_table.h"
#include "small_round.h"
#include <cmath>
#include <set>

namespace {

using namespace calendem_test;

std::map<std::string, std::string> answers_of(const Round &round,
                                              const std::vector<Truth> &truths) {
  std::map<std::string, std::string> out;
  for (const Truth &t : truths)
    out[t.block + (t.hidden.empty() ? "" : " " + t.hidden[0])] = right_answer(t, round.bank);
  return out;
}

TEST(Truths, ARoundHoldsWhatItsFileAsksFor) {
  const Round round = round_of(kRound);
  const std::vector<Truth> truths = draw_truths(round, "secret");
  ASSERT_EQ(truths.size(), 2u + 2 * 3 + 1 + 1 + 1 + 2);
  EXPECT_EQ(truths[0].draws + truths[1].draws, 5);
  std::set<unsigned long> packings;
  for (const Truth &t : truths) {
    EXPECT_EQ(t.packings.size(), 3u);
    for (const unsigned long packing : t.packings)
      EXPECT_TRUE(packings.insert(packing).second && packing > 1000);
    EXPECT_TRUE(t.base[0] > 150 && t.base[0] < 400);
  }
  for (int k = 0; k < 3; ++k) // each in its third of 0.05 to 0.6
    EXPECT_EQ(int((truths[2 + k].effects[0].second - 0.05) / 0.55 * 3), k);
  auto answers = answers_of(round, truths);
  EXPECT_EQ(answers["null"], "none");
  EXPECT_EQ(answers["open cohesion"], "unknown");
  EXPECT_EQ(answers["pair"], "friction + thickness_zero"); // in the bank's order
  EXPECT_EQ(answers["fault"], "noise");
  EXPECT_EQ(answers["other larger_cell"], "friction");
  EXPECT_EQ(answers["other half_time_step"], "none");
}

TEST(Truths, TheSecretDecidesAllDraws) {
  const Round round = round_of(kRound);
  const auto text = [&](const std::string &secret) {
    std::string out;
    for (const Truth &t : draw_truths(round, secret))
      out += to_json(t, round.bank).dump();
    return out;
  };
  EXPECT_EQ(text("one"), text("one"));
  EXPECT_NE(text("one"), text("two"));
}

TEST(Truths, RunsHaveTheTruthsSettings) {
  const Round round = round_of(kRound);
  const std::vector<Truth> truths = draw_truths(round, "secret");
  const Study study = truth_runs(round, truths).study;
  ASSERT_EQ(study.runs.size(), 3 * 2 * truths.size());
  for (std::size_t t = 0; t < truths.size(); ++t) {
    const Settings &s = study.runs[6 * t + 5].settings;
    const bool larger = !truths[t].hidden.empty() && truths[t].hidden[0] == "larger_cell";
    EXPECT_NEAR(s.number("platen.max_pressure_MPa"), 50 * (1 + truths[t].pressure_error), 1e-3);
    EXPECT_EQ(s.number("bond.shear_strength_MPa"), truths[t].base[0]);
    EXPECT_NEAR(study.runs[6 * t].recipe.cell_x, larger ? 7.8 : 6.0, 1e-9);
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_EQ(study.runs[6 * t + k].recipe.seed, truths[t].packings[k / 2]);
    const bool rough = !truths[t].effects.empty() && truths[t].effects.back().first == "friction";
    EXPECT_EQ(s.number("material.am.friction"), rough ? truths[t].effects.back().second : 0.001);
  }
}

TEST(Truths, NumbersOfSamplesComeInTurn) {
  std::string text = kRound;
  text.replace(text.find("samples = 3"), 11, "samples = [2, 10]");
  const Round round = round_of(text);
  const std::vector<Truth> truths = draw_truths(round, "secret");
  std::vector<int> samples;
  std::size_t runs = 0;
  for (const Truth &t : truths) {
    samples.push_back(t.samples);
    EXPECT_EQ(t.packings.size(), std::size_t(t.samples));
    EXPECT_EQ(to_json(t, round.bank)["samples"], t.samples);
    runs += 2 * t.packings.size();
  }
  // two nulls, three amplitudes of each effect, then a block in each line of the file
  EXPECT_EQ(samples, (std::vector<int>{2, 10, 2, 10, 2, 10, 2, 10, 2, 2, 2, 2, 10}));
  const Study study = truth_runs(round, truths).study;
  ASSERT_EQ(study.runs.size(), runs);
  EXPECT_EQ(study.runs.back().recipe.seed, truths.back().packings.back());
  text.replace(text.find("[2, 10]"), 7, "[]");
  EXPECT_THROW(round_of(text), Failure);
}

// A press has a new disc for each pressure.
TEST(Truths, APressureCanHaveDiscsOfItsOwn) {
  std::string text = kRound;
  text.insert(text.find("samples"), "specimens = \"one for each pressure\"\n");
  const Round round = round_of(text);
  const std::vector<Truth> truths = draw_truths(round, "secret");
  const Study study = truth_runs(round, truths).study;
  std::set<unsigned long> packings;
  for (const StudyRun &run : study.runs)
    packings.insert(run.recipe.seed);
  EXPECT_EQ(packings.size(), study.runs.size());
  EXPECT_EQ(study.runs[4].recipe.seed, truths[0].packings[4]);
}

TEST(Truths, WithoutItsCauseATruthKeepsItsSamplesPressAndNumerics) {
  const Round round = round_of(kRound);
  int causes = 0;
  for (const Truth &t : draw_truths(round, "secret")) {
    const Truth without = without_cause(t);
    EXPECT_FALSE(has_cause(without));
    EXPECT_EQ(without.packings, t.packings);
    EXPECT_EQ(without.pressure_error, t.pressure_error);
    EXPECT_EQ(without.understated, t.understated);
    causes += has_cause(t);
    const auto numerics = [](const Truth &of) {
      return std::count_if(of.hidden.begin(), of.hidden.end(),
                           [](const auto &name) { return find_hidden(name)->numerics; });
    };
    EXPECT_EQ(numerics(without), numerics(t));
    EXPECT_EQ(without.hidden.size(), std::size_t(numerics(t)));
  }
  EXPECT_EQ(causes, 2 * 3 + 1 + 1 + 1); // effects, cohesion, the pair, friction on a larger cell
  Round paired = round;
  paired.paired_runs = true;
  const std::vector<Truth> truths = draw_truths(round, "secret"), all = with_pairs(paired, truths);
  EXPECT_EQ(with_pairs(round, truths).size(), truths.size());
  ASSERT_EQ(int(all.size()), int(truths.size()) + causes);
  EXPECT_EQ(all.back().packings, truths[truths.size() - 2].packings); // larger_cell + friction
}

// One run without a cause serves a null and all causes on its samples.
TEST(Truths, SharedSamplesAreRunOnceWithoutACause) {
  std::string text = kRound;
  text.insert(text.find("samples"), "shared_samples = \"yes\"\npaired_runs = \"yes\"\n");
  const Round round = round_of(text);
  const std::vector<Truth> truths = draw_truths(round, "secret");
  for (std::size_t k = 2; k < truths.size(); ++k) {
    const Truth &t = truths[k], &null = truths[k % 2];
    EXPECT_EQ(t.set, null.set);
    EXPECT_EQ(t.packings, null.packings);
    EXPECT_EQ(t.base, null.base);
    EXPECT_EQ(t.pressure_error, null.pressure_error * t.understated);
  }
  // nulls, effects, cohesion, the pair, noise and two of other numerics, of which one has a cause
  const TruthRuns runs = truth_runs(round, with_pairs(round, truths));
  EXPECT_EQ(runs.study.runs.size(), 6u * (2 + 2 * 3 + 1 + 1 + 1 + 2 + 1));
  ASSERT_EQ(runs.of_truths.size(), 6u * (truths.size() + 9));
  for (std::size_t k = 0; k < 6; ++k) // the companion of the first effect is the first null
    EXPECT_EQ(runs.of_truths[6 * truths.size() + k], runs.of_truths[k]);
  EXPECT_NE(runs.of_truths[6 * 2], runs.of_truths[0]);
}

// Bonds are as stiff as their particles unless a change makes them softer.
TEST(Truths, WhatAChangeSetsFollowsItsOwnInOtherTruths) {
  std::string text = kRound;
  text.replace(text.find("cohesion"), 8, "soft_bonds");
  Round round = round_of(text);
  round.bank.parameters[0].keys = {"case.material.am.youngs_modulus_GPa"};
  const Study study = truth_runs(round, draw_truths(round, "secret")).study;
  std::size_t soft = 0;
  for (const StudyRun &run : study.runs) {
    const double bond = run.settings.number("bond.youngs_modulus_GPa");
    soft += bond == 30.0;
    EXPECT_TRUE(bond == 30.0 || bond == run.settings.number("material.am.youngs_modulus_GPa"));
  }
  EXPECT_GT(soft, 0u);
  EXPECT_LT(soft, study.runs.size());
}

// Sets are few; half of two lie in each half of every prior, and which is which differs from parameter to parameter.
TEST(Truths, SetsOfSharedSamplesCoverThePriors) {
  std::string text = kRound;
  text.insert(text.find("samples"), "shared_samples = \"yes\"\n");
  Round round = round_of(text);
  round.bank.parameters.push_back(round.bank.parameters[0]);
  round.bank.parameters[1].name = "another";
  int alike = 0;
  for (int draw = 0; draw < 20; ++draw) {
    const std::vector<Truth> truths = draw_truths(round, std::to_string(draw));
    std::vector<bool> first_above;
    for (std::size_t p = 0; p < round.bank.parameters.size(); ++p) {
      const BankParameter &of = round.bank.parameters[p];
      const double middle = prior_value(of.low, of.high, of.spread, 0.5);
      first_above.push_back(truths[0].base[p] > middle);
      EXPECT_NE(truths[1].base[p] > middle, first_above.back());
    }
    alike += first_above.front() == first_above.back();
  }
  EXPECT_GT(alike, 0); // all or none alike once in 2^19
  EXPECT_LT(alike, 20);
}

// A round that takes too long is cut down to some of its sets, each with its null first.
TEST(Truths, ARoundOfSharedSamplesCanBeCutDownToSets) {
  std::string text = kRound;
  text.insert(text.find("samples"), "shared_samples = \"yes\"\n");
  const Round round = round_of(text);
  const std::vector<Truth> all = truths_of_sets(round, "secret", 0),
                           one = truths_of_sets(round, "secret", 1);
  EXPECT_EQ(all.size(), draw_truths(round, "secret").size());
  ASSERT_LT(one.size(), all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k].set, k < one.size() ? 0u : 1u);
    EXPECT_EQ(all[k].block == "null", k == 0 || k == one.size());
    if (k < one.size())
      EXPECT_EQ(to_json(one[k], round.bank), to_json(all[k], round.bank));
  }
  const auto first = [&](const std::string &secret) {
    const std::vector<Truth> truths = draw_truths(round, secret);
    return truths[0].set;
  };
  std::set<std::size_t> which;
  for (int k = 0; k < 20; ++k) // all alike once in 2^19
    which.insert(first(std::to_string(k)));
  EXPECT_EQ(which.size(), 2u);
  EXPECT_THROW(truths_of_sets(round_of(kRound), "secret", 1), Failure);
}

TEST(Truths, RepeatsAreOtherSpecimens) {
  for (const char *kind : {"one for all pressures", "one for each pressure"}) {
    std::string text = kRound;
    text.insert(text.find("samples"), std::string("repeats = 2\nspecimens = \"") + kind + "\"\n");
    const Round round = round_of(text);
    const std::vector<Truth> truths = draw_truths(round, "secret");
    const Study study = truth_runs(round, {truths[0]}).study;
    ASSERT_EQ(study.runs.size(), 2u * 3 * 2);
    std::set<unsigned long> first, second;
    for (std::size_t k = 0; k < 12; ++k)
      (k < 6 ? first : second).insert(study.runs[k].recipe.seed);
    const std::size_t packings = round.disc_for_each_pressure ? 6 : 3;
    EXPECT_EQ(first.size(), packings);
    EXPECT_EQ(second.size(), packings);
    first.merge(second);
    EXPECT_EQ(first.size(), 2 * packings);
    EXPECT_NEAR(study.runs[7].settings.number("platen.max_pressure_MPa"),
                50 * (1 + truths[0].pressure_error), 1e-3);
  }
}

TEST(Truths, AnInterventionHasSamplesOfItsOwnBeforeIt) {
  const std::string text =
      kRound.substr(0, kRound.find("[noise]")) +
      "interventions = [\"friction\", \"cohesion\", \"nothing\", \"half_time_step + friction\"]\n";
  const Round round = round_of(text);
  const std::vector<Truth> truths = draw_truths(round, "secret");
  const std::vector<std::string> answers = {"friction", "unknown", "none", "friction"};
  const std::size_t first = truths.size() - answers.size();
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const Truth &after = truths[first + k];
    EXPECT_EQ(after.block, kIntervention);
    EXPECT_EQ(right_answer(after, round.bank), answers[k]);
    const auto before = companion(round, after);
    ASSERT_TRUE(before);
    EXPECT_FALSE(has_cause(*before));
    EXPECT_EQ(before->hidden.size(), k == 3 ? 1u : 0u); // the numerics are those of both
    EXPECT_EQ(before->base, after.base);
    EXPECT_EQ(before->pressure_error, after.pressure_error);
    std::set<unsigned long> packings(after.packings.begin(), after.packings.end());
    packings.insert(before->packings.begin(), before->packings.end());
    EXPECT_EQ(packings.size(), 6u);
  }
  EXPECT_EQ(with_pairs(round, truths).size(), truths.size() + answers.size());
  const Round same = round_of(text + "interventions_on = \"the same specimens\"\n");
  const Truth last = draw_truths(same, "secret").back();
  EXPECT_EQ(companion(same, last)->packings, last.packings);
  // what a round without them draws does not change
  const std::vector<Truth> others = draw_truths(round_of(kRound), "secret");
  ASSERT_EQ(others.size(), first);
  EXPECT_EQ(others.back().packings, truths[first - 1].packings);
}

// Intervals of 90 % hold 90 % of the truths only if truths are drawn from the whole prior.
TEST(Truths, BaseParametersAreDrawnFromTheirPriors) {
  const Round round = round_of(kRound);
  int tails = 0, all = 0;
  for (int k = 0; k < 100; ++k)
    for (const Truth &t : draw_truths(round, std::to_string(k))) {
      tails += t.base[0] < 150 + 0.05 * 250 || t.base[0] > 400 - 0.05 * 250;
      ++all;
    }
  EXPECT_NEAR(double(tails) / all, 0.1, 4.0 * std::sqrt(0.09 / all));
}

TEST(Truths, MistakesOfARoundAreReported) {
  try {
    round_of("[round]\nbank = \"bank.toml\"\nnull_packings = 9\nnull_draws = 3\nopen = "
             "[\"cohesin\"]\ninterventions = [\"noise\"]\n[noise]\nthickness_um = "
             "-1\nunderstated_by = [4, 3]\n");
    FAIL();
  } catch (const Failure &e) {
    const std::string message = e.what();
    for (const char *part :
         {"null_draws is 3, null_packings 9", "Did you mean 'cohesion'",
          "interventions: 'noise' is no effect of the bank", "thickness_um is -1", "[least, most]"})
      EXPECT_NE(message.find(part), std::string::npos) << part << "\nis not in\n" << message;
  }
  EXPECT_THROW(round_of("[round]\nbank = \"bank.toml\"\nnull_packings = 0\nnull_draws = 0\n"
                        "shared_samples = \"yes\"\n"),
               Failure);
}

} // namespace
