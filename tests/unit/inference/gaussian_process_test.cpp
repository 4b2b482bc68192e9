// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/emulators.h"
#include "diagnose/inference/feature_map.h"
#include "diagnose/inference/scatter.h"
#include "synthetic_bank.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

double curved(const Vector &x) { return 1.0 + 2.0 * x[0] - x[1] + 1.5 * x[0] * x[1] + x[2] * x[2]; }

Training sample(int runs, int packings, double scatter, double noise, std::uint64_t seed) {
  Training t;
  t.inputs = (2.0 * sobol_points(3, runs, seed).array() - 1.0).matrix();
  t.amplitudes.resize(0, runs);
  t.values.resize(runs);
  Random random(seed, 4);
  Vector of_packing(packings);
  for (double &v : of_packing)
    v = scatter * random.normal();
  for (int i = 0; i < runs; ++i) {
    t.packing.push_back(i % packings);
    t.values[i] = curved(t.inputs.col(i)) + of_packing[i % packings] + noise * random.normal();
  }
  return t;
}

TEST(GaussianProcess, LearnsACurvedResponseFromFortyRuns) {
  const GaussianProcess g(sample(40, 40, 0.0, 0.0, 1));
  const Matrix points = (2.0 * sobol_points(3, 200, 9).array() - 1.0).matrix();
  Vector predicted(200), actual(200);
  for (int i = 0; i < 200; ++i) {
    predicted[i] = g.at(points.col(i), Vector()).mean;
    actual[i] = curved(points.col(i));
  }
  EXPECT_GT(q2_of(predicted, actual), 0.999);
  EXPECT_GT(g.left_out().q2, 0.99);
}

// 60 runs, 15 packings: variances within three of their standard errors (15 - 1 packings: relative
// error sqrt(2/14); noise: 60 - 15 - about 9 of the response).
TEST(GaussianProcess, SeparatesPackingsFromNoise) {
  const GaussianProcess g(sample(60, 15, 0.5, 0.2, 2));
  EXPECT_NEAR(g.packing_variance() / 0.25, 1.0, 3.0 * std::sqrt(2.0 / 14.0));
  EXPECT_NEAR(g.run_variance() / 0.04, 1.0, 3.0 * std::sqrt(2.0 / 36.0));
  // What a new packing is off by: both variances, and the emulator's.
  EXPECT_NEAR(std::pow(g.left_out().error, 2) / 0.29, 1.0, 0.6);
  // With the scatter taken off, the emulator's own part is small beside it.
  EXPECT_LT(g.left_out().own, 0.7 * g.left_out().error);
  EXPECT_GT(g.parameters_used(), 4.0);
  EXPECT_LT(g.parameters_used(), 30.0);
}

// The stated variance is that of the errors: the mean of (error)^2 / variance over points and over
// 20 banks is about 1 (hyperparameters taken as known make it larger).
TEST(GaussianProcess, SaysHowWrongItIs) {
  double sum = 0.0;
  const Matrix points = (2.0 * sobol_points(3, 20, 9).array() - 1.0).matrix();
  for (int bank = 0; bank < 20; ++bank) {
    const GaussianProcess g(sample(30, 30, 0.0, 0.4, std::uint64_t(bank) + 10));
    for (int i = 0; i < 20; ++i) {
      const Mean m = g.at(points.col(i), Vector());
      sum += std::pow(m.mean - curved(points.col(i)), 2) / m.variance / 400.0;
    }
  }
  EXPECT_GT(sum, 0.5);
  EXPECT_LT(sum, 2.0);
}

// Eight runs cannot resolve a weak effect in their noise; what is known of the noise keeps a ninth
// within what is stated. Its squared error over the stated variance has the mean nu / (nu - 2) of a
// t distribution: nu = 7 from the runs and 2 / 0.7^2 from the prior of the noise's logarithm, 1.22;
// 400 banks give it within 0.1.
TEST(GaussianProcess, FewRunsOfAnEffectKnowTheirNoise) {
  constexpr int kBanks = 400, kRuns = 8;
  double sum = 0.0;
  for (int bank = 0; bank < kBanks; ++bank) {
    Random random(std::uint64_t(bank), 5);
    const Matrix shares = sobol_points(5, kRuns + 1, std::uint64_t(bank) + 1);
    Vector values(kRuns + 1);
    for (int i = 0; i <= kRuns; ++i)
      values[i] = 0.5 * shares(4, i) * (1.0 + 0.3 * shares(0, i)) + random.normal();
    Training t;
    t.inputs = (2.0 * shares.leftCols(kRuns).array() - 1.0).matrix();
    t.amplitudes = shares.row(4).head(kRuns);
    t.values = values.head(kRuns);
    for (int i = 0; i < kRuns; ++i)
      t.packing.push_back(i);
    t.usual_noise = 1.0;
    const GaussianProcess g(t);
    const Vector ninth = (2.0 * shares.col(kRuns).array() - 1.0).matrix();
    const Mean m = g.at(ninth, shares.row(4).tail(1));
    sum += std::pow(m.mean - values[kRuns], 2) / (m.variance + g.run_variance()) / kBanks;
  }
  EXPECT_NEAR(sum, 1.22, 0.3);
}

