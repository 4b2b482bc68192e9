// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/experiment_data.h"
#include "reported.h"
#include "support/made_bank.h"
#include "support/test_folder.h"
#include <fstream>
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using namespace calendem_test;

const BankPoint kTruth = {"", 0, 99, {1.5, 250.0}, 0.0};

/// One condition with its porosity only.
Experiment with_pressure(double pressure, double sd = 0.0) {
  Experiment e;
  set_film(e);
  Condition c;
  c.id = "one";
  c.control = "pressure";
  c.max_pressure_MPa = Measured{pressure, sd};
  c.porosity_after_percent = Measured{40.0, 0.5};
  e.conditions = {c};
  return e;
}

TEST(ExperimentData, PressureOfTheBankTakesItsRunAndOneBetweenIsInterpolated) {
  const BankTable table = made_bank();
  const auto porosity = [&](double pressure) {
    return data_of(with_pressure(pressure), table, {}).bank.runs[0].values[0];
  };
  const double low = 100.0 * table.rows[0].run.porosity_after;
  const double high = 100.0 * table.rows[1].run.porosity_after;
  EXPECT_EQ(porosity(30.0), low);
  EXPECT_EQ(porosity(29.5), low); // within 2 %
  EXPECT_EQ(porosity(60.0), high);
  EXPECT_NEAR(porosity(40.0), low + (high - low) * std::log(4.0 / 3.0) / std::log(2.0), 1e-12);
}

TEST(ExperimentData, ConditionsThatTheBankLacksAreReported) {
  Experiment e = made_experiment(kTruth);
  e.conditions[1].dwell_s = 5.0;
  e.conditions[1].labels_after = "after.mhd";
  Condition other = e.conditions[0];
  other.id = "p90";
  other.max_pressure_MPa = Measured{90.0, 0.0};
  e.conditions.push_back(other);
  other.id = "d";
  other.control = "displacement";
  other.max_pressure_MPa.reset();
  e.conditions.push_back(other);
  const ExperimentData data = data_of(e, made_bank(), {});
  EXPECT_EQ(data.experiment.of.size(), 6u);
  for (const char *part :
       {"p60: the bank's runs do not dwell; its 5 s", "p60: label images",
        "p90: 90 MPa lies outside the bank's 30 to 60 MPa", "d: control = \"displacement\""})
    EXPECT_TRUE(reported(data, part)) << part;
}

// A film at a pressure is one however the platen was told to go there; of a gap alone the bank says
// nothing.
TEST(ExperimentData, AFilmPressedToAGapIsThatAtItsPressure) {
  Experiment e = made_experiment(kTruth);
  e.conditions[0].max_pressure_MPa->sd = e.conditions[1].max_pressure_MPa->sd = 1.0;
  const ExperimentData by_pressure = data_of(e, made_bank(), {});
  for (Condition &c : e.conditions)
    c.control = "thickness";
  const ExperimentData by_gap = data_of(e, made_bank(), {});
  EXPECT_TRUE(reported(by_gap, "p60: it was pressed to a thickness"));
  EXPECT_FALSE(reported(by_pressure, "it was pressed to"));
  EXPECT_EQ(by_gap.experiment.values, by_pressure.experiment.values);
  EXPECT_EQ(by_gap.experiment.covariance, by_pressure.experiment.covariance);
  ASSERT_EQ(by_gap.bank.runs.size(), by_pressure.bank.runs.size());
  EXPECT_EQ(by_gap.bank.runs[0].values, by_pressure.bank.runs[0].values);
}

// As the bank's own run would show it, reported where the bank has none.
TEST(ExperimentData, TheReleaseOfACurveCountsWhereTheBankHasReleases) {
  Experiment e = made_experiment(kTruth);
  e.conditions.resize(1);
  const BankTable bank = made_bank(), with = with_release(made_bank());
  const SimulatedRun &run = with.rows[0].run;
  ASSERT_EQ(run.target, 30.0);
  e.conditions[0].curve = (calendem_test::test_folder() / "curve.csv").string();
  e.conditions[0].curve_sd_um = 0.02;
  std::ofstream curve(e.conditions[0].curve);
  curve << "displacement_um,pressure_MPa,stage\n";
  for (std::size_t k = 0; k < run.pressure.size(); ++k)
    curve << run.displacement[k] << ',' << run.pressure[k] << ",loading\n";
  for (std::size_t k = run.release_pressure.size(); k-- > 0;)
    curve << run.release_displacement[k] << ',' << run.release_pressure[k] << ",unloading\n";
  curve.close();
  const ExperimentData data = data_of(e, with, {});
  int released = 0;
  for (std::size_t k = 0; k < data.experiment.of.size(); ++k)
    if (data.experiment.of[k].stage == "relaxation" &&
        data.experiment.of[k].name != "total porosity") {
      ++released;
      const auto at = Eigen::Index(k);
      EXPECT_NEAR(data.experiment.values[at], data.bank.runs[0].values[at],
                  1e-5); // the file's digits
    }
  EXPECT_EQ(released, 3);
  EXPECT_FALSE(reported(data, "unloading curve"));
  const ExperimentData without = data_of(e, bank, {});
  EXPECT_EQ(without.experiment.of.size(), data.experiment.of.size() - 3);
  EXPECT_TRUE(reported(without, "p30: the bank's table has no displacements on release"));
}

