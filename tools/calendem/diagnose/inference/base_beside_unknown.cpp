// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/base_beside_unknown.h"
#include "base/random.h"
#include "diagnose/inference/scatter.h"
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr std::uint64_t kPurpose = 0xba5e; // of the stream of draws
constexpr int kCandidates = 16;            // of each draw
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

/// The linear posterior.
struct Line {
  Vector mean;
  Matrix root; ///< of its covariance

  Line(const Problem &problem, const Beside &beside, const Linearised &about) {
    const Prediction p = problem.predict(about.at, beside.on);
    const auto n = about.at.size();
    const Cholesky covariance(covariance_about(problem, p) + beside.discrepancy);
    const Matrix weights = covariance.solve(about.sensitivity).transpose();
    const Cholesky precision(Matrix::Identity(n, n) + weights * about.sensitivity);
    mean = precision.solve(weights * (problem.observed - p.mean + about.sensitivity * about.at));
    root = precision.matrixL().transpose().solve(Matrix::Identity(n, n));
  }
};

/// The base model about the middle of the posterior beside this draw: Gauss and Newton's steps.
Linearised middle(const Problem &problem, const Beside &beside, const Vector &start) {
  Linearised about = linearise(problem, start);
  for (int step = 0; step < kSteps; ++step)
    about = linearise(problem, Line(problem, beside, about).mean);
  return about;
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

Matrix spread_over(const Matrix &draws, Eigen::Index count) {
  Matrix out(draws.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k)
    out.col(k) = draws.col((2 * k + 1) * draws.cols() / (2 * count));
  return out;
}

Matrix base_beside_unknown(const Problem &problem, const Judged &unknown, const Matrix &anywhere,
                           Eigen::Index count) {
  const Hypothesis &h = unknown.hypothesis;
  const auto beside_at = [&](const Vector &scores) {
    const double size = h.size > 0.0 ? h.size : kUnknownSize.value(scores[scores.size() - 1]);
    return Beside{applied_at(problem, h, scores), size * size * anywhere};
  };
  const Vector &mode = unknown.evidence.mode;
  const Linearised about = middle(problem, beside_at(mode), mode.head(problem.base_parameters));
  const Matrix draws = spread_over(unknown.evidence.draws, count);
  Random random(0, kPurpose);
  Matrix out(problem.base_parameters, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Beside beside = beside_at(draws.col(k));
    out.col(k) = one_of(problem, beside, Line(problem, beside, about), random);
  }
  return out;
}

} // namespace calendem::inference
