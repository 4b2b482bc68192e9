// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/random.h"
#include "inference/emulator.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

constexpr int kInputs = 5, kCommon = 4, kRare = 8, kEffects = kCommon + kRare;
constexpr int kPackings = 24;
constexpr double kPacking = 0.1, kNoise = 0.1; // standard deviations

/// A response with curvature, effects that depend on the inputs and pairs that act on each other.
double response(const Vector &x, const Vector &g) {
  double f = 1.2 * x[0] - 0.5 * x[1] + 0.4 * x[0] * x[1] + 0.4 * x[2] * x[2] + 0.2 * x[3];
  f += g[0] * (0.8 - 0.4 * x[0]) - 0.6 * g[1] * (1.0 - 0.5 * g[1]) + 0.3 * g[2] * x[1];
  for (int e = kCommon; e < kEffects; ++e)
    f += g[e] * (0.15 * (e - 6) + 0.15 * x[e % kInputs]);
  return f + 0.4 * g[0] * g[1] - 0.3 * g[1] * g[4];
}

/// Points of a bank: four effects are on in 70 % of the runs, eight in 12 %.
Points points(int count, std::uint64_t seed) {
  const Matrix u = sobol_points(kInputs + 2 * kEffects, count, seed);
  Points p{(2.0 * u.topRows(kInputs).array() - 1.0).matrix(), u.middleRows(kInputs, kEffects)};
  for (int k = 0; k < count; ++k)
    for (int e = 0; e < kEffects; ++e)
      if (u(kInputs + kEffects + e, k) > (e < kCommon ? 0.7 : 0.12))
        p.amplitudes(e, k) = 0.0;
  return p;
}

/// Two outputs of one group, and one of another.
TrainingRuns sample(int count, std::uint64_t seed, double noise = kNoise) {
  TrainingRuns t{points(count, seed), {}, Matrix(3, count), {0, 0, 1}};
  Random random(seed, 4);
  Matrix of_packing(3, kPackings);
  for (double &v : of_packing.reshaped())
    v = kPacking * random.normal();
  for (int k = 0; k < count; ++k) {
    t.packing.push_back(k % kPackings);
    const double f = response(t.at.inputs.col(k), t.at.amplitudes.col(k));
    t.values.col(k) << f, 3.0 + 2.0 * f, 0.3 * t.at.inputs(4, k) + 0.2 * t.at.amplitudes(5, k);
    for (int o = 0; o < 3; ++o)
      t.values(o, k) +=
          (o == 1 ? 2.0 : 1.0) * (of_packing(o, k % kPackings) + noise * random.normal());
  }
  return t;
}

Vector responses(const Points &at) {
  Vector out(at.inputs.cols());
  for (Eigen::Index k = 0; k < out.size(); ++k)
    out[k] = response(at.inputs.col(k), at.amplitudes.col(k));
  return out;
}

const Emulator &learnt() {
  static const Emulator emulator(sample(300, 3));
  return emulator;
}

double variance_of(const Eigen::ArrayXd &values) {
  return (values - values.mean()).square().mean();
}

// The mean square error of a linear model of p terms from n runs is p / n of their noise. About 60
// terms act here (trend, curvature, 12 effects and their dependence on inputs, pairs); packings that
// shift 12 or 13 runs together add no more than their variance / 24. Twice that sum is allowed, since
// the emulator has to find which terms there are.
TEST(Emulator, LearnsMainEffectsAndPairs) {
  const Points at = points(500, 9);
  const Vector actual = responses(at);
  const Expectation e = learnt().predict(at, {0, 1});
  const double allowed =
      2.0 * (60.0 / 300.0 * (kNoise * kNoise + kPacking * kPacking) + kPacking * kPacking / 24.0);
  const double missed = (e.mean.row(0).transpose() - actual).squaredNorm() / 500.0;
  EXPECT_LT(missed, allowed);
  EXPECT_GT(1.0 - missed / variance_of(actual.array()), 0.98);
  const Vector second = 3.0 + 2.0 * actual.array();
  EXPECT_LT((e.mean.row(1).transpose() - second).squaredNorm() / 500.0, 4.0 * allowed);
  const double z2 = ((e.mean.row(0).transpose() - actual).array().square() /
                     e.variance.row(0).transpose().array())
                        .mean();
  EXPECT_GT(z2, 0.4); // neither timid
  EXPECT_LT(z2, 1.8); // nor bold
}