// A press that runs 4 % past the pressure asked for, and one whose last row is noted before it, show
// what one that stops there shows.
TEST(ExperimentData, ACurveIsReadAtSharesOfThePressureAskedFor) {
  const BankTable bank = made_bank();
  const SimulatedRun &run = bank.rows[0].run;
  const auto with_curve = [&](double beyond) {
    Experiment e = made_experiment(kTruth);
    e.conditions.resize(1);
    e.conditions[0].curve = (calendem_test::test_folder() / "curve.csv").string();
    e.conditions[0].curve_sd_um = 0.02;
    std::ofstream curve(e.conditions[0].curve);
    curve << "displacement_um,pressure_MPa\n";
    for (std::size_t k = 0; k + (beyond < 0.0) < run.pressure.size(); ++k)
      curve << run.displacement[k] << ',' << run.pressure[k] << '\n';
    if (beyond > 0.0)
      curve << run.displacement.back() + 0.1 << ',' << run.pressure.back() + beyond << '\n';
    curve.close();
    return data_of(e, bank, {});
  };
  const ExperimentData stops = with_curve(0.0);
  for (const double beyond : {1.2, -1.0}) {
    const ExperimentData ends = with_curve(beyond);
    ASSERT_EQ(ends.experiment.of.size(), stops.experiment.of.size());
    for (Eigen::Index k = 0; k < stops.experiment.values.size(); ++k) {
      EXPECT_EQ(ends.labels[std::size_t(k)].pressure, stops.labels[std::size_t(k)].pressure);
      EXPECT_NEAR(ends.experiment.values[k], stops.experiment.values[k], 1e-9);
    }
  }
}

// One point of friction whose release ends early costs that point; a base point's costs the
// observable.
TEST(ExperimentData, AnEffectsPointThatLacksWhatOthersHaveIsLeftOut) {
  Experiment e = made_experiment(kTruth);
  BankTable bank = with_release(made_bank());
  const SimulatedRun run = bank.rows[0].run;
  e.conditions.resize(1);
  e.conditions[0].curve = (calendem_test::test_folder() / "curve.csv").string();
  e.conditions[0].curve_sd_um = 0.02;
  std::ofstream curve(e.conditions[0].curve);
  curve << "displacement_um,pressure_MPa,stage\n" << run.displacement.back() << ",30,loading\n";
  for (std::size_t k = run.release_pressure.size(); k-- > 0;)
    curve << run.release_displacement[k] << ',' << run.release_pressure[k] << ",unloading\n";
  curve.close();
  const auto of_friction = [](const ExperimentData &data) {
    return std::count_if(data.bank.runs.begin(), data.bank.runs.end(),
                         [](const inference::BankRun &r) { return r.effect == "friction"; });
  };
  const ExperimentData whole = data_of(e, bank, {});
  const auto cut = [&](const std::string &effect) {
    BankTable with = bank;
    const auto row = std::find_if(with.rows.begin(), with.rows.end(), [&](const BankRow &r) {
      return r.point.effect == effect && r.run.target == 30.0;
    });
    row->run.release_pressure.resize(2);
    row->run.release_displacement.resize(2);
    return data_of(e, with, {});
  };
  const ExperimentData without_one = cut("friction"), without_base = cut("");
  EXPECT_EQ(without_one.experiment.of.size(), whole.experiment.of.size());
  EXPECT_EQ(of_friction(without_one), of_friction(whole) - 1);
  EXPECT_TRUE(reported(without_one, "1 of the bank's 36 points lack what nearly all others have"));
  EXPECT_LT(without_base.experiment.of.size(), whole.experiment.of.size());
  EXPECT_EQ(of_friction(without_base), of_friction(whole));
}

TEST(ExperimentData, OnlyTheConditionsThatAreWanted) {
  const ExperimentData data = data_of(made_experiment(kTruth), made_bank(), {"p60"});
  for (const inference::ObservableId &o : data.experiment.of)
    EXPECT_EQ(o.condition, "p60");
}

