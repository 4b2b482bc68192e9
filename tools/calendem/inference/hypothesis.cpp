// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/hypothesis.h"
#include "inference/scatter.h"

namespace calendem::inference {

const Prior kUnknownSize{Prior::log_uniform, 1.0, 30.0};
const Prior kNoiseFactor{Prior::log_uniform, 1.5, 5.0};

Likelihood::Likelihood(const Problem &problem, const Hypothesis &hypothesis, const Matrix &unknown)
    : problem_(problem), hypothesis_(hypothesis), unknown_(unknown) {}

int Likelihood::dimension() const {
  int n = problem_.base_parameters;
  for (const int e : hypothesis_.on)
    n += int(problem_.effects[e].parameters.size());
  return n + (hypothesis_.kind == Hypothesis::noise || hypothesis_.kind == Hypothesis::unknown);
}

Prediction Likelihood::predict(const Vector &scores) const {
  std::vector<Applied> on;
  Eigen::Index next = problem_.base_parameters;
  for (const int e : hypothesis_.on) {
    const auto n = Eigen::Index(problem_.effects[e].parameters.size());
    on.push_back({e, scores.segment(next, n)});
    next += n;
  }
  return problem_.predict(scores.head(problem_.base_parameters), on);
}

Matrix Likelihood::covariance(const Vector &scores, const Prediction &prediction) const {
  Matrix total = covariance_about(problem_, prediction);
  if (hypothesis_.kind == Hypothesis::noise) {
    const double factor = kNoiseFactor.value(scores[scores.size() - 1]);
    total += (factor * factor - 1.0) * problem_.measurement;
  } else if (hypothesis_.kind == Hypothesis::unknown) {
    const double sd = kUnknownSize.value(scores[scores.size() - 1]);
    total += sd * sd * unknown_;
  }
  return total;
}

double Likelihood::log(const Vector &scores) const {
  const Prediction p = predict(scores);
  const Cholesky factor(covariance(scores, p));
  const Matrix lower = factor.matrixL();
  const double square = factor.matrixL().solve(problem_.observed - p.mean).squaredNorm();
  return log_student_t(square, 2.0 * lower.diagonal().array().log().sum(), int(p.mean.size()),
                       problem_.degrees_of_freedom);
}

double Likelihood::square(const Vector &scores) const {
  const Prediction p = predict(scores);
  const Cholesky factor(covariance(scores, p));
  return factor.matrixL().solve(problem_.observed - p.mean).squaredNorm();
}

} // namespace calendem::inference
