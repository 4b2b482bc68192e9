// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/model.h"
#include "diagnose/inference/scatter.h"
#include "diagnose/inference/where.h"
#include "diagnose/inference/which.h"
#include "linear_world.h"
#include "synthetic_bank.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

/// The recalibrated base model of a linear world, in closed form.
Linearised recalibrated(const LinearWorld &world, const Problem &problem) {
  const Matrix &j = world.sensitivity;
  const Vector scores =
      j.transpose() * Cholesky(world.covariance_of(-1)).solve(problem.observed - world.centre);
  return linearise(problem, scores);
}

TEST(Where, FalseAlarmsOfATableWithoutGap) {
  const LinearWorld world(8, 3, 0, 2);
  Random random(5, 5);
  WhereSettings settings;
  settings.simulations = 20000;
  const double threshold =
      where(world.problem(world.centre), recalibrated(world, world.problem(world.centre)), settings)
          .threshold;
  settings.simulations = 1; // the threshold does not depend on the data
  const int kTables = 2000;
  int alarms = 0;
  for (int k = 0; k < kTables; ++k) {
    const Problem problem =
        world.problem(world.draw(world.centre, world.covariance_of(-1), random));
    const Where w = where(problem, recalibrated(world, problem), settings);
    alarms += std::fabs(w.rows[0].z) > threshold;
  }
  // Binomial spread of the tables, and of the 20000 that gave the threshold.
  EXPECT_NEAR(alarms / double(kTables), 0.05,
              3.0 * std::sqrt(0.05 * 0.95 * (1.0 / kTables + 1.0 / 20000)));
}

TEST(Where, AShiftedObservableIsFoundWithItsSign) {
  const LinearWorld world(8, 2, 0, 3);
  Vector data = world.centre;
  data[5] -= 8.0;
  const Problem problem = world.problem(data);
  const Where w = where(problem, recalibrated(world, problem), {});
  EXPECT_EQ(w.rows[0].block, 5);
  EXPECT_TRUE(w.rows[0].significant);
  EXPECT_GT(w.rows[0].z, w.threshold); // predicted - observed
  double share = 0.0;
  for (const WhereRow &r : w.rows)
    share += r.share;
  EXPECT_NEAR(share, 1.0, 1e-12);
}

// Two observables that one parameter moves alike, measured apart: each alone can be met.
TEST(Where, WhatCannotBeMetTogether) {
  LinearWorld world(4, 1, 0, 4);
  world.covariance = 0.01 * Matrix::Identity(4, 4);
  world.centre.setZero();
  world.sensitivity << 1.0, 1.0, 0.0, 0.0;
  Vector data = Vector::Zero(4);
  data.head(2) << 1.2, -0.8;
  const Problem problem = world.problem(data);
  const Where w = where(problem, recalibrated(world, problem), {});
  ASSERT_EQ(w.conflicts.size(), 1u);
  EXPECT_EQ(w.conflicts[0].one, 0);
  EXPECT_EQ(w.conflicts[0].other, 1);
  // Closed form: the difference has variance 0.02, the sum 2 * (2 + 0.01).
  EXPECT_NEAR(w.conflict(0, 1), chance_beyond(4.0 / 0.02 + 0.16 / 4.02, 2, kNormal), 1e-12);
  // Observables 0 and 2 are of the compression, 1 and 3 of the relaxation: the parameter drifts.
  ASSERT_EQ(w.stages.size(), 2u);
  EXPECT_NEAR(w.stages[0].scores[0], 1.2 / 1.01, 1e-9);
  EXPECT_NEAR(w.stages[1].scores[0], -0.8 / 1.01, 1e-9);
  EXPECT_NEAR(w.stages[0].sd[0], std::sqrt(0.01 / 1.01), 1e-9);
}

TEST(Chances, EquivalentZ) {
  EXPECT_NEAR(equivalent_z(9.0, 1), 3.0, 1e-12);
  EXPECT_NEAR(equivalent_z(-2.0 * std::log(0.05), 2), 1.959964, 1e-5); // two dimensions: exp(-q/2)
  EXPECT_NEAR(equivalent_z(4000.0, 3), std::sqrt(4000.0), 1.0);
  EXPECT_NEAR(chance_beyond(6.61, 1, 5.0), 0.05, 1e-3); // F(1, 5) of any table
}

// Two features of sd 1 and 2 whose emulators err by 0.5 and 1, alike by 0.6.
TEST(CovarianceAbout, EmulatorsErrTogether) {
  Problem p;
  p.measurement = Vector(Vector::Constant(2, 1.0)).asDiagonal();
  p.scatter = Vector(Eigen::Vector2d(0.0, 3.0)).asDiagonal();
  const Prediction errs{Vector::Zero(2), Eigen::Vector2d(0.25, 1.0)};
  Matrix expected = Eigen::Matrix2d{{1.25, 0.0}, {0.0, 5.0}};
  EXPECT_EQ(covariance_about(p, errs), expected);
  p.correlation = Eigen::Matrix2d{{1.0, 0.6}, {0.6, 1.0}};
  expected(0, 1) = expected(1, 0) = 0.5 * 0.6;
  EXPECT_LT((covariance_about(p, errs) - expected).norm(), 1e-15);
}

// An effect that adds variances of 0.36 and 0.04 between cells, of which the sample has four.
TEST(CovarianceAbout, ScatterThatEffectsAddShrinksWithTheSample) {
  Problem p;
  p.measurement = p.scatter = Matrix::Zero(2, 2);
  p.added_scatter = 0.25 * Eigen::Matrix2d{{1.0, 0.5}, {0.5, 1.0}};
  const Prediction errs{Vector::Zero(2), Vector::Zero(2), Eigen::Vector2d(0.36, 0.04)};
  EXPECT_LT((covariance_about(p, errs) - 0.25 * Eigen::Matrix2d{{0.36, 0.06}, {0.06, 0.04}}).norm(),
            1e-15);
}

// Specimens are means of four and of one, between which nothing scatters together.
TEST(CovarianceAbout, ScatterThatEffectsAddIsOfOneSpecimen) {
  Bank bank = synthetic_bank(16, 0.05);
  ObservableVector experiment = synthetic_experiment("", 0.0, 3, 0.05, 0.02);
  for (std::size_t k = kCurve; k < experiment.of.size(); ++k)
    experiment.of[k].condition = bank.observables[k].condition = "p80";
  ModelSettings settings;
  settings.packings_in_sample = 2.0;
  settings.specimens = {{"p150", {"a", 4}}, {"p80", {"b", 1}}};
  const Problem p = Model(bank, experiment, settings).problem(experiment.values);
  for (std::size_t i = 0; i < p.features.size(); ++i)
    for (std::size_t j = 0; j < p.features.size(); ++j) {
      const std::string &own = p.blocks[std::size_t(p.features[i].block)].condition,
                        &other = p.blocks[std::size_t(p.features[j].block)].condition;
      const bool emulated = p.features[i].emulated && p.features[j].emulated;
      EXPECT_EQ(p.added_scatter(Eigen::Index(i), Eigen::Index(j)),
                emulated && own == other ? p.correlation(Eigen::Index(i), Eigen::Index(j)) *
                                               (own == "p150" ? 0.125 : 0.5)
                                         : 0.0);
    }
}

} // namespace
} // namespace calendem::inference