TEST(GaussianProcess, AConstantIsPredictedAsSuch) {
  Training t = sample(20, 20, 0.0, 0.0, 3);
  t.values.setConstant(7.0);
  const Mean m = GaussianProcess(t).at(Vector::Zero(3), Vector());
  EXPECT_NEAR(m.mean, 7.0, 1e-6);
  EXPECT_LT(m.variance, 1e-9);
}

/// Three features of curved responses whose packings scatter together: correlation 0.8 of the first
/// two, none with the third; 0.3, 0.3 and 0.1 in size. `each`: runs of one packing.
std::vector<GaussianProcess> correlated(int runs, int each, std::vector<int> &packing) {
  std::vector<GaussianProcess> all;
  Training t = sample(runs, runs / each, 0.0, 0.0, 5);
  packing = t.packing;
  Random random(7, 7);
  Matrix of_packing(3, runs / each);
  for (int p = 0; p < of_packing.cols(); ++p) {
    const Eigen::Vector3d normal{random.normal(), random.normal(), random.normal()};
    of_packing.col(p) << 0.3 * normal[0], 0.3 * (0.8 * normal[0] + 0.6 * normal[1]),
        0.1 * normal[2];
  }
  const Vector response = t.values;
  for (int f = 0; f < 3; ++f) {
    for (int i = 0; i < runs; ++i)
      t.values[i] = (1.0 - 0.3 * f) * response[i] + of_packing(f, packing[i]);
    all.emplace_back(t);
  }
  return all;
}

// A variance from n packings is known within sqrt(2/n), a correlation r within (1 - r^2)/sqrt(n);
// three of these, and for the correlation the shrinkage.
TEST(PooledScatter, IsTheCovarianceOfThePackings) {
  for (const int each : {1, 3}) {
    std::vector<int> packing;
    const std::vector<GaussianProcess> all = correlated(90, each, packing);
    const Scatter s = pooled_scatter(all, residuals_of(all), packing);
    const double n = each == 1 ? s.degrees_of_freedom : 29.0;
    const Vector sd = s.covariance.diagonal().cwiseSqrt();
    for (int f = 0; f < 3; ++f)
      EXPECT_NEAR(std::pow(sd[f] / (f < 2 ? 0.3 : 0.1), 2), 1.0, 3.0 * std::sqrt(2.0 / n));
    EXPECT_NEAR(s.covariance(0, 1) / (sd[0] * sd[1]), 0.8 * (1.0 - s.shrinkage),
                3.0 * 0.36 / std::sqrt(n));
    EXPECT_NEAR(s.covariance(0, 2) / (sd[0] * sd[2]), 0.0, 3.0 / std::sqrt(n));
    if (each == 1) { // 90 runs, a response of 10 coefficients, some of them barely used
      EXPECT_GT(s.degrees_of_freedom, 60.0);
      EXPECT_LT(s.degrees_of_freedom, 86.0);
    } else {
      EXPECT_NEAR(s.degrees_of_freedom, 29.0, 1.0);
    }
  }
}

// Three runs of each of 30 packings, alike but for noise of the single runs, correlated by 0.8; 60
// degrees of freedom are left of it, a few fewer with the response's.
TEST(PooledScatter, RunsOfOnePackingMayScatterTogether) {
  Training t = sample(90, 30, 0.0, 0.0, 5);
  Random random(8, 8);
  Matrix of_run(2, 90);
  for (int i = 0; i < 90; ++i) {
    const double common = random.normal();
    of_run.col(i) << 0.3 * common, 0.3 * (0.8 * common + 0.6 * random.normal());
  }
  std::vector<GaussianProcess> all;
  const Vector response = t.values;
  for (int f = 0; f < 2; ++f) {
    t.values = response + of_run.row(f).transpose();
    all.emplace_back(t);
  }
  const Scatter s = pooled_scatter(all, residuals_of(all), t.packing);
  EXPECT_NEAR(std::sqrt(s.covariance(0, 0)), 0.3, 3.0 * 0.3 / std::sqrt(2.0 * 55.0));
  const double correlation =
      s.covariance(0, 1) / std::sqrt(s.covariance(0, 0) * s.covariance(1, 1));
  EXPECT_NEAR(correlation, 0.8 * (1.0 - s.shrinkage), 3.0 * 0.36 / std::sqrt(55.0));
  EXPECT_LT(s.shrinkage, 0.1);
}

