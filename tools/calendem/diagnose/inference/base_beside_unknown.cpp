// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/base_beside_unknown.h"
#include "diagnose/inference/hypothesis.h"
#include "diagnose/inference/scatter.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr int kCandidates = 16; // of each draw
constexpr double kDegreesBeside =
    6.0;                  // of their t distribution: tails heavier than the posterior's
constexpr int kSteps = 5; // towards where the posterior is largest

/// One draw of the unknown, whose base parameters are to be drawn.
struct Beside {
  const Problem &problem;
  const Hypothesis &hypothesis;
  const Likelihood &likelihood; ///< with the discrepancy anywhere
  Vector scores;

  Vector with(const Vector &base) const {
    Vector out = scores;
    out.head(base.size()) = base;
    return out;
  }
};

/// The posterior of the model that is linear about a point.
struct Line {
  Vector mean;
  Matrix root; ///< of its covariance

  Line(const Beside &beside, const Vector &at) {
    const Vector scores = beside.with(at);
    const Problem &problem = beside.problem;
    const Slopes all = slopes_of(problem, at, applied_at(problem, beside.hypothesis, scores));
    const auto n = at.size();
    const Matrix slopes = all.mean.leftCols(n);
    const Cholesky covariance(beside.likelihood.covariance(scores, all.here));
    const Matrix weights = covariance.solve(slopes).transpose();
    const Cholesky precision(Matrix::Identity(n, n) + weights * slopes);
    mean = precision.solve(weights * (problem.observed - all.here.mean + slopes * at));
    root = precision.matrixL().transpose().solve(Matrix::Identity(n, n));
  }
};

/// Mode of the posterior beside this draw: Gauss and Newton's steps.
Vector middle(const Beside &beside, Vector at) {
  for (int step = 0; step < kSteps; ++step)
    at = Line(beside, at).mean;
  return at;
}

Vector one_of(const Beside &beside, const Line &line, Random &random) {
  const auto n = line.mean.size();
  const boost::math::chi_squared squares(kDegreesBeside);
  Matrix all(n, kCandidates);
  Vector weight(kCandidates);
  for (int c = 0; c < kCandidates; ++c) {
    Vector off(n);
    for (double &v : off)
      v = random.normal();
    off *= std::sqrt(kDegreesBeside / quantile(squares, random.uniform()));
    all.col(c) = line.mean + line.root * off;
    weight[c] = beside.likelihood.log(beside.with(all.col(c))) - 0.5 * all.col(c).squaredNorm() -
                log_student_t(off.squaredNorm(), 0.0, int(n), kDegreesBeside);
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
  const Likelihood likelihood(problem, unknown.hypothesis, anywhere);
  const auto beside_at = [&](const Vector &scores) {
    return Beside{problem, unknown.hypothesis, likelihood, scores};
  };
  const Vector &mode = unknown.evidence.mode;
  const Vector about = middle(beside_at(mode), mode.head(problem.base_parameters));
  const Matrix draws = spread_over(unknown.evidence.draws, count, random);
  Matrix out(problem.base_parameters, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Beside beside = beside_at(draws.col(k));
    out.col(k) = one_of(beside, Line(beside, about), random);
  }
  return out;
}

} // namespace calendem::inference
