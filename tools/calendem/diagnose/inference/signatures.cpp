// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/signatures.h"
#include "diagnose/inference/quasi_newton.h"

namespace calendem::inference {
namespace {

double log_determinant(const Cholesky &factor) {
  return 2.0 * Matrix(factor.matrixL()).diagonal().array().log().sum();
}

} // namespace

Signatures::Signatures(const Problem &problem, const Linearised &base)
    : problem_(problem), base_(base), factor_(recalibrated_covariance(base)),
      base_variance_(problem.predict(base.at, {}).variance) {}

Vector Signatures::raw(const std::vector<Applied> &on) const {
  return problem_.predict(base_.at, on).mean - base_.mean;
}

Vector Signatures::white(const std::vector<Applied> &on) const {
  return factor_.matrixL().solve(raw(on));
}

Signature Signatures::off() const {
  return {{}, Vector::Zero(base_.mean.size()), {}, 0.0, double(base_.mean.size())};
}

Signature Signatures::of(const std::vector<Applied> &on) const {
  const Prediction p = problem_.predict(base_.at, on);
  Signature s = off();
  s.on = on;
  s.mean = factor_.matrixL().solve(p.mean - base_.mean);
  const Vector variance = (p.variance - base_variance_).cwiseMax(0.0);
  if (variance.maxCoeff() == 0.0)
    return s;
  const auto identity = Matrix::Identity(variance.size(), variance.size());
  const Matrix half = factor_.matrixL().solve(emulator_errors(problem_, variance));
  const Cholesky sum(Matrix(identity + factor_.matrixL().solve(half.transpose())));
  s.precision = sum.solve(identity);
  s.log_determinant = log_determinant(sum);
  s.trace = s.precision.trace();
  return s;
}

double Signatures::absorbed(const std::vector<Applied> &on) const {
  const Vector s = raw(on);
  const double before = s.dot(Cholesky(base_.covariance).solve(s));
  return before > 0.0 ? 1.0 - s.dot(factor_.solve(s)) / before : 0.0;
}

double Signatures::odds(const Signature &truth, const Signature &rival) {
  const Vector apart = rival.mean - truth.mean;
  const double square =
      rival.precision.size() == 0 ? apart.squaredNorm() : apart.dot(rival.precision * apart);
  return 0.5 * (square + rival.log_determinant - truth.log_determinant + rival.trace - truth.trace);
}

double Signatures::odds_recalibrated(const Signature &truth, const Signature &rival) const {
  if (base_.at.size() == 0)
    return odds(truth, rival);
  const Vector seen = problem_.predict(base_.at, truth.on).mean;
  const Prediction unmoved = problem_.predict(base_.at, rival.on);
  const Matrix covariance = covariance_about(problem_, unmoved);
  const double usual = log_determinant(Cholesky(covariance));
  const auto square = [&](const Vector &scores, Vector &gradient) {
    const Prediction p = problem_.predict(scores, rival.on);
    Slopes slopes = slopes_of(problem_, scores, rival.on);
    const auto n = scores.size(); // what the rival's own amplitude does is not asked
    slopes = {slopes.mean.leftCols(n), slopes.variance.leftCols(n)};
    const Misfit m = misfit_of(problem_, seen, p, covariance_about(problem_, p), slopes);
    gradient = m.square_slopes + m.determinant_slopes + 2.0 * (scores - base_.at);
    return m.square + m.log_determinant - usual + (scores - base_.at).squaredNorm();
  };
  Vector unused(base_.at.size());
  const Matrix &s = base_.sensitivity;
  const Vector linear =
      base_.at +
      s.transpose() * Cholesky(covariance + s * s.transpose()).solve(seen - unmoved.mean);
  const Vector start = square(linear, unused) < square(base_.at, unused) ? linear : base_.at;
  const double least = minimise(square, start).value;
  return 0.5 * (least + rival.log_determinant - truth.log_determinant + rival.trace - truth.trace);
}

} // namespace calendem::inference
