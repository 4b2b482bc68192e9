// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/evidence.h"
#include "diagnose/inference/hypothesis.h"
#include "inference/numerics.h"
#include "linear_world.h"
#include "physics/pi.h"
#include <gtest/gtest.h>

namespace calendem::inference {
namespace {

const Matrix kNoUnknown;

Evidence of_effect(const LinearWorld &world, const Vector &data, int effect) {
  const Problem problem = world.problem(data);
  Hypothesis h;
  if (effect >= 0)
    h = {Hypothesis::effects, {effect}, "e", 0.0};
  const Likelihood likelihood(problem, h, kNoUnknown);
  return evidence(likelihood.dimension(), [&](const Vector &s) { return likelihood.log(s); }, {});
}

TEST(Evidence, LinearGaussianIsItsClosedForm) {
  Random random(3, 3);
  for (int d = 1; d <= 5; ++d) {
    const LinearWorld world(12, d, 2, std::uint64_t(d));
    const Vector data = world.draw(world.mean_of(0), world.covariance_of(0), random);
    for (int effect = -1; effect < 2; ++effect) {
      const Evidence e = of_effect(world, data, effect);
      const double exact = world.exact_evidence(effect, data);
      EXPECT_NEAR(e.laplace, exact, 1e-5) << d << " parameters, effect " << effect;
      EXPECT_NEAR(e.log_evidence, exact, 0.02) << d << " parameters, effect " << effect;
      EXPECT_GT(e.effective_samples, 0.3 * e.samples);
      EXPECT_LT(e.error, 0.02);
    }
  }
}

TEST(Evidence, PosteriorOfALinearGaussianModel) {
  const LinearWorld world(10, 3, 1, 7);
  Random random(4, 4);
  const Vector data = world.draw(world.mean_of(-1), world.covariance_of(-1), random);
  const Evidence e = of_effect(world, data, -1);
  const Matrix gain =
      world.sensitivity.transpose() * Cholesky(world.covariance).solve(Matrix::Identity(10, 10));
  const Matrix covariance = (Matrix::Identity(3, 3) + gain * world.sensitivity).inverse();
  const Vector mean = covariance * gain * (data - world.centre);
  for (int j = 0; j < 3; ++j) {
    const double sd = std::sqrt(covariance(j, j));
    EXPECT_NEAR(e.mode[j], mean[j], 1e-4);
    EXPECT_NEAR(e.mean[j], mean[j], 0.02 * sd);
    EXPECT_NEAR(std::sqrt(e.covariance(j, j)), sd, 0.03 * sd);
    EXPECT_NEAR(e.draws.row(j).mean(), mean[j], 4.0 * sd / std::sqrt(200.0));
  }
}

/// The integral over one score by the trapezium rule, exact to rounding for smooth functions.
double by_quadrature(const std::function<double(double)> &log_likelihood) {
  double sum = 0.0;
  const double step = 1e-3;
  for (double x = -10.0; x <= 10.0; x += step)
    sum += step * std::exp(log_likelihood(x) - 0.5 * x * x) / std::sqrt(2.0 * kPi);
  return std::log(sum);
}

TEST(Evidence, HeavyTailsTwoModesAndEdgesAgainstQuadrature) {
  const std::function<double(double)> cases[] = {
      [](double x) { return log_student_t(std::pow((x - 1.5) / 0.3, 2), 0.0, 1, 4.0); },
      [](double x) {
        return std::log(std::exp(-0.5 * std::pow((x - 2.0) / 0.2, 2)) +
                        0.5 * std::exp(-0.5 * std::pow((x + 2.0) / 0.1, 2)));
      },
      [](double x) { // a uniform amplitude whose best value is its bound
        const double a = 0.5 * std::erfc(-x / std::sqrt(2.0));
        return -0.5 * std::pow((a + 0.3) / 0.1, 2);
      }};
  for (const auto &f : cases) {
    const Evidence e = evidence(1, [&](const Vector &x) { return f(x[0]); }, {});
    EXPECT_NEAR(e.log_evidence, by_quadrature(f), 0.02) << e.effective_samples;
  }
}

// A bent ridge that no Gaussian follows: y = x^2 within 0.15. A hundred independent points that
// count of 1024 would scatter ln Z by sqrt(1/100 - 1/1024) = 0.095; half of it, for they are Sobol
// points.
TEST(Evidence, BentRidgeAgainstQuadrature) {
  const auto ridge = [](double x, double y) { return -0.5 * std::pow((y - x * x) / 0.15, 2); };
  const double step = 0.01;
  double sum = 0.0, first = 0.0;
  for (double x = -5.0; x <= 5.0; x += step)
    for (double y = -5.0; y <= 5.0; y += step) {
      const double here = step * step * std::exp(ridge(x, y) - 0.5 * (x * x + y * y)) / (2.0 * kPi);
      sum += here;
      first += here * y;
    }
  const Evidence e = evidence(2, [&](const Vector &x) { return ridge(x[0], x[1]); }, {});
  EXPECT_NEAR(e.log_evidence, std::log(sum), 0.05);
  EXPECT_NEAR(e.mean[1], first / sum, 0.05);
  EXPECT_GT(e.effective_samples, 0.1 * e.samples);
}

TEST(Evidence, WithoutParametersIsTheLikelihood) {
  EXPECT_EQ(evidence(0, [](const Vector &) { return -3.5; }, {}).log_evidence, -3.5);
}

TEST(SobolPoints, AreEvenAndShiftedAndTheSameEveryTime) {
  const Matrix p = sobol_points(5, 1023, 0); // with the origin left out the mean is exact
  for (int j = 0; j < 5; ++j) {
    EXPECT_NEAR(p.row(j).mean(), 0.5, 1e-12);
    EXPECT_GT(p.row(j).minCoeff(), 0.0);
  }
  EXPECT_EQ(sobol_points(3, 64, 9), sobol_points(3, 64, 9));
  EXPECT_NE(sobol_points(3, 64, 9), sobol_points(3, 64, 10));
  EXPECT_NEAR(sobol_normals(2, 1023, 0).row(1).squaredNorm() / 1023, 1.0, 0.02);
}

} // namespace
} // namespace calendem::inference
