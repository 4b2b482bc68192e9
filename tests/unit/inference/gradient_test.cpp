// SPDX-License-Identifier: GPL-2.0-or-later
// Analytic derivatives beside differences: 1e-5 of the gradient's size.
#include "diagnose/inference/hypothesis.h"
#include "diagnose/inference/model.h"
#include "inference/numerics.h"
#include "synthetic_bank.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

/// All kinds of priors; the curve leaves a truncation residual.
Problem learnt() {
  Bank bank = synthetic_bank(24, 0.05);
  bank.effects[0].parameters[0].power = 0.5;
  bank.effects[1].parameters[0].prior = {Prior::log_uniform, 0.01, 1.0};
  bank.effects[1].parameters[0].power = 0.0;
  bank.effects[1].parameters[0].nothing = 0.002;
  bank.effects[2].parameters[0].prior = {Prior::normal, 0.5, 0.25};
  Random packing(99, 77), rough(4, 4);
  for (std::size_t k = 0; k < bank.runs.size(); ++k) {
    BankRun &r = bank.runs[k]; // differences without scatter make ill-conditioned emulators
    for (double &v : r.values)
      v += 0.03 * rough.normal() + (r.effect.empty() ? 0.0 : 0.2 * (k / 8 % 2) * r.amplitudes[0]);
    r.packing = "p" + std::to_string(k / 8); // of two points
  }
  ObservableVector experiment{bank.observables,
                              synthetic_values(0.2, -0.1, "oscillation", 0.4, packing, 0.05),
                              0.0009 * Matrix::Identity(kCurve + 4, kCurve + 4)};
  return Model(bank, experiment, {}).problem(experiment.values);
}

void expect_same(const Matrix &a, const Matrix &b) {
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-5 * (1.0 + b.cwiseAbs().maxCoeff()));
}

/// Five-point differences of step h = 0.02: error h^4 / 30 fifth derivatives, and of an emulator's
/// variance, a small difference of priors of 25, some 1e-9 / h of rounding.
Slopes differences(const Problem &p, const Vector &base, const std::vector<Applied> &on) {
  const double h = 0.02, weight[] = {1.0, -8.0, 8.0, -1.0}, at[] = {-2.0, -1.0, 1.0, 2.0};
  const auto n = base.size() + Eigen::Index(on.size()), all = p.observed.size();
  Slopes s{Matrix::Zero(all, n), Matrix::Zero(all, n), Matrix::Zero(all, n)};
  for (Eigen::Index j = 0; j < n; ++j)
    for (int k = 0; k < 4; ++k) {
      Vector moved = base;
      std::vector<Applied> with = on;
      (j < base.size() ? moved[j] : with[std::size_t(j - base.size())].scores[0]) += at[k] * h;
      const Prediction there = p.predict(moved, with);
      s.mean.col(j) += weight[k] * there.mean / (12.0 * h);
      s.variance.col(j) += weight[k] * there.variance / (12.0 * h);
      s.scatter.col(j) += weight[k] * there.scatter / (12.0 * h);
    }
  return s;
}

TEST(Gradient, OfPredictions) {
  const Problem p = learnt();
  const Vector base = Eigen::Vector2d(0.4, -1.1);
  const std::vector<std::vector<Applied>> sets = {
      {},
      {{0, Vector::Constant(1, 0.7)}},
      {{1, Vector::Constant(1, -0.5)}, {2, Vector::Constant(1, 0.3)}}};
  for (const auto &on : sets) {
    const Slopes exact = slopes_of(p, base, on), about = differences(p, base, on);
    expect_same(exact.mean, about.mean);
    expect_same(exact.variance, about.variance);
    expect_same(exact.scatter, about.scatter);
    EXPECT_EQ(exact.scatter.norm() > 1e-3, !on.empty());
    EXPECT_GT(exact.mean.norm(), 0.1);
  }
  const Problem less = without_effect(p, 0);
  expect_same(slopes_of(less, base, {{0, Vector::Constant(1, 0.2)}}).mean,
              slopes_of(p, base, {{1, Vector::Constant(1, 0.2)}}).mean);
}

TEST(Gradient, OfEveryKindOfHypothesis) {
  const Problem p = learnt();
  ASSERT_FALSE(p.roughness.empty());
  const Matrix unknown = p.discrepancy;
  for (const Hypothesis &h :
       {Hypothesis{Hypothesis::none, {}, "none"}, Hypothesis{Hypothesis::effects, {1}, "friction"},
        Hypothesis{Hypothesis::effects, {0, 2}, "both"}, Hypothesis{Hypothesis::noise, {}, "noise"},
        Hypothesis{Hypothesis::unknown, {2}, "unknown"}})
    for (const double nu : {1e6, 12.0}) {
      SCOPED_TRACE(h.name);
      Problem with = p;
      with.degrees_of_freedom = nu;
      const Likelihood likelihood(with, h, unknown);
      Vector at = Vector::LinSpaced(likelihood.dimension(), -0.8, 0.9);
      Vector exact(at.size()), about(at.size());
      EXPECT_NEAR(likelihood.log(at, exact), likelihood.log(at), 1e-9);
      with_differences([&](const Vector &s) { return likelihood.log(s); })(at, about);
      expect_same(exact, about);
      if (h.kind == Hypothesis::noise || h.kind == Hypothesis::unknown)
        continue;
      likelihood.square(at, exact);
      Vector unused;
      with_differences([&](const Vector &s) { return likelihood.square(s, unused); })(at, about);
      expect_same(exact, about);
    }
}

// f = x^2 y: second derivatives 2y, 2x, 0.
TEST(Gradient, SecondDerivatives) {
  const WithGradient f = [](const Vector &x, Vector &g) {
    g = Eigen::Vector2d(2.0 * x[0] * x[1], x[0] * x[0]);
    return x[0] * x[0] * x[1];
  };
  const Matrix second = hessian(f, Eigen::Vector2d(3.0, 5.0), 0.01);
  expect_same(second, (Matrix(2, 2) << 10.0, 6.0, 6.0, 0.0).finished());
}

} // namespace
} // namespace calendem::inference
