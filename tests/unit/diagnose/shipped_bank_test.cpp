// SPDX-License-Identifier: GPL-2.0-or-later
// What the shipped bank can distinguish.
#include "base/provenance.h"
#include "diagnose/diagnose.h"
#include "diagnose/inference/emulators.h"
#include "diagnose/inference/hypothesis.h"
#include "diagnose/inference/which.h"
#include "support/test_folder.h"
#include "support/with_all.h"
#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <tuple>

namespace {

using namespace calendem;

constexpr double kPressureError = 0.01, kDisplacementError = 0.02, kThicknessError = 0.05;

bool is_pressed(const SimulatedRun &r) {
  return r.pressing.empty() && (r.target == 80.0 || r.target == 150.0);
}

/// What a press would show of a base point's runs to 80 and 150 MPa, without error.
Experiment shown(const BankTable &bank, int base_point, const std::string &recipe) {
  Experiment e;
  const auto at = calendem_test::test_folder();
  e.recipe = read_recipe(recipe);
  for (const BankRow &row : bank.rows) {
    if (row.point.base_point != base_point || !row.point.effect.empty() || !is_pressed(row.run))
      continue;
    const SimulatedRun &r = row.run;
    Condition c;
    c.id = "p" + std::to_string(int(r.target));
    c.control = "pressure";
    c.max_pressure_MPa = Measured{r.target, kPressureError * r.target};
    c.porosity_after_percent = Measured{100.0 * r.porosity_after, 0.3};
    c.thickness_at_max_um = Measured{r.thickness_at_max, kThicknessError};
    c.thickness_after_um = Measured{r.thickness_after, kThicknessError};
    c.cracked_bodies_fraction = Measured{r.cracked_fraction, 0.03};
    c.curve = (at / (c.id + ".csv")).string();
    c.curve_sd_um = kDisplacementError;
    std::ofstream curve(c.curve);
    curve << "displacement_um,pressure_MPa,stage\n";
    for (std::size_t k = 0; k < r.pressure.size(); ++k)
      if (r.pressure[k] <= r.target)
        curve << r.displacement[k] << "," << r.pressure[k] << ",compression\n";
    for (std::size_t k = r.release_pressure.size(); k-- > 0;)
      curve << r.release_displacement[k] << "," << r.release_pressure[k] << ",relaxation\n";
    e.conditions.push_back(c);
  }
  return e;
}

struct Shipped {
  const std::string folder = std::string(CALENDEM_SOURCE_DIR) + "/input_scripts/cases/bank/";
  const BankSpec spec = read_bank_spec(folder + "bank.toml");
  const BankTable bank = read_bank_table(spec, folder + "bank.csv");
  const Experiment planned =
      read_experiment(folder + "planned.toml"); ///< that points were chosen for
};

// The square of what 96 base points, their packings unseen, lie off the emulator in its own
// covariance, at the parameters they were run with. Expected per feature: nu / (nu - 2) of a t
// distribution, less the measurement's share of the covariance, for they are shown without error.
// Its standard deviation, of 20 features and 96 points whose packings are 16:
// sqrt(2 / 20 / 96) = 0.03 if all were independent, sqrt(2 / 20 / 16) = 0.08 if packings were
// alike.
TEST(ShippedBank, PackingsLeftOutLieAsFarOffAsExpected) {
  const std::string folder = std::string(CALENDEM_SOURCE_DIR) + "/input_scripts/cases/bank/";
  const BankSpec spec = read_bank_spec(folder + "bank.toml");
  BankTable bank = read_bank_table(spec, folder + "bank.csv");
  bank = without_effects(bank, bank.spec.effects);
  double squares = 0.0, features = 0.0, expected = 0.0;
  for (int packing = 1; packing <= spec.packings; ++packing) {
    BankTable others = bank;
    others.rows.erase(std::remove_if(others.rows.begin(), others.rows.end(),
                                     [&](const auto &r) { return r.point.packing == packing; }),
                      others.rows.end());
    SharedModels models;
    for (const BankRow &row : bank.rows) {
      if (row.point.packing != packing || !row.point.effect.empty() || row.run.target != 80.0 ||
          !row.run.pressing.empty())
        continue;
      const ExperimentData data =
          data_of(shown(bank, row.point.base_point, spec.recipe_file), others, {});
      inference::ModelSettings one_cell;
      one_cell.packings_in_sample = 1.0;
      const inference::Problem p = models.of(data, one_cell)->problem(data.experiment.values);
      inference::Vector scores(Eigen::Index(row.point.base.size()));
      for (Eigen::Index j = 0; j < scores.size(); ++j)
        scores[j] = data.bank.base[std::size_t(j)].prior.score(row.point.base[std::size_t(j)]);
      const inference::Matrix no_unknown;
      const inference::Matrix all = inference::covariance_about(p, p.predict(scores, {}));
      const double without_error = inference::Cholesky(all).solve(all - p.measurement).trace();
      inference::Vector gradient;
      squares += inference::Likelihood(p, {}, no_unknown).square(scores, gradient);
      features += double(p.observed.size());
      expected += without_error * p.degrees_of_freedom / (p.degrees_of_freedom - 2.0);
    }
  }
  ASSERT_GT(features, 96.0 * 17.0);
  RecordProperty("mean_square", std::to_string(squares / features));
  RecordProperty("expected", std::to_string(expected / features));
  EXPECT_NEAR(squares / features, expected / features, 3.0 * 0.08);
}

// Copies without error of each effect at twice its detection limit, for the laboratory that the
// bank's points were chosen for: named. The base model's own copy is none.
TEST(ShippedBank, EffectsAtTwiceTheirDetectionLimitAreNamed) {
  const Shipped shipped;
  const BankTable &bank = shipped.bank;
  const Experiment &planned = shipped.planned;
  const ExperimentData data = data_of(planned, bank, {});
  inference::DiagnosisSettings settings;
  settings.model.packings_in_sample = cells_of(planned, shipped.spec);
  settings.model.specimens = data.specimens;
  const inference::Model model(data.bank, data.experiment, settings.model, {});
  const inference::Problem problem = model.problem(data.experiment.values);
  const inference::Vector middle = inference::Vector::Zero(Eigen::Index(data.bank.base.size()));
  const auto copy_of = [&](const std::vector<inference::Applied> &on) {
    const inference::Vector features = problem.predict(middle, on).mean;
    return model.map().observables_of(features.head(model.map().emulated()));
  };
  const inference::Diagnosis base = inference::diagnose(model, data.bank, copy_of({}), settings);
  EXPECT_EQ(base.which.claim, "none");
  const int every = calendem_test::with_all(1, 3);
  int visible = 0;
  for (std::size_t k = 0; k < data.bank.effects.size(); ++k) {
    const inference::DetectionLimit &limit = base.confounding.limits[k];
    const inference::Prior &prior = data.bank.effects[k].parameters[0].prior;
    ASSERT_EQ(limit.effect, data.bank.effects[k].name);
    RecordProperty(limit.effect, fmt::format("{:.3g} of {:.3g}", limit.amplitude, prior.upper()));
    if (!(2.0 * limit.amplitude <= prior.upper()))
      continue;
    if (visible++ % every != 0)
      continue;
    const inference::Vector score =
        inference::Vector::Constant(1, prior.score(2.0 * limit.amplitude));
    const inference::Which which =
        inference::which(model.problem(copy_of({{int(k), score}})), settings.which);
    EXPECT_EQ(which.judged[0].hypothesis.name, limit.effect);
    EXPECT_EQ(which.claim, limit.effect) << which.why;
  }
  EXPECT_EQ(visible, 6); // of 15
}

// A careful laboratory on large discs, whose packings hardly scatter: no emulator is off by more
// than its errors and has less than half of what can be learnt.
TEST(ShippedBank, HasRunsEnoughForAPlannedLaboratory) {
  const Shipped shipped;
  const BankTable &bank = shipped.bank;
  const Experiment &planned = shipped.planned;
  const ExperimentData data = data_of(planned, bank, {});
  inference::ModelSettings settings;
  settings.packings_in_sample = cells_of(planned, shipped.spec);
  EXPECT_GT(settings.packings_in_sample, 5e5);
  const inference::Model model(data.bank, data.experiment, settings, {});
  EXPECT_EQ(model.poor_effects(), std::vector<std::string>());
  for (const inference::EmulatorQuality &q : model.quality())
    RecordProperty(q.effect.empty() ? "base" : q.effect,
                   fmt::format("Q2 {:.2f}, own error {:.2f}", q.q2, q.error));
}

// The runs that were chosen, beside what the emulators said of them before they were made: squares
// of what they are off by, in their stated variances, of all features of one cell. Their mean is 1;
// its standard deviation of 109 points sqrt(2 / 109) = 0.14, as if all features of one were one
// number.
TEST(ShippedBank, ChosenRunsScatterAsTheEmulatorsSaid) {
  const Shipped shipped;
  const BankTable &whole = shipped.bank;
  const auto is_chosen = [&](const BankPoint &p) {
    return std::any_of(
        shipped.spec.chosen.begin(), shipped.spec.chosen.end(),
        [&](const ChosenRun &c) { return c.effect == p.effect && c.base_point == p.base_point; });
  };
  BankTable before = whole;
  before.rows.erase(std::remove_if(before.rows.begin(), before.rows.end(),
                                   [&](const BankRow &row) { return is_chosen(row.point); }),
                    before.rows.end());
  const ExperimentData had = data_of(shipped.planned, before, {}),
                       has = data_of(shipped.planned, whole, {});
  const inference::Model model(had.bank, had.experiment, {});
  double squares = 0.0;
  int numbers = 0, points = 0;
  for (int e = 0; e < int(has.bank.effects.size()); ++e)
    for (const auto &[off, on] : pairs_of(has.bank, has.bank.effects[std::size_t(e)].name)) {
      const inference::BankRun &run = has.bank.runs[std::size_t(on)];
      const auto same = [&](const inference::BankRun &other) {
        return other.effect == run.effect && other.base == run.base &&
               other.packing == run.packing && other.amplitudes == run.amplitudes;
      };
      if (std::any_of(had.bank.runs.begin(), had.bank.runs.end(), same))
        continue;
      ++points;
      const inference::Vector difference =
          model.map().emulated_of(run.values) -
          model.map().emulated_of(has.bank.runs[std::size_t(off)].values);
      const inference::Asked asked =
          model.emulators().asked(e, {run.base}, {run.amplitudes}, {run.packing});
      for (Eigen::Index f = 0; f < difference.size(); ++f) {
        const inference::GaussianProcess &g = model.emulators().effect(e)[std::size_t(f)];
        const double left = difference[f] - g.at(asked.inputs.col(0), asked.amplitudes.col(0)).mean;
        squares += left * left / g.covariance(asked)(0, 0);
        ++numbers;
      }
    }
  EXPECT_EQ(points, 109); // one lacks a part of its release
  RecordProperty("mean_square", std::to_string(squares / numbers));
  EXPECT_NEAR(squares / numbers, 1.0, 3.0 * 0.14);
}

// All of its runs are of its design; missing are one to 20 MPa, and two of NMC plasticity, which did not
// reach 300 MPa.
TEST(ShippedBank, ItsTableIsWhatTheProgramWritesOfItsDesign) {
  const std::string folder = CALENDEM_SOURCE_DIR "/input_scripts/cases/bank/";
  const BankSpec spec = read_bank_spec(folder + "bank.toml");
  const BankTable bank = read_bank_table(spec, folder + "bank.csv");
  BankSpec alone = spec;
  alone.further_table = "";
  for (const std::string &file : {folder + "bank.csv", spec.further_table})
    EXPECT_EQ(write_bank_table(read_bank_table(alone, file)), text_of_file(file));
  using Run = std::tuple<std::string, std::string, std::string, int>;
  std::map<Run, BankPoint> designed;
  std::vector<PressedPoint> all = bank_runs(spec);
  for (const PressedPoint &of_full_cell : full_cell_runs(spec))
    all.push_back(of_full_cell);
  for (const PressedPoint &p : all)
    designed[{p.name, p.pressing.back().second, p.point.effect, p.point.base_point}] = p.point;
  for (const BankRow &row : bank.rows) {
    const auto at = designed.find({row.run.pressing, fmt::format("{}", row.run.target),
                                   row.point.effect, row.point.base_point});
    ASSERT_TRUE(at != designed.end());
    EXPECT_EQ(row.point.base, at->second.base);
    EXPECT_EQ(row.point.packing, at->second.packing);
    EXPECT_EQ(row.point.value, at->second.value);
    designed.erase(at);
  }
  std::vector<std::string> missing;
  for (const auto &[run, point] : designed)
    missing.push_back(std::get<2>(run) + std::get<1>(run));
  EXPECT_EQ(missing, (std::vector<std::string>{"20", "nmc_plasticity300", "nmc_plasticity300"}));
}

} // namespace
