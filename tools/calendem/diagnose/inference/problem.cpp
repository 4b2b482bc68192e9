// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/problem.h"
#include "diagnose/inference/scatter.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr double kScoreStep = 1e-4; // of differences, in standard deviations of the prior

Slopes by_differences(const Problem &problem, const Vector &base, const std::vector<Applied> &on) {
  Vector at = base;
  std::vector<Applied> with = on;
  std::vector<double *> scores;
  for (double &v : at)
    scores.push_back(&v);
  for (Applied &a : with)
    for (double &v : a.scores)
      scores.push_back(&v);
  const auto features = Eigen::Index(problem.features.size()), n = Eigen::Index(scores.size());
  Slopes s{Matrix(features, n), Matrix(features, n), {}, problem.predict(base, on)};
  if (s.here.scatter.size() > 0)
    s.scatter.resize(features, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    double &moved = *scores[std::size_t(j)];
    const double here = moved;
    moved = here + kScoreStep;
    const Prediction above = problem.predict(at, with);
    moved = here - kScoreStep;
    const Prediction below = problem.predict(at, with);
    moved = here;
    s.mean.col(j) = (above.mean - below.mean) / (2.0 * kScoreStep);
    s.variance.col(j) = (above.variance - below.variance) / (2.0 * kScoreStep);
    if (s.scatter.size() > 0)
      s.scatter.col(j) = (above.scatter - below.scatter) / (2.0 * kScoreStep);
  }
  return s;
}

/// A covariance of elements sd r sd of two features.
Matrix scaled_by(const Matrix &correlation, const Vector &variance) {
  const Vector sd = variance.cwiseSqrt();
  return sd.asDiagonal() * correlation * sd.asDiagonal();
}

/// What such a covariance adds to the derivatives of a misfit.
void add_slopes(const Matrix &correlation, const Vector &variance, const Matrix &along,
                const Vector &pulled, const Matrix &inverse, Misfit &m) {
  const Vector sd = variance.cwiseSqrt();
  const Vector inverse_sd = (sd.array() > 0.0).select(sd.cwiseInverse(), 0.0);
  const Matrix sd_slopes = 0.5 * inverse_sd.asDiagonal() * along;
  const Vector of_square = (correlation * pulled.cwiseProduct(sd)).cwiseProduct(pulled);
  const Vector of_determinant = inverse.cwiseProduct(correlation) * sd;
  m.square_slopes -= 2.0 * sd_slopes.transpose() * of_square;
  m.determinant_slopes += 2.0 * sd_slopes.transpose() * of_determinant;
}

Matrix correlation_of(const Problem &problem, Eigen::Index features) {
  return problem.correlation.size() > 0 ? problem.correlation
                                        : Matrix::Identity(features, features);
}

} // namespace

Problem without_effect(const Problem &problem, int effect) {
  Problem out = problem;
  out.effects.erase(out.effects.begin() + effect);
  const auto among_all = [effect](std::vector<Applied> on) {
    for (Applied &a : on)
      a.effect += a.effect >= effect;
    return on;
  };
  out.predict = [predict = problem.predict, among_all](const Vector &base,
                                                       const std::vector<Applied> &on) {
    return predict(base, among_all(on));
  };
  if (problem.slopes)
    out.slopes = [slopes = problem.slopes, among_all](const Vector &base,
                                                      const std::vector<Applied> &on) {
      return slopes(base, among_all(on));
    };
  return out;
}

double PointNoise::times_stated() const {
  const double spread = 2.0 / (9.0 * double(measured.size()));
  const double square = std::pow(score * std::sqrt(spread) + 1.0 - spread, 3.0); // q / k
  return std::sqrt(std::max(0.0, 1.0 + (square - 1.0) / measured.mean()));
}

Slopes slopes_of(const Problem &problem, const Vector &base, const std::vector<Applied> &on) {
  return problem.slopes ? problem.slopes(base, on) : by_differences(problem, base, on);
}

Misfit misfit_of(const Problem &problem, const Vector &observed, const Prediction &prediction,
                 const Matrix &covariance, const Slopes &slopes) {
  const Cholesky factor(covariance);
  const Vector apart = observed - prediction.mean, pulled = factor.solve(apart);
  Misfit m;
  m.square = apart.dot(pulled);
  m.log_determinant = 2.0 * Matrix(factor.matrixL()).diagonal().array().log().sum();
  const Matrix inverse = factor.solve(Matrix::Identity(apart.size(), apart.size()));
  m.square_slopes = -2.0 * slopes.mean.transpose() * pulled;
  m.determinant_slopes = Vector::Zero(m.square_slopes.size());
  add_slopes(correlation_of(problem, apart.size()), prediction.variance, slopes.variance, pulled,
             inverse, m);
  if (prediction.scatter.size() > 0)
    add_slopes(problem.added_scatter, prediction.scatter, slopes.scatter, pulled, inverse, m);
  return m;
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

Matrix errors_of(const Problem &problem, const Prediction &prediction) {
  Matrix out = scaled_by(correlation_of(problem, prediction.variance.size()), prediction.variance);
  if (prediction.scatter.size() > 0)
    out += scaled_by(problem.added_scatter, prediction.scatter);
  return out;
}

Matrix covariance_about(const Problem &problem, const Prediction &prediction) {
  return problem.measurement + problem.scatter + errors_of(problem, prediction);
}

Linearised linearise(const Problem &problem, const Vector &base) {
  Linearised l;
  l.at = base;
  const Slopes here = slopes_of(problem, base, {});
  l.mean = here.here.mean;
  l.covariance = covariance_about(problem, here.here);
  l.sensitivity = here.mean;
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
