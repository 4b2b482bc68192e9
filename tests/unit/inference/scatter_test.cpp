// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/scatter.h"
#include "linear_world.h"
#include "physics/pi.h"
#include <cmath>
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

TEST(ShrunkCorrelation, IndependentColumnsLoseTheirCorrelationAndEqualOnesKeepIt) {
  Random random(1, 1);
  Matrix independent(12, 8), equal(200, 3);
  for (double &v : independent.reshaped())
    v = random.normal();
  for (int i = 0; i < equal.rows(); ++i)
    equal.row(i).setConstant(random.normal());
  double weight = 0.0;
  shrunk_correlation(independent, weight);
  EXPECT_GT(weight, 0.6);
  const Matrix c = shrunk_correlation(equal, weight);
  EXPECT_LT(weight, 0.02);
  EXPECT_NEAR(c(0, 2), 1.0 - weight, 1e-12);
}

// log density of t with nu degrees in one dimension against its textbook value, and its normal
// limit.
TEST(LogStudentT, KnownValues) {
  EXPECT_NEAR(log_student_t(1.0, 0.0, 1, 1.0), std::log(1.0 / (2.0 * kPi)), 1e-12); // Cauchy at 1
  EXPECT_NEAR(log_student_t(4.0, std::log(9.0), 1, kNormal),
              -2.0 - std::log(3.0) - 0.5 * std::log(2.0 * kPi), 1e-12);
  EXPECT_NEAR(log_student_t(7.0, 0.3, 5, 0.9e6), log_student_t(7.0, 0.3, 5, kNormal), 1e-4);
}

TEST(MixedDegrees, GrowAsTheEstimatedPartShrinks) {
  const Matrix one = Matrix::Identity(4, 4);
  EXPECT_NEAR(mixed_degrees(1e-9 * one, one, 11.0), 11.0, 1e-6);
  EXPECT_NEAR(mixed_degrees(one, one, 11.0), 44.0, 1e-9);
  EXPECT_EQ(mixed_degrees(one, 0.0 * one, 11.0), kNormal);
}

struct Study {
  double accuracy = 0.0, confidence = 0.0;
};

/// Which of six known signatures is in the data, at a signal-to-noise ratio of 6 in white noise
/// terms, with the covariance that `estimate` makes of 12 seeds.
template <class Estimate> Study toy_study(const Estimate &estimate) {
  const int kWorlds = 300, kFeatures = 10, kEffects = 6, kSeeds = 12;
  Study study;
  for (int w = 0; w < kWorlds; ++w) {
    const LinearWorld world(kFeatures, 0, kEffects, std::uint64_t(100 + w));
    Random random(std::uint64_t(w), 5);
    const int truth = int(random.uniform() * kEffects);
    const Matrix signatures = 2.2 * world.signatures; // confusable: about 0.86 right at best
    const Vector data = world.draw(signatures.col(truth), world.covariance, random);
    Matrix seeds(kSeeds, kFeatures);
    for (int k = 0; k < kSeeds; ++k)
      seeds.row(k) = world.draw(Vector::Zero(kFeatures), world.covariance, random).transpose();
    const auto [covariance, degrees] = estimate(seeds, world);
    const Cholesky factor(covariance);
    Vector log_p(kEffects);
    for (int e = 0; e < kEffects; ++e)
      log_p[e] = log_student_t(factor.matrixL().solve(data - signatures.col(e)).squaredNorm(), 0.0,
                               kFeatures, degrees);
    Vector p = (log_p.array() - log_p.maxCoeff()).exp();
    p /= p.sum();
    Eigen::Index best = 0;
    study.confidence += p.maxCoeff(&best) / kWorlds;
    study.accuracy += (best == truth) / double(kWorlds);
  }
  return study;
}

// What few seeds do to a diagnosis: plugged in, wrong and sure of it; shrunk and with t, nearly as
// good as the true covariance and as sure as it is right.
TEST(ToyStudy, TwelveSeeds) {
  using Estimated = std::pair<Matrix, double>;
  const Study plugged = toy_study([](const Matrix &seeds, const LinearWorld &) {
    const Matrix c = seeds.rowwise() - seeds.colwise().mean();
    return Estimated{c.transpose() * c / double(seeds.rows() - 1), kNormal};
  });
  const Study shrunk = toy_study([](const Matrix &seeds, const LinearWorld &) {
    const Scatter s = shrunk_covariance(seeds);
    return Estimated{s.covariance, s.degrees_of_freedom};
  });
  const Study exact = toy_study([](const Matrix &, const LinearWorld &world) {
    return Estimated{world.covariance, kNormal};
  });
  RecordProperty("plugged",
                 std::to_string(plugged.accuracy) + " " + std::to_string(plugged.confidence));
  RecordProperty("shrunk",
                 std::to_string(shrunk.accuracy) + " " + std::to_string(shrunk.confidence));
  RecordProperty("exact", std::to_string(exact.accuracy) + " " + std::to_string(exact.confidence));
  const double sd = std::sqrt(0.25 / 300.0); // of an accuracy, at most
  EXPECT_LT(plugged.accuracy, exact.accuracy - 0.2);
  EXPECT_GT(plugged.confidence, plugged.accuracy + 0.2);
  EXPECT_GT(shrunk.accuracy, exact.accuracy - 0.05 - 2.0 * sd);
  EXPECT_NEAR(shrunk.confidence, shrunk.accuracy, 0.05 + 3.0 * sd);
  EXPECT_NEAR(exact.confidence, exact.accuracy, 3.0 * sd);
}

} // namespace
} // namespace calendem::inference
