// SPDX-License-Identifier: GPL-2.0-or-later
// Films that were pressed in another way than the usual one, beside a bank that has such runs.
#include "base/messages.h"
#include "diagnose/diagnose.h"
#include "diagnose/experiment_data.h"
#include "reported.h"
#include "support/made_bank.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using namespace calendem_test;

const BankPoint kRubbed = {"friction", 0, 99, {1.5, 250.0}, 0.3};
constexpr double kPressure = 60.0; // MPa

/// Once more to the pressure: the film is denser; held there: friction loses some of it.
SimulatedRun pressed_so(const std::string &pressing, const BankPoint &point) {
  SimulatedRun run = made_run(point, kPressure);
  run.pressing = pressing;
  if (pressing == "again")
    run.porosity_after -= 0.02 / point.base[0];
  if (pressing == "dwell")
    run.pressure_left = 1.0 - 0.5 * (point.effect == "friction" ? point.value : 0.0);
  return run;
}

/// The made bank, with such runs of all base points and of the first eight of friction.
BankTable bank_with_pressings() {
  BankTable table = made_bank();
  table.spec.pressings = {
      {"again", "pressed twice", {{"platen.presses", "2"}}, {kPressure}, 24, 8},
      {"dwell", "held for 3 us", {{"platen.dwell_us", "3"}}, {kPressure}, 24, 8}};
  for (const PressedPoint &p : bank_runs(table.spec))
    if (!p.name.empty())
      table.rows.push_back({p.point, pressed_so(p.name, p.point)});
  return table;
}

/// A film at 60 MPa and another one pressed so, with porosities.
Experiment pressed_twice(const std::string &pressing) {
  Experiment e = made_experiment(kRubbed);
  e.conditions.erase(e.conditions.begin());
  e.conditions.push_back(e.conditions[0]);
  for (Condition &c : e.conditions) {
    c.specimen = c.id;
    c.cracked_bodies_fraction.reset();
    c.thickness_at_max_um.reset();
  }
  Condition &other = e.conditions[1];
  other.id = other.specimen = "other";
  other.pressing = pressing;
  other.porosity_after_percent->value = 100.0 * pressed_so(pressing, kRubbed).porosity_after;
  return e;
}

/// Base points differ in every parameter.
const BankPoint &point_of(const BankTable &table, const inference::BankRun &run) {
  return std::find_if(table.rows.begin(), table.rows.end(),
                      [&](const BankRow &row) {
                        return row.point.effect == run.effect && row.point.base[0] == run.base[0];
                      })
      ->point;
}

// A condition learns from the runs that were pressed as it was, the other one from the usual ones;
// points that lack either are left out. The films are two, not repeats of one.
TEST(Pressings, AConditionLearnsFromRunsPressedAsItWas) {
  const BankTable table = bank_with_pressings();
  const ExperimentData data = data_of(pressed_twice("again"), table, {});
  ASSERT_EQ(data.experiment.values.size(), 2);
  EXPECT_FALSE(reported(data, "pressed alike"));
  EXPECT_TRUE(reported(data, "4 of the bank's 36 points lack a run to 60 MPa or 60 MPa (again)"));
  int n = 0;
  for (const inference::BankRun &run : data.bank.runs) {
    if (run.effect == "thickness_zero")
      continue;
    const BankPoint &point = point_of(table, run);
    EXPECT_EQ(run.values[0], 100.0 * made_run(point, kPressure).porosity_after);
    EXPECT_EQ(run.values[1], 100.0 * pressed_so("again", point).porosity_after);
    ++n;
  }
  EXPECT_EQ(n, 24 + 8);
}

TEST(Pressings, WhatTheBankLacksIsReported) {
  const BankTable table = bank_with_pressings();
  EXPECT_TRUE(reported(data_of(pressed_twice("thrice"), table, {}),
                       "other: pressing = \"thrice\" is not in the bank, which has \"again\", "
                       "\"dwell\"; the condition is left out."));
  EXPECT_TRUE(reported(data_of(pressed_twice("again"), made_bank(), {}),
                       "is not in the bank, which has the usual one only"));
  Experiment e = pressed_twice("again");
  e.conditions[1].max_pressure_MPa->value = 30.0;
  EXPECT_TRUE(reported(data_of(e, table, {}),
                       "other: 30 MPa lies outside the bank's 60 to 60 MPa of \"again\""));
}

