// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/diagnose.h"
#include "diagnose/error_model.h"
#include "support/made_bank.h"
#include "support/test_folder.h"
#include <fstream>
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using namespace calendem_test;

/// One sample at 30 and one at 60 MPa, without an error of the pressure.
Experiment two_discs() {
  Experiment e = made_experiment({"", 0, 99, {1.5, 250.0}, 0.0});
  e.specimen_porosity_points = 0.5;
  for (Condition &c : e.conditions)
    c.specimen = c.id;
  return e;
}

// A specimen that ends 0.5 points more porous has 0.5 in its porosity, in both of its observables
// with one sign, and nothing in another specimen's.
TEST(ErrorTerms, ASpecimensPorosityIsCommonToItsConditionsOnly) {
  const BankTable bank = made_bank();
  Experiment e = two_discs();
  const auto apart = data_of(e, bank, {}).experiment;
  ASSERT_EQ(apart.of[0].name, "total porosity");
  ASSERT_EQ(apart.of[1].name, "thickness");
  EXPECT_NEAR(apart.covariance(0, 0), 0.1 * 0.1 + 0.5 * 0.5, 1e-9);
  EXPECT_GT(apart.covariance(0, 1), 0.0);
  EXPECT_EQ(apart.covariance(0, 3), 0.0);
  for (Condition &c : e.conditions)
    c.specimen = "disc";
  const auto shared = data_of(e, bank, {}).experiment;
  EXPECT_NEAR(shared.covariance(0, 3), 0.5 * 0.5, 1e-9);
}