TEST(ExperimentData, PointsThatLackARunAreLeftOutWithTheirEffect) {
  BankTable table = made_bank();
  const std::size_t whole = data_of(made_experiment(kTruth), table, {}).bank.runs.size();
  table.rows.erase(table.rows.begin()); // base point 0 to 30 MPa; friction stands beside it
  const ExperimentData data = data_of(made_experiment(kTruth), table, {});
  EXPECT_TRUE(reported(data, "2 of the bank's 36 points lack a run"));
  EXPECT_EQ(data.bank.runs.size(), whole - 3); // base, friction, and what thickness_zero made of it
}

// The press's error is common to all: covariance = sd^2 on the diagonal + slope slope^T sd_P^2.
TEST(ExperimentData, PressureErrorIsCommonToAllObservables) {
  const BankTable table = made_bank();
  Experiment e = made_experiment(kTruth);
  e.conditions.resize(1);
  e.conditions[0].cracked_bodies_fraction.reset();
  e.conditions[0].max_pressure_MPa->sd = 3.0;
  const ExperimentData data = data_of(e, table, {});
  double porosity = 0.0, thickness = 0.0, n = 0.0;
  for (const BankRow &row : table.rows)
    if (row.point.effect.empty() && row.run.target == 30.0) {
      const SimulatedRun &r = row.run;
      porosity += 100.0 * r.porosity_slope;
      thickness += r.porosity_slope * r.thickness_at_max / (1.0 - r.porosity_at_max);
      n += 1.0;
    }
  const double s0 = 3.0 * porosity / n, s1 = 3.0 * thickness / n;
  ASSERT_EQ(data.experiment.of.size(), 2u);
  EXPECT_NEAR(data.experiment.covariance(0, 1), s0 * s1, 1e-12);
  EXPECT_NEAR(data.experiment.covariance(0, 0), 0.1 * 0.1 + s0 * s0, 1e-12);
  EXPECT_NEAR(data.experiment.covariance(1, 1), 0.03 * 0.03 + s1 * s1, 1e-12);
}

TEST(ExperimentData, InstrumentsAreAppliedToTheRunsOfTheBaseModel) {
  const BankTable table = made_bank();
  const ExperimentData data = data_of(made_experiment(kTruth), table, {});
  std::size_t shown = 0;
  for (const inference::BankRun &run : data.bank.runs)
    if (run.effect == "thickness_zero") {
      const SimulatedRun &base = table.rows[2 * shown].run; // 30 MPa
      const double after = base.thickness_after + run.amplitudes[0];
      EXPECT_NEAR(run.values[0], 100.0 * (1.0 - kSolidColumn / after), 1e-9);
      EXPECT_NEAR(run.values[1], base.thickness_at_max + run.amplitudes[0], 1e-9);
      ++shown;
    }
  EXPECT_EQ(shown, 24u);
}

TEST(ExperimentData, AnEffectOfFewPointsIsLeftOutAndReported) {
  BankTable table = made_bank();
  int points = 0;
  const auto beyond_four = [&](const BankRow &row) {
    return row.point.effect == "friction" && row.run.target == 30.0 && ++points > 4;
  };
  table.rows.erase(std::remove_if(table.rows.begin(), table.rows.end(), beyond_four),
                   table.rows.end());
  const ExperimentData data = data_of(made_experiment(kTruth), table, {});
  EXPECT_TRUE(reported(data, "4 points of friction, fewer than the 5"));
  ASSERT_EQ(data.bank.effects.size(), 1u);
  for (const inference::BankRun &run : data.bank.runs)
    EXPECT_NE(run.effect, "friction");
}

// The error of a condition's loading is common to all of it, and to no other condition.
TEST(ExperimentData, LoadingErrorIsCommonToACondition) {
  Experiment e = made_experiment(kTruth);
  for (Condition &c : e.conditions) {
    c.max_pressure_MPa->sd = 0.0;
    c.cracked_bodies_fraction.reset();
    c.porosity_after_percent.reset();
    c.thickness_after_um = Measured{40.0, 0.1};
    c.loading_mg_cm2 = Measured{e.recipe.loading, 0.02 * e.recipe.loading};
  }
  const ExperimentData data = data_of(e, made_bank(), {});
  ASSERT_EQ(data.experiment.of.size(), 4u);
  const auto &v = data.experiment.values;
  const auto &s = data.experiment.covariance;
  EXPECT_NEAR(s(0, 1), 4e-4 * v[0] * v[1], 1e-12);
  EXPECT_GT(s(0, 0), 4e-4 * v[0] * v[0]); // its own error beside
  EXPECT_EQ(s(0, 2), 0.0);
}

// Micrometres of one film do not apply to another: without a loading the recipe's is taken, and
// reported.
TEST(ExperimentData, AnotherFilmIsComparedOverItsSolid) {
  Experiment e = made_experiment(kTruth);
  e.recipe.loading *= 2.0;
  const ExperimentData data = data_of(e, made_bank(), {});
  EXPECT_TRUE(reported(data, "its mass or loading is not given; taken is the recipe's"));
  bool over_solid = false;
  for (const inference::ObservableId &o : data.experiment.of) {
    EXPECT_NE(o.name, "thickness");
    over_solid |= o.name == "thickness over solid thickness";
  }
  EXPECT_TRUE(over_solid);
}

