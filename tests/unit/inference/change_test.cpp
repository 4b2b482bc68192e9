// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/diagnosis.h"
#include "synthetic_bank.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

/// What was measured before, and that plus `by`.
struct Change {
  Bank bank = synthetic_bank(16, 0.02);
  ObservableVector before = synthetic_experiment("", 0.0, 3, 0.02, 0.05);
  Model model{bank, before, ModelSettings{}};
  Vector predicted;
  KnownBase base = recalibrated(model, before.values, predicted);

  Problem problem(const Vector &by) const {
    return change_of(model, predicted + by, predicted, base);
  }
};

// Without an effect nothing changes, whatever the base parameters.
TEST(ChangeOf, NothingChangesWithoutAnEffect) {
  const Change c;
  const Problem p = c.problem(Vector::Zero(c.predicted.size()));
  const int emulated = c.model.map().emulated();
  for (const double score : {-2.0, 0.0, 1.5}) {
    const Prediction at = p.predict(Vector::Constant(2, score), {});
    EXPECT_NEAR((at.mean - p.observed).head(emulated).norm(), 0.0, 1e-9);
    EXPECT_EQ(at.variance.norm(), 0.0);
  }
}

// Its scores count from what the experiment before left; parameters are shown in their units.
TEST(ChangeOf, ParametersAreThoseFoundBefore) {
  const Change c;
  const Problem p = c.problem(Vector::Zero(c.predicted.size()));
  const Diagnosis d = diagnose(c.model, p, c.bank, c.predicted, DiagnosisSettings{});
  for (std::size_t j = 0; j < c.bank.base.size(); ++j) {
    const Prior &prior = c.bank.base[j].prior;
    const double sd = std::sqrt(c.base.covariance(Eigen::Index(j), Eigen::Index(j))),
                 mean = c.base.mean[Eigen::Index(j)];
    EXPECT_GT(d.parameters[j].mode, prior.value(mean - 0.2 * sd));
    EXPECT_LT(d.parameters[j].mode, prior.value(mean + 0.2 * sd));
    EXPECT_NEAR(d.parameters[j].low90, prior.value(mean - 1.64 * sd),
                0.3 * std::fabs(prior.value(mean) - prior.value(mean - 1.64 * sd)));
  }
}

/// Five-point differences of step h = 0.02: h^4 / 30 fifth derivatives, and of an emulator's
/// variance, a small difference of priors of 25, some 1e-9 / h of rounding.
Prediction along(const Problem &p, const Vector &scores, Eigen::Index which) {
  const double h = 0.02, weight[] = {1.0, -8.0, 8.0, -1.0}, at[] = {-2.0, -1.0, 1.0, 2.0};
  Prediction out{Vector::Zero(p.observed.size()), Vector::Zero(p.observed.size())};
  for (int k = 0; k < 4; ++k) {
    Vector moved = scores;
    moved[which] += at[k] * h;
    const Prediction there = p.predict(moved.head(2), {{0, moved.tail(1)}});
    out.mean += weight[k] / (12.0 * h) * there.mean;
    out.variance += weight[k] / (12.0 * h) * there.variance;
  }
  return out;
}

TEST(ChangeOf, SlopesAreDerivatives) {
  const Change c;
  const Problem p = c.problem(Vector::Zero(c.predicted.size()));
  const Vector scores = Eigen::Vector3d(0.4, -0.7, 0.3);
  const Slopes exact = p.slopes(scores.head(2), {{0, scores.tail(1)}});
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Prediction near = along(p, scores, j);
    EXPECT_LT((exact.mean.col(j) - near.mean).norm(), 1e-5 * (1.0 + near.mean.norm()));
    EXPECT_LT((exact.variance.col(j) - near.variance).norm(), 1e-5 * (1.0 + near.variance.norm()));
  }
}

} // namespace
} // namespace calendem::inference