// A film 2 % thicker, in micrometres only.
TEST(ErrorTerms, ASpecimensThicknessIsThatOfMicrometres) {
  Experiment e = two_discs();
  e.specimen_porosity_points = 0.0;
  e.specimen_thickness_percent = 2.0;
  const ExperimentData made = data_of(e, made_bank(), {});
  const auto &data = made.experiment;
  double usual = 0.0; // of the bank's base model, 24 points
  for (const inference::BankRun &run : made.bank.runs)
    usual += run.effect.empty() ? run.values[1] / 24.0 : 0.0;
  EXPECT_NEAR(data.covariance(0, 0), 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(data.covariance(1, 1), 0.03 * 0.03 + std::pow(0.02 * usual, 2), 1e-9);
}

// A press that notices the film 0.7 um late shows all of a curve 0.7 um short, and no other curve.
TEST(ErrorTerms, TheFirstTouchIsCommonToTheWholeCurve) {
  const auto folder = test_folder();
  Experiment e = two_discs();
  e.on_press = true;
  for (Condition &c : e.conditions) {
    c.curve = (folder / (c.id + ".csv")).string();
    c.curve_sd_um = 0.1;
    std::ofstream out(c.curve);
    out << "displacement_um,pressure_MPa,stage\n";
    for (int p = 1; p <= 30; ++p)
      out << 0.1 * p << "," << p << ",loading\n";
  }
  const auto remarks = [&] {
    const auto said = data_of(e, made_bank(), {}).not_said;
    return std::count_if(said.begin(), said.end(), [](const std::string &s) {
      return s.find("first touch counts as exactly known") != std::string::npos;
    });
  };
  EXPECT_EQ(remarks(), 2);
  const auto exact = data_of(e, made_bank(), {}).experiment;
  for (Condition &c : e.conditions)
    c.curve_zero_um = 0.7;
  EXPECT_EQ(remarks(), 0);
  const auto data = data_of(e, made_bank(), {}).experiment;
  const inference::Matrix more = data.covariance - exact.covariance;
  int points = 0;
  for (std::size_t i = 0; i < data.of.size(); ++i)
    for (std::size_t j = 0; j < data.of.size(); ++j) {
      const bool same_curve = data.of[i].name.rfind("displacement", 0) == 0 &&
                              data.of[j].name.rfind("displacement", 0) == 0 &&
                              data.of[i].condition == data.of[j].condition;
      points += same_curve;
      EXPECT_NEAR(more(Eigen::Index(i), Eigen::Index(j)), same_curve ? 0.7 * 0.7 : 0.0, 1e-9);
    }
  EXPECT_GT(points, 20);
}

TEST(ErrorTerms, NumericsAreCommonToAllThatAPressShowsAndNotToASimulation) {
  BankTable bank = made_bank();
  bank.spec.numerics = {{"speed", 1.0}, {"cell", 2.0}};
  Experiment e = two_discs();
  e.specimen_porosity_points = 0.0;
  EXPECT_NEAR(data_of(e, bank, {}).experiment.covariance(0, 3), 0.0, 1e-12);
  e.on_press = true;
  const ExperimentData data = data_of(e, bank, {});
  EXPECT_NEAR(data.experiment.covariance(0, 3), 1.0 + 4.0, 1e-9);
  ASSERT_EQ(data.terms.size(), 2u);
  EXPECT_EQ(data.terms[1].name, "numerics: cell");
  EXPECT_NEAR(data.terms[1].columns(0, 0), 2.0, 1e-9);
}

// Two specimens are two packings: what one cell scatters by is not shared, and less by the number
// of specimens.
TEST(ErrorTerms, PackingsOfSpecimensAreTheirOwn) {
  Experiment e = two_discs();
  const auto scatter = [&] {
    SharedModels models;
    const Diagnosed d = diagnosed(e, made_bank(), 1.0, models);
    const inference::Problem p = d.model->problem(d.data.experiment.values);
    double across = 0.0;
    for (Eigen::Index i = 0; i < p.scatter.rows(); ++i)
      for (Eigen::Index j = 0; j < i; ++j)
        if (p.blocks[std::size_t(p.features[std::size_t(i)].block)].condition !=
            p.blocks[std::size_t(p.features[std::size_t(j)].block)].condition)
          across = std::max(across, std::fabs(p.scatter(i, j)));
    return across;
  };
  EXPECT_EQ(scatter(), 0.0);
  for (Condition &c : e.conditions)
    c.specimen = "disc";
  EXPECT_GT(scatter(), 0.0);
}

// What could be measured next on the same disc shares its packings; at another pressure it takes
// another disc.
TEST(ErrorTerms, PackingsOfMeasurementsToComeAreThoseOfTheirSpecimens) {
  Experiment e = two_discs();
  e.conditions.erase(e.conditions.begin());
  SharedModels models;
  const Diagnosed d = diagnosed(e, made_bank(), 1.0, models);
  const auto old = Eigen::Index(d.model->problem(d.data.experiment.values).features.size());
  int same_disc = 0, other_disc = 0;
  for (const inference::Extension &next : d.model->extensions(d.data.experiment.values)) {
    const auto &scatter = next.extended.scatter;
    const double across = scatter.topRightCorner(old, scatter.cols() - old).cwiseAbs().maxCoeff();
    const bool same = next.what.find(e.conditions[0].id) != std::string::npos;
    (same ? same_disc : other_disc) += 1;
    if (same)
      EXPECT_GT(across, 0.0) << next.what;
    else
      EXPECT_EQ(across, 0.0) << next.what;
  }
  EXPECT_GT(same_disc, 0);
  EXPECT_GT(other_disc, 0);
}

TEST(ErrorTerms, TheBudgetNamesEveryTermOfEveryObservable) {
  BankTable bank = made_bank();
  bank.spec.numerics = {{"speed", 1.0}};
  Experiment e = two_discs();
  e.on_press = true;
  SharedModels models;
  const auto &gap = diagnosed(e, bank, 1e4, models).gap;
  const auto &row = gap["budget"][0];
  EXPECT_EQ(row["observable"], "total porosity");
  EXPECT_NEAR(row["terms"]["numerics: speed"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(row["terms"]["porosity of the specimen under pressure"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(row["terms"]["reading"].get<double>(), 0.1, 1e-9);
  EXPECT_TRUE(row["terms"].contains("packings"));
  EXPECT_TRUE(row["terms"].contains("emulators"));
}

} // namespace
