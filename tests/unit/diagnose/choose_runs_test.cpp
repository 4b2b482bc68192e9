// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "diagnose/choose_runs.h"
#include "support/made_bank.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace {

using namespace calendem;
using namespace calendem_test;

constexpr double kCells = 1e6;

TEST(ChooseRuns, AreBesideBasePointsAtWhichTheEffectWasNotRun) {
  const BankTable table = made_bank();
  const Experiment experiment = made_experiment({"friction", 0, 99, {1.5, 250.0}, 0.3});
  const RunChoice choice = choose_runs(experiment, table, kCells, 5);
  ASSERT_EQ(choice.chosen.size(), 5u);
  std::set<int> beside;
  for (const ChosenRun &c : choice.chosen) {
    EXPECT_EQ(c.effect, "friction"); // the other one is an instrument: it needs no runs
    EXPECT_TRUE(c.base_point >= 12 && c.base_point < 24) << c.base_point;
    EXPECT_TRUE(beside.insert(c.base_point).second);
    EXPECT_TRUE(c.value > 0.05 && c.value < 0.6) << c.value;
  }
  ASSERT_EQ(choice.effects.size(), 1u);
  EXPECT_EQ(choice.effects[0].points, 12);
  EXPECT_EQ(choice.effects[0].chosen, 5);
  EXPECT_GT(choice.effects[0].gain, choice.effects[0].evenly);
  EXPECT_GT(choice.effects[0].evenly, 0.0);
  EXPECT_EQ(choose_runs(experiment, table, kCells, 99).chosen.size(), 12u); // all that are left
}

void expect_refused(const BankTable &table, const std::string &part) {
  try {
    choose_runs(made_experiment({"friction", 0, 99, {1.5, 250.0}, 0.3}), table, kCells, 5);
    FAIL() << part;
  } catch (const Failure &e) {
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

// Chosen points are not pressed in another way: such a condition is left out. Points beside base
// points that lack a run, or are beyond the design, would not be learnt from.
TEST(ChooseRuns, AreOfUseToTheDiagnosis) {
  BankTable table = made_bank();
  Experiment experiment = made_experiment({"friction", 0, 99, {1.5, 250.0}, 0.3});
  experiment.conditions.push_back(experiment.conditions[0]);
  experiment.conditions.back().id = "again";
  experiment.conditions.back().pressing = "again";
  table.spec.pressings = {{"again", "pressed twice", {{"platen.presses", "2"}}, {30.0}, 24, 12}};
  for (const PressedPoint &p : bank_runs(table.spec))
    if (!p.name.empty()) {
      table.rows.push_back({p.point, made_run(p.point, 30.0)});
      table.rows.back().run.pressing = p.name;
    }
  table.rows.erase(std::find_if(table.rows.begin(), table.rows.end(), [](const BankRow &row) {
    return row.point.base_point == 20 && row.run.target == 60.0;
  }));
  table.spec.base_points = 23;
  const RunChoice choice = choose_runs(experiment, table, kCells, 99);
  std::set<int> beside;
  for (const ChosenRun &c : choice.chosen)
    beside.insert(c.base_point);
  EXPECT_EQ(beside, (std::set<int>{12, 13, 14, 15, 16, 17, 18, 19, 21, 22}));
  EXPECT_EQ(std::count(choice.not_said.begin(), choice.not_said.end(),
                       "again: chosen points are run in the usual way to 30, 60 MPa, which tells "
                       "nothing about it; left out."),
            1);
  EXPECT_EQ(std::set<std::string>(choice.not_said.begin(), choice.not_said.end()).size(),
            choice.not_said.size());
  experiment.conditions = {experiment.conditions.back()};
  try {
    choose_runs(experiment, table, kCells, 5);
    FAIL();
  } catch (const Failure &e) {
    EXPECT_NE(std::string(e.what()).find("no condition of the experiment"), std::string::npos);
  }
}

TEST(ChooseRuns, WantTheRunsOfThoseChosenBefore) {
  BankTable table = made_bank();
  table.spec.chosen = {{"friction", 15, 0.2}};
  expect_refused(table, "friction beside base point 15 has no runs in the table yet");
  for (const BankPoint &point : bank_points(table.spec))
    if (point.base_point == 15 && !point.effect.empty())
      for (const double target : table.spec.pressures)
        table.rows.push_back({point, made_run(point, target)});
  const Experiment experiment = made_experiment({"friction", 0, 99, {1.5, 250.0}, 0.3});
  for (const ChosenRun &c : choose_runs(experiment, table, kCells, 99).chosen)
    EXPECT_NE(c.base_point, 15);
}

TEST(ChooseRuns, NoneAreLeft) {
  BankTable table = made_bank();
  table.spec.effect_points = table.spec.base_points;
  expect_refused(table, "Raise base_points");
  table = made_bank();
  table.spec.effects = {"thickness_zero"};
  table.rows.erase(std::remove_if(table.rows.begin(), table.rows.end(),
                                  [](const BankRow &row) { return !row.point.effect.empty(); }),
                   table.rows.end());
  expect_refused(table, "no effect is simulated");
}

} // namespace
