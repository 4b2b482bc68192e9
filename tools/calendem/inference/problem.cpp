// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/problem.h"
#include "inference/scatter.h"
#include <boost/math/distributions/chi_squared.hpp>

namespace calendem::inference {
namespace {

constexpr double kStep = 0.05; // of sensitivities, in standard deviations of the prior

} // namespace

Problem without_effect(const Problem &problem, int effect) {
  Problem out = problem;
  out.effects.erase(out.effects.begin() + effect);
  out.predict = [predict = problem.predict, effect](const Vector &base,
                                                    const std::vector<Applied> &on) {
    std::vector<Applied> among_all = on;
    for (Applied &a : among_all)
      a.effect += a.effect >= effect;
    return predict(base, among_all);
  };
  return out;
}

Vector drawn(const Problem &problem, const Vector &base, const std::vector<Applied> &on,
             Random &random) {
  const Prediction p = problem.predict(base, on);
  Vector normal(p.mean.size());
  for (double &v : normal)
    v = random.normal();
  const double nu = problem.degrees_of_freedom, u = random.uniform();
  const double stretch =
      nu < kNormal ? std::sqrt(nu / quantile(boost::math::chi_squared(nu), u)) : 1.0;
  const Cholesky factor(covariance_about(problem, p));
  return p.mean + factor.matrixL() * Vector(stretch * normal);
}

Matrix emulator_errors(const Problem &problem, const Vector &variance) {
  if (problem.correlation.size() == 0)
    return variance.asDiagonal();
  const Vector sd = variance.cwiseSqrt();
  return sd.asDiagonal() * problem.correlation * sd.asDiagonal();
}

Matrix covariance_about(const Problem &problem, const Prediction &prediction) {
  return problem.measurement + problem.scatter + emulator_errors(problem, prediction.variance);
}

Linearised linearise(const Problem &problem, const Vector &base) {
  Linearised l;
  l.at = base;
  const Prediction here = problem.predict(base, {});
  l.mean = here.mean;
  l.covariance = covariance_about(problem, here);
  l.sensitivity.resize(here.mean.size(), base.size());
  Vector moved = base;
  for (Eigen::Index j = 0; j < base.size(); ++j) {
    moved[j] = base[j] + kStep;
    const Vector above = problem.predict(moved, {}).mean;
    moved[j] = base[j] - kStep;
    l.sensitivity.col(j) = (above - problem.predict(moved, {}).mean) / (2.0 * kStep);
    moved[j] = base[j];
  }
  return l;
}

Matrix beyond_recalibration(const Linearised &base, const Matrix &discrepancy) {
  if (base.sensitivity.cols() == 0)
    return discrepancy;
  const Matrix weighted = Cholesky(base.covariance).solve(base.sensitivity);
  Matrix normal = base.sensitivity.transpose() * weighted;
  normal.diagonal().array() += 1e-10 * (1.0 + normal.trace());
  const Matrix onto = base.sensitivity * Cholesky(normal).solve(weighted.transpose());
  const Matrix off = Matrix::Identity(onto.rows(), onto.cols()) - onto;
  return off * discrepancy * off.transpose();
}

Matrix recalibrated_covariance(const Linearised &base) {
  return base.covariance + base.sensitivity * base.sensitivity.transpose();
}

} // namespace calendem::inference
