// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/base_beside_unknown.h"
#include "base/random.h"

namespace calendem::inference {
namespace {

constexpr std::uint64_t kPurpose = 0xba5e; // of the stream of draws

/// Standard deviations of the discrepancy at one draw.
double size_at(const Hypothesis &hypothesis, const Vector &scores) {
  return hypothesis.size > 0.0 ? hypothesis.size : kUnknownSize.value(scores[scores.size() - 1]);
}

/// What the effects beside it add, at one draw.
Vector shift_at(const Problem &problem, const Hypothesis &hypothesis, const Vector &scores) {
  if (hypothesis.on.empty())
    return Vector::Zero(problem.observed.size());
  const Vector at = scores.head(problem.base_parameters);
  return problem.predict(at, applied_at(problem, hypothesis, scores)).mean -
         problem.predict(at, {}).mean;
}

} // namespace

Matrix base_beside_unknown(const Problem &problem, const Linearised &base, const Judged &unknown,
                           const Matrix &anywhere) {
  const Matrix &draws = unknown.evidence.draws;
  const Eigen::Index n = problem.base_parameters;
  const Vector from_centre = problem.observed - base.mean + base.sensitivity * base.at;
  Random random(0, kPurpose);
  Matrix out(n, draws.cols());
  Vector normal(n);
  for (Eigen::Index k = 0; k < draws.cols(); ++k) {
    const Vector scores = draws.col(k);
    const double size = size_at(unknown.hypothesis, scores);
    const Cholesky covariance(base.covariance + size * size * anywhere);
    const Matrix weights = covariance.solve(base.sensitivity).transpose();
    const Cholesky precision(Matrix::Identity(n, n) + weights * base.sensitivity);
    for (double &v : normal)
      v = random.normal();
    out.col(k) =
        precision.solve(weights * (from_centre - shift_at(problem, unknown.hypothesis, scores))) +
        precision.matrixL().transpose().solve(normal);
  }
  return out;
}

} // namespace calendem::inference
