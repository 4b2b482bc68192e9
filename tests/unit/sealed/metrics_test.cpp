// SPDX-License-Identifier: GPL-2.0-or-later
// Scores of answers made by hand, whose values can be counted.
#include "base/provenance.h"
#include "sealed/probability_scores.h"
#include "sealed/score.h"
#include "support/test_folder.h"
#include <cmath>
#include <nlohmann/json.hpp>

namespace {

using namespace calendem;

ScoredCase scored(const std::string &block, int cluster, const std::string &truth,
                  const std::string &claim, std::map<std::string, double> probability) {
  ScoredCase c;
  c.block = block;
  c.cluster = cluster;
  c.truth = truth;
  c.claim = claim;
  c.probability = std::move(probability);
  c.signal_to_noise = 8.0;
  c.baselines = {{"always none", "none"}, {"BIC", "friction"}};
  return c;
}

/// Four nulls of two packings, four singles, one effect left out.
std::vector<ScoredCase> round_by_hand() {
  std::vector<ScoredCase> all;
  for (int k = 0; k < 4; ++k)
    all.push_back(scored("null", k / 2, "none", k == 0 ? "friction" : "none",
                         {{"none", k == 0 ? 0.1 : 0.9}, {"friction", k == 0 ? 0.9 : 0.1}}));
  all.push_back(scored("single", 2, "friction", "friction", {{"friction", 0.9}, {"none", 0.1}}));
  all.push_back(scored("single", 3, "friction", "friction", {{"friction", 0.8}, {"none", 0.2}}));
  all.push_back(scored("single", 4, "friction", "undecided", {{"friction", 0.4}, {"none", 0.6}}));
  all.push_back(scored("single", 5, "friction", "undecided", {{"none", 0.6}, {"noise", 0.4}}));
  all.push_back(scored("left_out", 2, "unknown", "unknown", {{"unknown", 0.9}, {"none", 0.1}}));
  for (int k : {4, 5, 6, 7}) {
    all[k].paired = true;
    all[k].true_places = {"p30 a"};
  }
  all[4].places = {"p30 a"};
  all[5].places = {"p30 a", "p30 b"};
  all[4].headline = "explained";
  all[4].covered = {true, false};
  all[4].covered_amplitude = {true};
  return all;
}

Metric named(const std::vector<Metric> &all, const std::string &begin) {
  for (const Metric &m : all)
    if (m.name.rfind(begin, 0) == 0)
      return m;
  ADD_FAILURE() << begin;
  return {};
}

TEST(Scores, AnswersByHandGetTheNumbersThatCanBeCounted) {
  const std::vector<Metric> m = metrics_of(round_by_hand());
  EXPECT_DOUBLE_EQ(named(m, "where").value, 2.0 * 2 / (3 + 4));
  // most probable: three nulls with 0.9, one friction for none with 0.9; singles 0.9, 0.8 right, two
  // of 0.6 wrong; four nulls count 0.4, four singles 0.35
  const double null = 0.4 / 4, single = 0.35 / 4;
  EXPECT_NEAR(named(m, "expected calibration error").value,
              (std::fabs(0.9 * (4 * null + single) - 3 * null - single) + 1.4 * single) / 0.75,
              1e-12);
  EXPECT_DOUBLE_EQ(named(m, "which, top-1, effects").value, 0.5);
  EXPECT_DOUBLE_EQ(named(m, "which, top-2, effects").value, 0.75);
  EXPECT_DOUBLE_EQ(named(m, "wrong share").value, 0.25); // of 4 claims that name something
  EXPECT_DOUBLE_EQ(named(m, "false claims").value, 0.25);
  EXPECT_EQ(named(m, "false claims").clusters, 2);
  EXPECT_DOUBLE_EQ(named(m, "unknown against known").value, 1.0);
  EXPECT_EQ(named(m, "unknown against known").verdict, Metric::met);
  EXPECT_EQ(named(m, "which, top-1, effects").verdict, Metric::missed);
  EXPECT_EQ(named(m, "shrinkage within").verdict, Metric::not_measured);
  EXPECT_DOUBLE_EQ(
      named(m, "90 % intervals of base parameters that hold the truth, answer \"explained\"").value,
      0.5);
  EXPECT_DOUBLE_EQ(named(m, "90 % intervals of amplitudes").value, 1.0);
  const double log_score =
      (std::log(0.9) * 4 + std::log(0.1) + std::log(0.8) + std::log(0.4) + std::log(1e-6)) / -8.0;
  EXPECT_NEAR(named(m, "log score").value, log_score, 1e-12);
}

// One half of a pair is neither right nor wrong where the answer leaves room for the other half.
TEST(Scores, HalfAPairIsRightInPartOnlyIfTheOtherHalfIsNotExcluded) {
  std::vector<ScoredCase> cases;
  for (const char *claim : {"a + b", "a", "b", "a", "c"})
    cases.push_back(scored("pair", int(cases.size()), "a + b", claim, {{claim, 0.9}}));
  cases[1].beside = {"b"};
  cases[2].beside = {"a", "c"};
  cases[3].beside = {"c"};
  cases[4].beside = {"a", "b"};
  const std::vector<Metric> m = metrics_of(cases);
  EXPECT_DOUBLE_EQ(named(m, "pair: claimed in part").value, 0.4);
  EXPECT_DOUBLE_EQ(named(m, "pair: claimed wrong").value, 0.4);
  EXPECT_DOUBLE_EQ(named(m, "wrong share among claims of").value, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(named(m, "wrong share among claims, were").value, 0.8);
}

TEST(Scores, ShrinkageIsJudgedWhereModelsWereRunAgain) {
  std::vector<ScoredCase> cases = round_by_hand();
  const auto run_again = [&](int k, double predicted, double rerun, double placebo) {
    cases[std::size_t(k)].predicted_shrinkage = predicted;
    cases[std::size_t(k)].shrinkage = rerun;
    cases[std::size_t(k)].least_shrinkage = rerun - 0.2;
    cases[std::size_t(k)].most_shrinkage = rerun + 0.2;
    cases[std::size_t(k)].placebo_shrinkage = placebo;
  };
  run_again(4, 0.9, 0.85, 0.1);
  run_again(5, 0.9, 0.75, NAN);
  run_again(6, 0.9, 0.30, 0.5);
  const std::vector<Metric> m = metrics_of(cases);
  EXPECT_DOUBLE_EQ(named(m, "shrinkage within").value, 1.0 / 3.0);
  EXPECT_EQ(named(m, "shrinkage within").verdict, Metric::missed);
  EXPECT_DOUBLE_EQ(named(m, "shrinkage: predicted").value, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(named(m, "shrinkage: the placebo").value, 0.5);
}

TEST(Scores, BaselinesMustBeBeaten) {
  const std::vector<Metric> m = metrics_of(round_by_hand());
  const Metric ours = named(m, "identified correctly, mean of nulls and effects: the diagnosis");
  EXPECT_DOUBLE_EQ(ours.value, 0.5 * (0.75 + 0.5));
  EXPECT_DOUBLE_EQ(named(m, "identified correctly, mean of nulls and effects: always none").value,
                   0.5);
  EXPECT_DOUBLE_EQ(named(m, "identified correctly, mean of nulls and effects: BIC").value, 0.5);
  EXPECT_EQ(ours.verdict, Metric::not_shown); // of so few truths
  std::vector<ScoredCase> worse = round_by_hand();
  for (ScoredCase &c : worse)
    c.baselines["oracle"] = c.truth;
  EXPECT_EQ(
      named(metrics_of(worse), "identified correctly, mean of nulls and effects: the diagnosis")
          .verdict,
      Metric::missed);
}

TEST(Scores, RightAnswersAreListedBySampleSize) {
  std::vector<ScoredCase> cases = round_by_hand();
  for (ScoredCase &c : cases)
    c.samples = 2;
  const std::size_t of_one_size = metrics_of(cases).size();
  cases[4].samples = cases[6].samples = 10; // one of two claimed; with two cells also one of two
  const std::vector<Metric> m = metrics_of(cases);
  EXPECT_EQ(m.size(), of_one_size + 2 * 5);
  for (const char *cells : {"2", "10"}) {
    const Metric one = named(m, std::string("single: claimed right, samples of ") + cells);
    EXPECT_EQ(one.cases, 2);
    EXPECT_DOUBLE_EQ(one.value, 0.5);
  }
  EXPECT_EQ(named(m, "null: claimed right, samples of 2").cases, 4);
}

// As print does it; what is worse than the round's own frequencies has a negative skill.
TEST(Scores, PagesHaveSignsNotTheirSpellings) {
  std::vector<ScoredCase> cases = round_by_hand();
  for (ScoredCase &c : cases)
    c.probability = {{c.truth == "none" ? "friction" : "none", 1.0}};
  const std::string folder = calendem_test::test_folder().string();
  write_scores(cases, "by hand", folder);
  for (const char *file : {"/scores.md", "/scores.html"}) {
    const std::string text = text_of_file(folder + file);
    for (const char *sign : {"≥ 0.85", "≤ 0.05", "0.85–0.95", "−", "0.000–"})
      EXPECT_NE(text.find(sign), std::string::npos) << sign << file;
    for (const char *spelt : {">= ", "&gt;= ", "<= ", "&lt;= ", "0.85-0.95", "-0.", "-1."})
      EXPECT_EQ(text.find(spelt), std::string::npos) << spelt << file;
  }
}

// What changed between two experiments is another question: its answers are in a block of their own.
TEST(Scores, InterventionsAreScoredByThemselves) {
  std::vector<ScoredCase> cases = round_by_hand();
  const auto before = metrics_of(cases);
  const auto add = [&](const char *truth, const char *claim, const char *first) {
    cases.push_back(scored("intervention", int(cases.size()), truth, claim, {{first, 0.9}}));
    cases.back().set95 = {first};
  };
  add("friction", "friction", "friction");
  cases.back().covered_amplitude = {true};
  add("friction", "undecided", "friction");
  cases.back().covered_amplitude = {false};
  add("friction", "pre_cracks", "pre_cracks");
  add("unknown", "unknown", "unknown");
  add("none", "none", "none");
  add("none", "friction", "friction");
  const auto after = metrics_of(cases);
  ASSERT_GT(after.size(), before.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_EQ(after[k].name, before[k].name);
    EXPECT_EQ(after[k].cases, before[k].cases) << before[k].name;
  }
  EXPECT_DOUBLE_EQ(named(after, "intervention: the most probable").value, 4.0 / 6.0);
  EXPECT_DOUBLE_EQ(named(after, "intervention: claimed right").value, 2.0 / 4.0);
  EXPECT_DOUBLE_EQ(named(after, "intervention: the 95 %").value, 4.0 / 6.0);
  EXPECT_DOUBLE_EQ(named(after, "intervention: wrong share").value, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(named(after, "intervention: a change claimed").value, 1.0 / 2.0);
  EXPECT_DOUBLE_EQ(named(after, "intervention: 90 % intervals").value, 1.0 / 2.0);
  EXPECT_EQ(confusion_of(cases)["friction (intervention)"]["pre_cracks"], 1);
}

// Two of three answers right is the gate of 0.6; chance gives as much from a half.
TEST(Scores, AGateIsMetByItsBoundNotByItsValue) {
  std::vector<ScoredCase> cases;
  for (int k = 0; k < 200; ++k)
    cases.push_back(scored("single", k, "friction", "friction", {{"friction", 1.0}}));
  const auto top1 = [&] { return named(metrics_of(cases), "which, top-1, effects"); };
  EXPECT_EQ(top1().verdict, Metric::met);
  for (int k = 0; k < 28; ++k) // 0.86 +- 0.025, one-sided 90 % from 0.83
    cases[std::size_t(k)].probability = {{"none", 1.0}};
  EXPECT_EQ(top1().verdict, Metric::not_shown);
  EXPECT_NEAR(top1().least, 0.86 - 1.28 * std::sqrt(0.86 * 0.14 / 200), 0.01);
  for (int k = 28; k < 40; ++k)
    cases[std::size_t(k)].probability = {{"none", 1.0}};
  EXPECT_EQ(top1().verdict, Metric::missed);
}

TEST(Scores, WhatNoTableHasMayNotBeCalledNothingNorAnEffect) {
  std::vector<ScoredCase> cases;
  for (const char *claim : {"unknown", "undecided", "none", "friction"}) {
    cases.push_back(scored("open", int(cases.size()), "unknown", claim, {{"unknown", 1.0}}));
    cases.back().paired = true;
  }
  cases.push_back(scored("open", 9, "unknown", "none", {{"none", 1.0}}));
  cases.back().paired = true;
  cases.back().signal_to_noise = 2.0; // too weak to count
  const std::vector<Metric> m = metrics_of(cases);
  EXPECT_DOUBLE_EQ(named(m, "no effect of the table, signal-to-noise ≥ 3: unknown").value, 0.5);
  EXPECT_DOUBLE_EQ(named(m, "no effect of the table, signal-to-noise ≥ 3: nothing").value, 0.25);
}

// 20 draws of one packing say no more about packings than one does.
TEST(Scores, IntervalsCountPackingsNotDraws) {
  const auto all = [](const ScoredCase &) { return true; };
  const auto wrong = [](const ScoredCase &c) { return c.claim != "none"; };
  std::vector<ScoredCase> cases;
  for (int k = 0; k < 40; ++k)
    cases.push_back(scored("null", k / 20, "none", "none", {{"none", 1.0}}));
  EXPECT_NEAR(share_of("", cases, all, wrong).high, 1.0 - std::sqrt(0.05), 1e-9);
  for (int k = 0; k < 20; ++k)
    cases[k].claim = "friction";
  const Metric half = share_of("", cases, all, wrong);
  EXPECT_DOUBLE_EQ(half.value, 0.5);
  EXPECT_EQ(half.low, 0.0);
  EXPECT_EQ(half.high, 1.0);
}

TEST(Scores, AnEffectLeftOutIsACaseOfItsOwnWhereItWasTheTruth) {
  const nlohmann::json gap = {
      {"where", {{{"significant", true}, {"condition", "a"}, {"stage", "b"}, {"observable", "c"}}}},
      {"which",
       {{"claim", "friction"},
        {"probability", {{"friction", 0.9}}},
        {"beside", {{{"effect", "pre_cracks"}, {"probability", 0.2}}}},
        {"set95", {"friction"}}}},
      {"parameters",
       {{{"parameter", "E"}, {"low90", 1.0}, {"high90", 2.0}, {"low95", 1.6}, {"high95", 2.0}}}},
      {"fitted_effects", {{{"effect", "friction"}, {"low90", 0.1}, {"high90", 0.2}}}},
      {"confounding", {{"detection_limit", {{{"effect", "friction"}, {"against_none", 0.1}}}}}}};
  nlohmann::json truth = {{"id", "001"},
                          {"block", "single"},
                          {"point", 7},
                          {"answer", "friction"},
                          {"effects", {{"friction", 0.301}}},
                          {"parameters", {{"E", 1.5}}}};
  nlohmann::json without = gap;
  without["without"] = "friction";
  const nlohmann::json baselines = {{"named", {{"BIC", "none"}}}};
  std::vector<ScoredCase> cases;
  const nlohmann::json shrink = {
      {"shrinkage", {{"value", 0.8}, {"low90", 0.5}, {"high90", nullptr}, {"predicted", 0.7}}},
      {"placebo", 0.1}};
  add_cases(truth, gap, without, baselines, shrink, cases);
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[0].shrinkage, 0.8);
  EXPECT_EQ(cases[0].predicted_shrinkage, 0.7);
  EXPECT_EQ(cases[0].placebo_shrinkage, 0.1);
  EXPECT_TRUE(std::isnan(cases[0].most_shrinkage) && std::isnan(cases[1].shrinkage));
  EXPECT_EQ(cases[1].block, "left_out");
  EXPECT_EQ(cases[1].truth, "unknown");
  EXPECT_EQ(cases[0].covered, std::vector<bool>{true});
  EXPECT_EQ(cases[0].covered_by_average, std::vector<bool>{false});
  EXPECT_EQ(cases[0].beside, std::set<std::string>{"pre_cracks"});
  EXPECT_EQ(cases[0].places, std::set<std::string>{"a|b|c"});
  EXPECT_EQ(cases[0].covered_amplitude, std::vector<bool>{false}); // 0.3 is not in 0.1 to 0.2
  EXPECT_NEAR(cases[0].signal_to_noise, 3.0 * std::sqrt(6.0), 1e-9);
  without["without"] = "pre_cracks";
  cases.clear();
  add_cases(truth, gap, without, baselines, nlohmann::json::object(), cases);
  EXPECT_EQ(cases.size(), 1u);
  EXPECT_TRUE(std::isnan(cases[0].predicted_shrinkage));
}

TEST(ProbabilityScores, ByHand) {
  const std::vector<std::vector<double>> p{{0.8, 0.2}, {0.4, 0.6}};
  EXPECT_NEAR(log_score(p, {0, 0}), -0.5 * (std::log(0.8) + std::log(0.4)), 1e-15);
  EXPECT_NEAR(log_score({{1.0, 0.0}}, {1}, 1e-3), std::log(1e3), 1e-12);
  EXPECT_NEAR(brier_score(p, {0, 1}), 0.5 * (2 * 0.04 + 2 * 0.16), 1e-15);
  EXPECT_NEAR(brier_skill(p, {0, 1}, {0.5, 0.5}), 1.0 - 0.2 / 0.5, 1e-15);
}

// Values of the exact interval in closed form: for 0 of n the upper end is 1 - tail^(1/n).
TEST(ClopperPearson, ClosedForms) {
  const auto none = clopper_pearson(0, 20, 0.9);
  EXPECT_EQ(none.first, 0.0);
  EXPECT_NEAR(none.second, 1.0 - std::pow(0.05, 1.0 / 20.0), 1e-12);
  const auto all = clopper_pearson(20, 20, 0.9);
  EXPECT_NEAR(all.first, std::pow(0.05, 1.0 / 20.0), 1e-12);
  EXPECT_EQ(all.second, 1.0);
}

} // namespace
