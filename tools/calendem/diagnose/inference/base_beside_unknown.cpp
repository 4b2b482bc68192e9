// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/base_beside_unknown.h"
#include "diagnose/inference/scatter.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr int kCandidates = 16;  // of each draw
constexpr double kDegrees = 6.0; // of their t distribution: tails heavier than the posterior's
constexpr int kSteps = 5;        // towards where the posterior is largest

/// What is the same for all candidates of one draw of the unknown.
struct Beside {
  std::vector<Applied> on;
  Matrix discrepancy;
};

double log_density(const Problem &problem, const Beside &beside, const Vector &scores) {
  const Prediction p = problem.predict(scores, beside.on);
  const Cholesky factor(covariance_about(problem, p) + beside.discrepancy);
  const Matrix lower = factor.matrixL();
  const double square = factor.matrixL().solve(problem.observed - p.mean).squaredNorm();
  return log_student_t(square, 2.0 * lower.diagonal().array().log().sum(), int(p.mean.size()),
                       problem.degrees_of_freedom) -
         0.5 * scores.squaredNorm();
}

/// The posterior of the model that is linear about a point.
struct Line {
  Vector mean;
  Matrix root; ///< of its covariance

  Line(const Problem &problem, const Beside &beside, const Vector &at) {
    const Slopes all = slopes_of(problem, at, beside.on);
    const auto n = at.size();
    const Matrix slopes = all.mean.leftCols(n);
    const Cholesky covariance(covariance_about(problem, all.here) + beside.discrepancy);
    const Matrix weights = covariance.solve(slopes).transpose();
    const Cholesky precision(Matrix::Identity(n, n) + weights * slopes);
    mean = precision.solve(weights * (problem.observed - all.here.mean + slopes * at));
    root = precision.matrixL().transpose().solve(Matrix::Identity(n, n));
  }
};

/// Of the posterior beside this draw: Gauss and Newton's steps.
Vector middle(const Problem &problem, const Beside &beside, Vector at) {
  for (int step = 0; step < kSteps; ++step)
    at = Line(problem, beside, at).mean;
  return at;
}

Vector one_of(const Problem &problem, const Beside &beside, const Line &line, Random &random) {
  const auto n = line.mean.size();
  const boost::math::chi_squared squares(kDegrees);
  Matrix all(n, kCandidates);
  Vector weight(kCandidates);
  for (int c = 0; c < kCandidates; ++c) {
    Vector off(n);
    for (double &v : off)
      v = random.normal();
    off *= std::sqrt(kDegrees / quantile(squares, random.uniform()));
    all.col(c) = line.mean + line.root * off;
    weight[c] = log_density(problem, beside, all.col(c)) -
                log_student_t(off.squaredNorm(), 0.0, int(n), kDegrees);
  }
  weight = (weight.array() - weight.maxCoeff()).exp();
  double left = random.uniform() * weight.sum();
  int taken = 0;
  while (taken < kCandidates - 1 && (left -= weight[taken]) > 0.0)
    ++taken;
  return all.col(taken);
}

} // namespace

Matrix spread_over(const Matrix &draws, Eigen::Index count, Random &random) {
  const double first = random.uniform(), step = double(draws.cols()) / double(count);
  Matrix out(draws.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k)
    out.col(k) = draws.col(std::min(draws.cols() - 1, Eigen::Index((double(k) + first) * step)));
  return out;
}

Matrix base_beside_unknown(const Problem &problem, const Judged &unknown, const Matrix &anywhere,
                           Eigen::Index count, Random &random) {
  const Hypothesis &h = unknown.hypothesis;
  const auto beside_at = [&](const Vector &scores) {
    const double size = h.size > 0.0 ? h.size : kUnknownSize.value(scores[scores.size() - 1]);
    return Beside{applied_at(problem, h, scores), size * size * anywhere};
  };
  const Vector &mode = unknown.evidence.mode;
  const Vector about = middle(problem, beside_at(mode), mode.head(problem.base_parameters));
  const Matrix draws = spread_over(unknown.evidence.draws, count, random);
  Matrix out(problem.base_parameters, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Beside beside = beside_at(draws.col(k));
    out.col(k) = one_of(problem, beside, Line(problem, beside, about), random);
  }
  return out;
}

} // namespace calendem::inference