TEST(Emulator, AnEffectVanishesAtZeroAmplitude) {
  TrainingRuns without = sample(120, 5);
  without.at.amplitudes.row(11).setZero(); // no run tells anything of this effect
  const Emulator e(without);
  Points at = points(20, 7);
  at.amplitudes.row(11).setZero();
  const Expectation off = e.predict(at, {0});
  at.amplitudes.row(11).setConstant(0.5);
  const Expectation on = e.predict(at, {0});
  EXPECT_LT((on.mean - off.mean).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((on.variance - off.variance).minCoeff(), 0.0);
  // The limit is the value itself: a millionth of an amplitude changes a millionth of the spread.
  at.amplitudes.setZero();
  const Expectation none = learnt().predict(at, {0});
  at.amplitudes.setConstant(1e-6);
  EXPECT_LT((learnt().predict(at, {0}).mean - none.mean).cwiseAbs().maxCoeff(), 1e-5);
}

// 24 packings give a variance with a relative error of sqrt(2 / 23), 300 runs theirs within a tenth:
// together 0.02 within three errors of the packings' half.
TEST(Emulator, SeparatesTheScatterOfPackings) {
  const Expectation e = learnt().predict(points(10, 11), {0, 1});
  const double expected = kPacking * kPacking + kNoise * kNoise;
  EXPECT_NEAR(e.scatter.row(0).mean() / expected, 1.0, 1.5 * std::sqrt(2.0 / 23.0) + 0.1);
  EXPECT_NEAR(e.scatter.row(1).mean() / e.scatter.row(0).mean(), 4.0, 1.0);
}

// Shares of 300 values in 24 packings: standard errors are below sqrt(0.25 / 24) = 0.1 if packings
// decide, and 0.03 if runs do; half is the packings'. The mean square has a relative error of about
// sqrt(2 / 24) = 0.29 if packings decide.
TEST(Emulator, PredictsPackingsThatWereLeftOut) {
  const LeftOut left_out = learnt().left_out();
  for (const Accuracy &a : accuracy_of(left_out, learnt().runs().values)) {
    EXPECT_NEAR(a.inside_50, 0.5, 0.15);
    EXPECT_NEAR(a.inside_90, 0.9, 0.08);
    EXPECT_NEAR(a.square, 1.0, 0.5);
  }
  // By hand: without the packing's runs, with the same hyperparameters.
  TrainingRuns without = learnt().runs();
  for (int k = 0; k < 300; ++k)
    if (without.packing[std::size_t(k)] == 2)
      without.values.col(k).setConstant(std::nan(""));
  const Emulator emulator(without, learnt().hyperparameters());
  const Points at{learnt().runs().at.inputs.col(26), learnt().runs().at.amplitudes.col(26)};
  // Centre and spread are those of fewer runs: a change of a few per cent of the error.
  EXPECT_NEAR(emulator.predict(at, {0}).mean(0, 0), left_out.predicted(0, 26), 0.02);
}

// Errors of 400 runs in their deviations: outputs 0 and 1 go together by -0.8, 2 stands alone, 3 is known of no run.
// The standard error of a correlation r is (1 - r^2) / sqrt(400): 0.018 and 0.05.
TEST(Emulator, ErrorsOfPackingsThatWereLeftOutTellWhichGoTogether) {
  constexpr int kRuns = 400;
  Random random(7, 3);
  LeftOut left_out{Matrix::Constant(4, kRuns, 5.0), Matrix::Constant(4, kRuns, 0.3)};
  Matrix values = left_out.predicted;
  for (int r = 0; r < kRuns; ++r) {
    const double first = random.normal();
    values(0, r) += 0.3 * first;
    values(1, r) += 0.3 * (-0.8 * first + 0.6 * random.normal());
    values(2, r) += 0.3 * random.normal();
  }
  values.row(3).setConstant(std::nan(""));
  Matrix expected = Matrix::Identity(4, 4);
  expected(0, 1) = expected(1, 0) = expected(0, 3) = expected(3, 0) = 0.5;
  const Matrix c = error_correlation(left_out, values, expected);
  EXPECT_NEAR(c(0, 1), -0.8, 3.0 * 0.018);
  EXPECT_NEAR(c(0, 2), 0.0, 3.0 * 0.05);
  EXPECT_NEAR(c(0, 3), 0.5, 0.02) << "as expected where no run tells";
  EXPECT_NEAR(c.diagonal().minCoeff(), 1.0, 1e-12);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix>(c).eigenvalues().minCoeff(), 0.0);
  // Ten runs with a correlation of 0.2, whose standard error is 0.3: as expected, 0.
  LeftOut few{Matrix::Zero(2, 10), Matrix::Ones(2, 10)};
  Matrix signs(2, 10);
  signs << 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, //
      1, 1, 1, -1, -1, 1, 1, -1, -1, -1;
  EXPECT_NEAR(error_correlation(few, signs, Matrix::Identity(2, 2))(0, 1), 0.0, 1e-12);
}