// A bank's narrower range is the prior of what it learnt there.
TEST(ExperimentData, ABanksRangeIsThePrior) {
  BankTable table = made_bank();
  const auto highest = [&table](const char *name) {
    for (const inference::ModelledEffect &e :
         data_of(made_experiment(kTruth), table, {}).bank.effects)
      if (e.name == name)
        return e.parameters[0].prior.value(8.0); // a score of 8: the end of the range
    return std::nan("");
  };
  EXPECT_NEAR(highest("friction"), 0.599, 1e-9);
  table.spec.ranges["friction"] = {0.05, 0.4};
  EXPECT_NEAR(highest("friction"), 0.399, 1e-9);
}

TEST(ExperimentData, MicrometresCountLessInAThickerFilm) {
  const BankTable table = made_bank();
  Experiment thick = made_experiment(kTruth);
  thick.recipe.loading *= 3.0;
  std::size_t shown = 0;
  for (const inference::BankRun &run : data_of(thick, table, {}).bank.runs)
    if (run.effect == "thickness_zero") {
      const double after = table.rows[2 * shown].run.thickness_after + run.amplitudes[0] / 3.0;
      EXPECT_NEAR(run.values[0], 100.0 * (1.0 - kSolidColumn / after), 1e-9);
      ++shown;
    }
  EXPECT_EQ(shown, 24u);
}

// Loadings within the bank are the sample's, not those of another film.
TEST(ExperimentData, MicrometresCountAlikeWhateverLoadingARunHas) {
  BankTable table = made_bank();
  for (BankRow &row : table.rows)
    row.run.solid_column *= row.point.base_point % 2 ? 1.05 : 0.95;
  const auto runs = data_of(made_experiment(kTruth), table, {}).bank.runs;
  int shown = 0;
  for (const inference::BankRun &run : runs)
    if (run.effect == "thickness_zero")
      EXPECT_NEAR(run.values[1] - runs[std::size_t(shown++)].values[1], run.amplitudes[0], 1e-9);
  EXPECT_EQ(shown, 24);
}

TEST(ExperimentData, WhatHappensAtTheFacesCountsLessInAThickerFilm) {
  BankTable table = made_bank();
  table.spec.effects = {"collector_indentation"};
  for (BankRow &row : table.rows)
    if (!row.point.effect.empty())
      row.point.effect = "collector_indentation";
  Experiment thick = made_experiment(kTruth);
  const auto own = data_of(thick, table, {}).bank.runs;
  thick.recipe.loading *= 3.0;
  const auto thin = data_of(thick, table, {}).bank.runs;
  ASSERT_EQ(own.size(), 36u);
  for (int k = 0; k < 12; ++k) { // 24 points of the base model, 12 of the effect beside the first
    EXPECT_NEAR(thin[24 + k].values[0] - thin[k].values[0],
                (own[24 + k].values[0] - own[k].values[0]) / 3.0, 1e-12);
    EXPECT_NE(own[24 + k].values[0], own[k].values[0]);
  }
}

TEST(ExperimentData, EffectsThatTheBankHasNoRunsOfAreReported) {
  const BankTable table = made_bank();
  const ExperimentData data = data_of(made_experiment(kTruth), table, {});
  const auto &own = table.spec.effects;
  int reported = 0;
  for (const std::string &text : data.not_said)
    if (text.rfind("Cannot be named", 0) == 0) {
      ++reported;
      for (const Effect &e : effects())
        EXPECT_EQ(text.find(e.name) == std::string::npos,
                  std::find(own.begin(), own.end(), e.name) != own.end())
            << e.name << " in: " << text;
    }
  EXPECT_EQ(reported, 1);
}

TEST(ExperimentData, NumbersHaveUnitAndPressure) {
  const ExperimentData data = data_of(made_experiment(kTruth), made_bank(), {});
  ASSERT_EQ(data.labels.size(), data.experiment.of.size());
  EXPECT_EQ(data.labels[0].name, "total porosity");
  EXPECT_EQ(data.labels[0].unit, "%");
  EXPECT_EQ(data.labels.back().pressure, 60.0);
}

TEST(ExperimentData, NothingToCompareIsBadInput) {
  try {
    data_of(with_pressure(90.0), made_bank(), {});
    FAIL();
  } catch (const Failure &f) {
    EXPECT_EQ(f.exit_status(), kBadInput);
    EXPECT_NE(std::string(f.what()).find("max_pressure_MPa within the bank's"), std::string::npos);
  }
}

} // namespace