// A reading of a dwell needs runs that dwell, and is no porosity: specimens do not differ in it.
TEST(Pressings, PressureLeftNeedsRunsThatDwell) {
  const BankTable table = bank_with_pressings();
  Experiment e = pressed_twice("again");
  e.on_press = true;
  e.specimen_porosity_points = 3.0;
  e.conditions[1].pressure_left_percent = Measured{80.0, 0.5};
  EXPECT_TRUE(reported(data_of(e, table, {}), "other: pressure_left_percent is left out"));
  e.conditions[1].pressing = "dwell";
  e.conditions[1].dwell_s = 20.0;
  const ExperimentData data = data_of(e, table, {});
  EXPECT_FALSE(reported(data, "left out: the bank's runs"));
  EXPECT_FALSE(reported(data, "do not dwell"));
  EXPECT_TRUE(reported(data, "its dwell of 20 s is set beside the bank's (held for 3 us)"));
  ASSERT_EQ(data.experiment.of.size(), 3u);
  EXPECT_EQ(data.experiment.of[2].stage, "dwell");
  EXPECT_NEAR(data.experiment.covariance(2, 2), 0.25, 1e-12);
  for (const inference::BankRun &run : data.bank.runs)
    if (run.effect == "friction")
      EXPECT_EQ(run.values[2], 100.0 * pressed_so("dwell", point_of(table, run)).pressure_left);
    else
      EXPECT_EQ(run.values[2], 100.0);
}

// Two films that lose 13.5 and 16.5 % scatter by more than their readings, whatever specimens' porosities do.
TEST(Pressings, PressureLeftOfTwoFilmsScattersByItself) {
  Experiment e = pressed_twice("dwell");
  e.on_press = true;
  e.specimen_porosity_points = 3.0;
  e.conditions[1].pressure_left_percent = Measured{86.5, 0.5};
  e.conditions.push_back(e.conditions[1]);
  e.conditions[2].id = e.conditions[2].specimen = "third";
  e.conditions[2].pressure_left_percent->value = 83.5;
  const ExperimentData data = data_of(e, bank_with_pressings(), {});
  EXPECT_TRUE(reported(data, "other, third are 2 specimens pressed alike"));
  EXPECT_NEAR(data.experiment.values[2], 85.0, 1e-9);
  EXPECT_GT(data.experiment.covariance(2, 2), 0.5 * 0.5);
}

// The porosities alone leave open whether anything raised them; the pressure that a dwell leaves does
// not.
TEST(Pressings, ADwellShowsWhatPorositiesDoNot) {
  const BankTable table = bank_with_pressings();
  Experiment e = pressed_twice("dwell");
  SharedModels models;
  const auto none = [&] {
    return diagnosed(e, table, 100.0, models).gap["which"]["probability"]["none"].get<double>();
  };
  const double by_porosity = none();
  e.conditions[1].pressure_left_percent = Measured{85.0, 0.5};
  const double with_dwell = none();
  std::printf("nothing acts: %.3g, with the dwell's reading %.3g\n", by_porosity, with_dwell);
  EXPECT_GT(by_porosity, 0.1);
  EXPECT_LT(with_dwell, 0.001);
  EXPECT_EQ(diagnosed(e, table, 100.0, models).gap["which"]["set95"][0], "friction");
}

// A change is seen on films that are pressed alike.
TEST(Pressings, BeforeAndAfterAChangeAreTheSame) {
  const BankTable table = bank_with_pressings();
  try {
    diagnosed_change(pressed_twice("again"), pressed_twice("dwell"), table, 100.0);
    FAIL();
  } catch (const Failure &e) {
    EXPECT_NE(std::string(e.what()).find(
                  "condition \"other\" has pressing = \"again\" before and \"dwell\" after"),
              std::string::npos);
  }
}

// Both ways of pressing can be measured next, where the usual one was; a price of the same name is
// theirs.
TEST(Pressings, AreOfferedAsMeasurements) {
  BankTable table = bank_with_pressings();
  for (MeasurementPrice &price : table.spec.prices)
    if (price.name == "dwell")
      price.hours = 7.0;
  Experiment e = made_experiment(kRubbed);
  const auto offered = [&](const std::string &what) {
    const ExperimentData data = data_of(e, table, {});
    return std::count_if(data.next.begin(), data.next.end(), [&](const inference::Candidate &c) {
      return c.what == "porosity after release, by mass and thickness: " + what;
    });
  };
  EXPECT_EQ(offered("60 MPa, pressed twice"), 1);
  EXPECT_EQ(offered("60 MPa, held for 3 us"), 1);
  for (const inference::Candidate &c : data_of(e, table, {}).next)
    if (c.what.find("60 MPa, ") != std::string::npos)
      EXPECT_EQ(c.cost, c.what.find("held") != std::string::npos ? 7.0 : 3.0) << c.what;
  e.conditions.pop_back();
  EXPECT_EQ(offered("60 MPa, pressed twice"), 0);
  e = pressed_twice("again");
  EXPECT_EQ(offered("60 MPa, pressed twice"), 0);
}

} // namespace
