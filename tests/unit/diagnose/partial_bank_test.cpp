// SPDX-License-Identifier: GPL-2.0-or-later
// Banks of which some points were run to more pressures than others.
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

const BankPoint kWithFriction = {"friction", 0, 99, {1.5, 250.0}, 0.3};

/// The made bank, with runs of all base points and of some points of friction to one pressure more.
BankTable with_runs_to(double pressure, int of_friction) {
  BankTable table = made_bank();
  for (const BankPoint &point : bank_points(table.spec))
    if (point.effect.empty() || of_friction-- > 0)
      table.rows.push_back({point, made_run(point, pressure)});
  table.spec.pressures.push_back(pressure);
  std::sort(table.spec.pressures.begin(), table.spec.pressures.end());
  return table;
}

/// One condition, with its porosity.
Experiment at(double pressure) {
  Experiment e = made_experiment(kWithFriction);
  e.conditions.resize(1);
  Condition &c = e.conditions[0];
  c.id = "one";
  c.max_pressure_MPa = Measured{pressure, 0.0};
  c.porosity_after_percent =
      Measured{100.0 * made_run(kWithFriction, pressure).porosity_after, 0.5};
  c.cracked_bodies_fraction.reset();
  c.thickness_at_max_um.reset();
  return e;
}

int runs_of(const ExperimentData &data, const std::string &effect) {
  return int(std::count_if(data.bank.runs.begin(), data.bank.runs.end(),
                           [&](const inference::BankRun &r) { return r.effect == effect; }));
}

const inference::Candidate *offered(const ExperimentData &data, const std::string &what) {
  for (const inference::Candidate &c : data.next)
    if (c.what.find(what) != std::string::npos)
      return &c;
  return nullptr;
}

// All points at 30 and 60 MPa and between them; at 120 MPa, and between 60 and 120, those that went
// there: 24 of the base model and 6 of the 12 of friction.
TEST(PartialBank, APointCountsWhereItHasTheRunsThatAreNeeded) {
  const BankTable table = with_runs_to(120.0, 6);
  for (const double pressure : {30.0, 45.0, 60.0}) {
    const ExperimentData data = data_of(at(pressure), table, {});
    EXPECT_EQ(runs_of(data, "friction"), 12) << pressure;
    EXPECT_FALSE(reported(data, "lack a run")) << pressure;
  }
  for (const auto &[pressure, runs] :
       {std::pair(90.0, "60 MPa or 120 MPa"), std::pair(120.0, "120 MPa")}) {
    const ExperimentData data = data_of(at(pressure), table, {});
    EXPECT_EQ(runs_of(data, "friction"), 6) << pressure;
    EXPECT_EQ(runs_of(data, ""), 24) << pressure;
    EXPECT_TRUE(reported(data, std::string("6 of the bank's 36 points lack a run to ") + runs +
                                   ", or their base point does, and are left out."))
        << pressure;
  }
  EXPECT_EQ(data_of(at(120.0), table, {}).bank.runs[0].values[0],
            100.0 * made_run(bank_points(table.spec)[0], 120.0).porosity_after);
}

TEST(PartialBank, ABasePointThatLacksARunCostsItsEffectsPoint) {
  BankTable table = with_runs_to(120.0, 12);
  table.rows.erase(std::find_if(table.rows.begin(), table.rows.end(), [](const BankRow &r) {
    return r.point.effect.empty() && r.point.base_point == 0 && r.run.target == 120.0;
  }));
  const ExperimentData data = data_of(at(120.0), table, {});
  EXPECT_EQ(runs_of(data, ""), 23);
  EXPECT_EQ(runs_of(data, "friction"), 11);
  EXPECT_TRUE(reported(data, "2 of the bank's 36 points lack a run to 120 MPa"));
}

// Four points of friction at 45 MPa do not teach it: the condition is between 30 and 60 MPa, where
// twelve do, and 45 MPa is not offered as a measurement.
TEST(PartialBank, APressureThatAnEffectHasFewRunsToIsInterpolated) {
  const BankTable few = with_runs_to(45.0, 4), enough = with_runs_to(45.0, 5);
  const auto first = [&](const BankTable &t) { return data_of(at(45.0), t, {}).bank.runs[0]; };
  const BankPoint point = bank_points(few.spec)[0];
  EXPECT_EQ(runs_of(data_of(at(45.0), few, {}), "friction"), 12);
  EXPECT_EQ(first(few).values[0], data_of(at(45.0), made_bank(), {}).bank.runs[0].values[0]);
  EXPECT_EQ(runs_of(data_of(at(45.0), enough, {}), "friction"), 5);
  EXPECT_EQ(first(enough).values[0], 100.0 * made_run(point, 45.0).porosity_after);
  EXPECT_FALSE(offered(data_of(at(60.0), few, {}), ": 45 MPa"));
  EXPECT_TRUE(offered(data_of(at(60.0), enough, {}), ": 45 MPa"));
}

