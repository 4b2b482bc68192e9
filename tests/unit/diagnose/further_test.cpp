// SPDX-License-Identifier: GPL-2.0-or-later
// Measurements that were not made: which there are, what they cost, how good they are.
#include "diagnose/experiment_data.h"
#include "support/made_bank.h"
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using namespace calendem_test;

const BankPoint kBaseFilm = {"", 0, 99, {1.5, 250.0}, 0.0};

const inference::Candidate *named(const ExperimentData &data, const std::string &what) {
  for (const inference::Candidate &c : data.next)
    if (c.what == what)
      return &c;
  return nullptr;
}

TEST(Further, WhatIsMeasuredIsNotAskedForAgain) {
  const ExperimentData data = data_of(made_experiment(kBaseFilm), made_bank(), {});
  ASSERT_EQ(data.next.size(), 1u);
  EXPECT_EQ(data.next[0].what, "displacement while the pressure rises: p30, p60");
  EXPECT_EQ(data.next[0].cost, 2.0); // an hour for each sample
  EXPECT_EQ(data.next[0].of.size(), 8u);
  for (const inference::BankRun &run : data.bank.runs)
    EXPECT_EQ(run.values.size(), 6 + 8);
}

TEST(Further, EveryConditionThatLacksAKindIsInIt) {
  Experiment e = made_experiment(kBaseFilm);
  e.conditions[1].cracked_bodies_fraction.reset();
  for (Condition &c : e.conditions)
    c.thickness_at_max_um.reset();
  const ExperimentData data = data_of(e, made_bank(), {});
  const auto *cracked = named(data, "share of cracked particles in a cross-section: p60");
  ASSERT_TRUE(cracked);
  EXPECT_EQ(cracked->cost, 8.0);
  EXPECT_NEAR(cracked->covariance(0, 0), 0.05 * 0.05, 1e-12);
  const auto *thickness = named(data, "thickness under the largest pressure: p30, p60");
  ASSERT_TRUE(thickness);
  EXPECT_EQ(thickness->of[1].condition, "p60");
  EXPECT_NEAR(thickness->covariance(0, 0), 1.0, 1e-12); // um
}

// Only a bank that has releases can predict them: at 25, 50 and 75 % of each pressure.
TEST(Further, ReleasesThatTheBankHasCanBeMeasured) {
  const std::string what = "displacement while the pressure falls: p30, p60";
  const BankTable bank = made_bank(), with = with_release(made_bank());
  EXPECT_FALSE(named(data_of(made_experiment(kBaseFilm), bank, {}), what));
  const ExperimentData data = data_of(made_experiment(kBaseFilm), with, {});
  const auto *release = named(data, what);
  ASSERT_TRUE(release);
  ASSERT_EQ(release->of.size(), 6u);
  EXPECT_EQ(release->of[0].stage, "relaxation");
  EXPECT_NEAR(release->covariance(0, 0), 0.5 * 0.5, 1e-12); // um
}

// The pressure of the others is known within 10 %, so its own is.
TEST(Further, OtherPressuresOfTheBankAreAsUncertainAsThoseMeasured) {
  Experiment e = made_experiment(kBaseFilm);
  e.conditions.resize(1);
  e.conditions[0].max_pressure_MPa->sd = 3.0;
  const BankTable table = made_bank();
  const ExperimentData data = data_of(e, table, {});
  const auto *porosity = named(data, "porosity after release, by mass and thickness: 60 MPa");
  ASSERT_TRUE(porosity);
  double slope = 0.0;
  for (const BankRow &row : table.rows)
    if (row.point.effect.empty() && row.run.target == 60.0)
      slope += 100.0 * row.run.porosity_slope / 24.0;
  EXPECT_NEAR(porosity->covariance(0, 0), 0.5 * 0.5 + std::pow(6.0 * slope, 2), 1e-12);
}

TEST(Further, PricesOfTheBankCount) {
  BankTable table = made_bank();
  for (MeasurementPrice &p : table.spec.prices)
    p.hours = 7.0, p.sd = 2.0;
  const ExperimentData data = data_of(made_experiment(kBaseFilm), table, {});
  EXPECT_EQ(data.next[0].cost, 14.0);
  EXPECT_NEAR(data.next[0].covariance(0, 0), 4.0, 1e-12);
}

} // namespace
