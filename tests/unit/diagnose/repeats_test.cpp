// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/random.h"
#include "diagnose/error_model.h"
#include "diagnose/experiment_data.h"
#include "support/made_bank.h"
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using namespace calendem_test;

bool reported(const std::vector<std::string> &all, const std::string &part) {
  return std::any_of(all.begin(), all.end(),
                     [&](const std::string &s) { return s.find(part) != std::string::npos; });
}

// Four normal values: unbiased, and within 4 standard errors of 2000 draws. Weights cost a tenth of
// the values at most: their mean's variance is at most 1.1 / 4.
TEST(RobustMean, NormalValuesKeepTheirMean) {
  Random random(1, 1);
  double sum = 0.0, squares = 0.0, sd = 0.0;
  constexpr int n = 2000;
  for (int k = 0; k < n; ++k) {
    std::vector<double> v(4);
    for (double &x : v)
      x = random.normal();
    const RobustMean mean = robust_mean(v, 1.0);
    sum += mean.value / n;
    squares += mean.value * mean.value / n;
    sd += mean.sd / n;
  }
  EXPECT_NEAR(sum, 0.0, 4.0 * 0.5 / std::sqrt(n));
  EXPECT_LT(squares, 1.1 / 4.0 * (1.0 + 4.0 * std::sqrt(2.0 / n)));
  EXPECT_NEAR(sd, 1.0, 0.15);
}

// The more it stands out the less it moves the mean.
TEST(RobustMean, AnOutlierCountsLittle) {
  const RobustMean far = robust_mean({0.1, -0.1, 0.0, 40.0}, 0.1);
  EXPECT_NEAR(far.value, 0.0, 0.05);
  EXPECT_LT(far.weights[3], 0.1);
  EXPECT_GT(far.weights[0], 0.99);
  EXPECT_LT(far.sd, 0.5);
}

// Scatter beyond what is stated is believed by degrees: (4 s^2 + sum of squares) / (4 + n - 1) for
// values within one standard deviation.
TEST(RobustMean, TheScatterIsTheStatedOneAndTheValues) {
  EXPECT_NEAR(robust_mean({-1.0, 1.0}, 2.0).sd, std::sqrt((4.0 * 4.0 + 2.0) / 5.0), 1e-9);
  EXPECT_NEAR(robust_mean({3.0}, 2.0).sd, 2.0, 0.5);
  EXPECT_EQ(robust_mean({3.0}, 2.0).value, 3.0);
}

/// The two samples of made_experiment, each pressed four times on discs of their own.
Experiment four_of_each() {
  Experiment e = made_experiment({"", 0, 99, {1.5, 250.0}, 0.0});
  std::vector<Condition> all;
  for (const Condition &c : e.conditions)
    for (int k = 0; k < 4; ++k) {
      all.push_back(c);
      all.back().id = c.id + "abcd"[k];
      all.back().specimen = all.back().id;
      all.back().porosity_after_percent->value += 0.05 * (k % 2 ? 1.0 : -1.0);
    }
  e.conditions = all;
  return e;
}

TEST(PooledRepeats, SpecimensPressedAlikeAreOneConditionKnownBetter) {
  const BankTable bank = made_bank();
  Experiment e = four_of_each();
  const ExperimentData data = data_of(e, bank, {});
  const ExperimentData one = data_of(made_experiment({"", 0, 99, {1.5, 250.0}, 0.0}), bank, {});
  ASSERT_EQ(data.experiment.of.size(), one.experiment.of.size());
  EXPECT_EQ(data.experiment.of[0].condition, "p30a");
  EXPECT_NEAR(data.experiment.values[0], one.experiment.values[0], 1e-9);
  EXPECT_NEAR(data.experiment.covariance(0, 0), one.experiment.covariance(0, 0) / 4.0, 1e-9);
  EXPECT_TRUE(reported(data.not_said, "p30a, p30b, p30c, p30d are 4 specimens"));
  for (Condition &c : e.conditions)
    c.specimen = "one"; // pressed several times
  EXPECT_EQ(data_of(e, bank, {}).experiment.of.size(), 4 * one.experiment.of.size());
}

// Two discs, each read twice: two groups of two specimens, not three specimens and one left over.
TEST(PooledRepeats, ASpecimenReadTwiceIsNoFurtherSpecimen) {
  Experiment e = four_of_each();
  const char *const disc[] = {"A", "A", "B", "B"};
  for (std::size_t k = 0; k < e.conditions.size(); ++k)
    e.conditions[k].specimen = disc[k % 4];
  const ExperimentData data = data_of(e, made_bank(), {});
  EXPECT_TRUE(reported(data.not_said, "p30a, p30c are 2 specimens"));
  EXPECT_TRUE(reported(data.not_said, "p30b, p30d are 2 specimens"));
}

TEST(PooledRepeats, AReadingThatStandsOutIsReportedAndHardlyMovesTheMean) {
  Experiment e = four_of_each();
  const double right = e.conditions[0].porosity_after_percent->value;
  e.conditions[2].porosity_after_percent->value += 6.0;
  const ExperimentData data = data_of(e, made_bank(), {});
  EXPECT_NEAR(data.experiment.values[0], right, 0.3); // of the plain mean: 1.5
  EXPECT_TRUE(reported(data.not_said, "p30c: total porosity")) << data.not_said.size();
  EXPECT_TRUE(reported(data.not_said, "stands out"));
}

} // namespace