// What 30 and 60 MPa say does not depend on runs to 120 MPa: the same to the last digit, but for the
// measurement that these add to what could be done next.
TEST(PartialBank, MorePressuresChangeNothingButTheNextMeasurements) {
  const Experiment e = made_experiment(kWithFriction);
  SharedModels models;
  const BankTable wide = with_runs_to(120.0, 6);
  Diagnosed narrow = diagnosed(e, made_bank(), 100.0, models),
            more = diagnosed(e, wide, 100.0, models);
  EXPECT_EQ(more.diagnosis.next.size(), narrow.diagnosis.next.size() + 1);
  for (Diagnosed *d : {&narrow, &more})
    for (const char *of_next : {"next_measurement", "measurements"})
      d->gap["which"].erase(of_next);
  EXPECT_EQ(more.gap.dump(1), narrow.gap.dump(1));
  EXPECT_EQ(narrow.gap["which"]["claim"], "friction");
}

// Learnt from the points that went there. A sample of many cells knows it as well as it is measured,
// 0.5 points: that is the feature's unit. Three of the emulators' own standard deviations.
TEST(PartialBank, AFurtherPressureIsLearntFromThePointsThatWentThere) {
  const ExperimentData data = data_of(made_experiment(kWithFriction), with_runs_to(120.0, 6), {});
  const inference::Candidate *further = offered(data, ": 120 MPa");
  ASSERT_TRUE(further);
  inference::ModelSettings settings;
  settings.packings_in_sample = 1e9;
  const inference::Model model(data.bank, data.experiment, settings, {*further});
  const auto extensions = model.extensions(data.experiment.values);
  ASSERT_EQ(extensions.size(), 1u);
  const auto predicted = [&](const BankPoint &p) {
    inference::Vector scores(2);
    for (int j = 0; j < 2; ++j)
      scores[j] = data.bank.base[std::size_t(j)].prior.score(p.base[std::size_t(j)]);
    std::vector<inference::Applied> on;
    if (!p.effect.empty())
      on.push_back({0, inference::Vector::Constant(
                           1, data.bank.effects[0].parameters[0].prior.score(p.value))});
    const inference::Prediction all = extensions[0].extended.predict(scores, on);
    return std::pair(0.5 * all.mean.tail(1)[0], 0.25 * all.variance.tail(1)[0]);
  };
  const BankPoint stiff = {"", 0, 99, {1.2, 250.0}, 0.0};
  const auto [friction, its_variance] = predicted(kWithFriction);
  const auto [none, variance] = predicted(stiff);
  const double truth = 100.0 * (made_run(kWithFriction, 120.0).porosity_after -
                                made_run(stiff, 120.0).porosity_after);
  EXPECT_GT(truth, 4.0);
  EXPECT_NEAR(friction - none, truth, 3.0 * std::sqrt(its_variance + variance));
  EXPECT_LT(std::sqrt(its_variance + variance), 0.3);
}

// Where no next measurement is asked for, what runs lack of one is no mistake of the bank.
TEST(PartialBank, AModelNeedsWhatWasMeasuredOnly) {
  const ExperimentData data = data_of(made_experiment(kWithFriction), with_runs_to(120.0, 6), {});
  EXPECT_NO_THROW(inference::Model(data.bank, data.experiment, {}));
  const Diagnosed d =
      diagnosed_change(made_experiment({"", 0, 98, {1.5, 250.0}, 0.0}),
                       made_experiment(kWithFriction), with_runs_to(120.0, 6), 100.0);
  EXPECT_EQ(d.gap["which"]["claim"], "friction");
}

// 90 MPa lies between runs to 60 and 120: ln(1.5) ln(4/3) x 0.7 points; 60 MPa is a run's own.
TEST(PartialBank, InterpolationIsAnErrorOfItsOwn) {
  const BankTable table = with_runs_to(120.0, 6);
  const auto variance = [&](const Experiment &e) {
    return data_of(e, table, {}).experiment.covariance(0, 0);
  };
  const double by = 0.7 * std::log(1.5) * std::log(4.0 / 3.0);
  EXPECT_NEAR(variance(at(90.0)), 0.5 * 0.5 + by * by, 1e-12);
  EXPECT_NEAR(variance(at(60.0)), 0.5 * 0.5, 1e-12);
  Experiment cracked = at(90.0);
  cracked.conditions[0].porosity_after_percent.reset();
  cracked.conditions[0].cracked_bodies_fraction = Measured{0.5, 0.03};
  EXPECT_NEAR(variance(cracked), 0.03 * 0.03 + std::pow(0.12 / 0.7 * by, 2), 1e-12);
}

} // namespace