TEST(Emulators, AnEffectIsNothingAtAmplitudeZero) {
  const Bank bank = synthetic_bank(30, 0.05);
  Matrix values(16, Eigen::Index(bank.runs.size()));
  for (int i = 0; i < values.cols(); ++i)
    values.col(i) = bank.runs[i].values;
  const Emulators learnt(bank, values);
  const auto at = [&](double amplitude, bool on) {
    Prediction p{Vector::Zero(16), Vector::Zero(16), Vector::Zero(16)};
    std::vector<Applied> applied;
    if (on)
      applied.push_back(
          {0, Vector::Constant(1, bank.effects[0].parameters[0].prior.score(amplitude))});
    learnt.predict(Vector::Zero(2), applied, 0, p);
    return p;
  };
  EXPECT_NEAR((at(0.0, true).mean - at(0.0, false).mean).norm(), 0.0, 1e-9);
  EXPECT_NEAR((at(0.0, true).variance - at(0.0, false).variance).norm(), 0.0, 1e-9);
  // In the middle: -(0.5 a + 0.2 a^2) of the porosity. Paired runs share their packing: no scatter.
  EXPECT_NEAR(at(0.5, true).mean[kCurve] - at(0.5, false).mean[kCurve], -0.3, 2e-3);
  EXPECT_GT(learnt.effect(0)[kCurve].left_out().q2, 0.99);
  // Its emulator is not sure of itself either, packings apart.
  EXPECT_GT(at(0.5, true).variance[kCurve], at(0.5, false).variance[kCurve]);
}

// Differences that are computed have no noise; those of two simulations have that of both.
TEST(Emulators, WhatIsComputedDoesNotScatterOnItsOwn) {
  Bank bank = synthetic_bank(12, 0.05);
  Matrix values(16, Eigen::Index(bank.runs.size()));
  for (int i = 0; i < values.cols(); ++i)
    values.col(i) = bank.runs[i].values;
  const auto variance = [&](bool computed) {
    bank.effects[0].computed = computed;
    const Emulators learnt(bank, values);
    Prediction p{Vector::Zero(16), Vector::Zero(16), Vector::Zero(16)}, off = p;
    learnt.predict(Vector::Zero(2), {{0, Vector::Zero(1)}}, 0, p);
    learnt.predict(Vector::Zero(2), {}, 0, off);
    return p.variance[kCurve] - off.variance[kCurve];
  };
  EXPECT_LT(variance(true), 0.1 * variance(false));
}

// Residuals are those of the base model's 12 runs and two effects' 12 each; the third is computed.
// Mean squares of base runs lie below 1 by what their 12 runs are adapted to, and not far.
TEST(Emulators, ResidualsAreThoseOfAllThatIsSimulated) {
  Bank bank = synthetic_bank(12, 0.05);
  bank.effects[1].computed = true;
  Matrix values(16, Eigen::Index(bank.runs.size()));
  for (int i = 0; i < values.cols(); ++i)
    values.col(i) = bank.runs[i].values;
  const Emulators learnt(bank, values);
  const Matrix residuals = learnt.residuals();
  ASSERT_EQ(residuals.rows(), 36);
  ASSERT_EQ(residuals.cols(), 16);
  const GaussianProcess &g = learnt.base()[kCurve];
  const double sd = std::sqrt(g.run_variance() + g.packing_variance());
  EXPECT_NEAR(residuals(5, kCurve), g.residuals()[5] / sd, 1e-12);
  EXPECT_NEAR(residuals(12 + 12 + 5, kCurve),
              learnt.effect(2)[kCurve].residuals()[5] /
                  std::sqrt(learnt.effect(2)[kCurve].run_variance()),
              1e-12);
  EXPECT_LT(residuals.topRows(12).squaredNorm() / (12.0 * 16.0), 1.0);
  EXPECT_GT(residuals.topRows(12).squaredNorm() / (12.0 * 16.0), 0.1);
}

std::vector<ObservableId> curve_of(int points) {
  std::vector<ObservableId> all;
  for (int k = 0; k < points; ++k)
    all.push_back({"curve", "compression", "c", k / (points - 1.0)});
  return all;
}

/// Two-dimensional families of curves over 20 points, 50 runs.
Matrix smooth_runs() {
  Random random(3, 3);
  Matrix runs(20, 50);
  for (int i = 0; i < 50; ++i) {
    const double a = random.normal(), b = random.normal();
    for (int k = 0; k < 20; ++k)
      runs(k, i) = a * k / 19.0 + b * std::pow(k / 19.0, 2);
  }
  return runs;
}