TEST(Emulator, FarFromAllRunsTheVarianceIsThePriors) {
  Points at = points(10, 13);
  const Expectation near = learnt().predict(at, {0});
  at.inputs *= 100.0;
  const Expectation far = learnt().predict(at, {0});
  const auto &h = learnt().hyperparameters()[0];
  const Kernel kernel(kInputs, kEffects, Vector::Map(h.data(), Eigen::Index(h.size())));
  const Vector prior = kernel.prior_variance(at);
  const double scale = learnt().predict(at, {0}).scatter(0, 0) / kernel.scatter(at)[0];
  EXPECT_GT(far.variance.minCoeff(), 10.0 * near.variance.maxCoeff());
  for (int k = 0; k < 10; ++k)
    EXPECT_NEAR(far.variance(0, k) / (scale * prior[k]), 1.0, 0.02);
}

TEST(Emulator, RunsMayLackOutputs) {
  TrainingRuns some = sample(300, 3);
  for (int k = 0; k < 300; ++k)
    if (some.at.inputs(0, k) > 0.7)
      some.values(1, k) = std::nan("");
  const Emulator emulator(some);
  const Points at = points(200, 9);
  const Vector actual = responses(at);
  const Expectation e = emulator.predict(at, {0, 1});
  EXPECT_GT(1.0 - (e.mean.row(0).transpose() - actual).squaredNorm() / 200.0 /
                      variance_of(actual.array()),
            0.98);
  const LeftOut left_out = emulator.left_out();
  for (int k = 0; k < 300; ++k)
    EXPECT_EQ(std::isfinite(left_out.predicted(1, k)), std::isfinite(some.values(1, k)));
  EXPECT_TRUE(e.mean.allFinite() && e.variance.allFinite());
  // It is less sure where runs lack the output.
  for (int k = 0; k < 200; ++k)
    if (at.inputs(0, k) > 0.9)
      EXPECT_GT(e.variance(1, k), 4.0 * e.variance(0, k));
}

TEST(Emulator, GradientOfTheMisfitIsThatOfDifferences) {
  const TrainingRuns t = sample(60, 17);
  const Matrix values = t.values.topRows(2).transpose();
  Vector at = Kernel::prior_means(kInputs, kEffects), gradient(at.size());
  Random random(5, 5);
  for (double &v : at)
    v += 0.3 * random.normal();
  misfit(t.at, t.packing, values, at, gradient);
  const auto differences = with_differences([&](const Vector &x) {
    Vector unused(x.size());
    return misfit(t.at, t.packing, values, x, unused);
  });
  Vector expected(at.size());
  differences(at, expected);
  // Third derivatives are of the order of the misfit, 100: 1e-8 / 6 of that.
  EXPECT_LT((gradient - expected).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Emulator, HyperparametersOutAndInGiveTheSameBits) {
  const Emulator first(sample(80, 19)), again(sample(80, 19)),
      stored(sample(80, 19), first.hyperparameters());
  EXPECT_EQ(first.hyperparameters(), again.hyperparameters());
  const Points at = points(70, 21);
  const Expectation a = first.predict(at, {2, 0}), b = stored.predict(at, {2, 0});
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.variance, b.variance);
  EXPECT_EQ(a.scatter, b.scatter);
  // A point alone is what it is among others, but for the order of sums.
  const Points one{at.inputs.col(69), at.amplitudes.col(69)};
  EXPECT_NEAR(first.predict(one, {0}).mean(0, 0), a.mean(1, 69), 1e-9);
}

TEST(Emulator, AnOutputWithoutRunsIsNotKnown) {
  TrainingRuns t = sample(60, 23);
  t.values.row(2).setConstant(std::nan(""));
  t.values.row(1).setConstant(0.5);
  const Emulator e(t, Hyperparameters{{1.0, 2.0}}); // lists of another bank are not taken
  EXPECT_EQ(e.hyperparameters()[0], Emulator(t).hyperparameters()[0]);
  const Expectation of = e.predict(points(5, 3), {0, 1, 2});
  EXPECT_TRUE(of.mean.row(2).array().isNaN().all() && of.variance.row(2).array().isNaN().all());
  EXPECT_TRUE(of.mean.row(0).allFinite() && of.variance.row(0).allFinite());
  EXPECT_LT((of.mean.row(1).array() - 0.5).abs().maxCoeff(), 1e-6); // one that never changes
}

} // namespace
} // namespace calendem::inference