// Noise alone: the truncation residual is standard normal. A bump outside the runs' span shows.
TEST(FeatureMap, KeepsWhatIsOutsideTheSpan) {
  const double noise = 0.1;
  const Matrix measurement = noise * noise * Matrix::Identity(20, 20);
  const FeatureMap map(curve_of(20), smooth_runs(), Vector::Constant(20, noise), measurement);
  EXPECT_EQ(map.emulated(), 2);
  ASSERT_EQ(map.size(), 3);
  Random random(6, 6);
  double sum = 0.0, square = 0.0;
  const int kDraws = 4000;
  Vector curve(20);
  for (int n = 0; n < kDraws; ++n) {
    for (int k = 0; k < 20; ++k)
      curve[k] = 0.7 * k / 19.0 + noise * random.normal();
    const double z = map.features_of(curve)[2];
    sum += z / kDraws;
    square += z * z / kDraws;
  }
  EXPECT_NEAR(sum, 0.0, 3.0 / std::sqrt(kDraws));
  EXPECT_NEAR(square, 1.0, 3.0 * std::sqrt(2.0 / kDraws));
  // Errors three times as large shift it as predicted: all that lies there is measurement.
  sum = square = 0.0;
  const NormalMoments larger = score_moments(map.roughness()[0].measured, 3.0);
  EXPECT_EQ(map.roughness()[0].feature, 2);
  for (int n = 0; n < kDraws; ++n) {
    for (int k = 0; k < 20; ++k)
      curve[k] = 0.7 * k / 19.0 + 3.0 * noise * random.normal();
    const double z = (map.features_of(curve)[2] - larger.mean) / std::sqrt(larger.variance);
    sum += z / kDraws;
    square += z * z / kDraws;
  }
  EXPECT_GT(larger.mean, 5.0);
  EXPECT_NEAR(sum, 0.0, 3.0 / std::sqrt(kDraws));
  EXPECT_NEAR(square, 1.0, 3.0 * std::sqrt(2.0 / kDraws));
  for (int k = 0; k < 20; ++k)
    curve[k] = 0.5 * std::sin(k);
  EXPECT_GT(map.features_of(curve)[2], 8.0);
  EXPECT_GT(map.discrepancy(25.0 * measurement)(2, 2), 9.0);
}

// Half of ten directions hold measurement only, the others hardly any: a sum of squares of weights
// 9 and 1.08. Satterthwaite's and Wilson and Hilferty's approximations are good to a few per cent.
TEST(FeatureMap, TruncationResidualOfMixedDirections) {
  Vector mixed = Vector::Constant(10, 0.01);
  mixed.head(5).setOnes();
  EXPECT_NEAR(score_moments(mixed, 1.0).mean, 0.0, 1e-12);
  EXPECT_NEAR(score_moments(mixed, 1.0).variance, 1.0, 1e-12);
  const NormalMoments predicted = score_moments(mixed, 3.0);
  Random random(8, 2);
  double sum = 0.0, square = 0.0;
  const int kDraws = 20000;
  for (int n = 0; n < kDraws; ++n) {
    double q = 0.0;
    for (int k = 0; k < 10; ++k)
      q += (k < 5 ? 9.0 : 1.08) * std::pow(random.normal(), 2);
    const double z = normal_score(q, 10);
    sum += z / kDraws;
    square += z * z / kDraws;
  }
  const double sd = std::sqrt(square - sum * sum);
  EXPECT_NEAR(sum, predicted.mean, 0.05 * sd);
  EXPECT_NEAR(sd, std::sqrt(predicted.variance), 0.05 * sd);
}

TEST(FeatureMap, GivesSmoothCurvesBackAndScalarsUnchanged) {
  auto observables = curve_of(20);
  observables.push_back({"scalar", "relaxation", "c"});
  Matrix runs(21, 50);
  runs.topRows(20) = smooth_runs();
  for (int i = 0; i < 50; ++i)
    runs(20, i) = i;
  const FeatureMap map(observables, runs, Vector::Constant(21, 0.1),
                       0.01 * Matrix::Identity(21, 21));
  EXPECT_LT((map.observables_of(map.emulated_of(runs.col(7)).col(0)) - runs.col(7)).norm(), 1e-9);
  EXPECT_NEAR(map.covariance(0.01 * Matrix::Identity(21, 21))(0, 0), 1.0, 1e-12);
  EXPECT_EQ(map.features()[2].block, 1);
}

} // namespace
} // namespace calendem::inference
