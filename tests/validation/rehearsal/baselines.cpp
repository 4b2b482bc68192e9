// SPDX-License-Identifier: GPL-2.0-or-later
#include "baselines.h"
#include "inference/likelihood.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace calendem {
namespace {

using Eigen::Index;
using inference::Cholesky;
using inference::Matrix;
using inference::Vector;

constexpr double kParallel = 0.85, kBeyond = 3.0, kStrongBic = 6.0, kChance = 0.05;
constexpr int kDraws = 512;

Answer by_cosine(const Diagnosis &d, const std::vector<Candidate> &all) {
  Answer out{"cosine", {}, true};
  const auto at = first_datum(d), n = Index(d.readings.size());
  const Cholesky errors(Matrix(d.model.expected.block(at, at, n, n)));
  const Vector residual = errors.matrixL().solve(Vector(d.model.residual.segment(at, n)));
  if (inference::chance_beyond(residual.squaredNorm(), int(n), inference::kNormal) > kChance)
    return out;
  const Matrix changes = errors.matrixL().solve(mean_changes(d, all));
  double best = kParallel;
  for (Index k = 0; k < changes.cols(); ++k) {
    const double cosine = residual.dot(changes.col(k)) / (residual.norm() * changes.col(k).norm());
    if (cosine >= best) {
      best = cosine;
      out.named = {name_of(d, all[std::size_t(k) + 1].change)};
    }
  }
  return out;
}

/// Least over prior draws of the largest deviation of a reading in its errors.
double implausibility(const Diagnosis &d, const Candidate &c) {
  const Matrix all =
      inference::sobol_normals(d.of.problem.parameters + int(c.acting.size()), kDraws, 1);
  const inference::FilmPredictions p = predicted_with(d, c, all.topRows(d.of.problem.parameters),
                                                      all.bottomRows(Index(c.acting.size())));
  const inference::FilmData &film = d.of.problem.films[std::size_t(d.film)];
  double least = std::numeric_limits<double>::infinity();
  for (Index m = 0; m < p.mean.cols(); ++m) {
    Vector variance = film.measurement.diagonal() + film.fixed.diagonal() + p.variance.col(m);
    if (p.scatter.size() > 0)
      variance += p.scatter.col(m);
    for (const Matrix &e : p.errors)
      variance += e.col(m).cwiseAbs2();
    variance += film.shared_errors.rowwise().squaredNorm();
    least = std::min(
        least,
        (film.observed - p.mean.col(m)).cwiseAbs().cwiseQuotient(variance.cwiseSqrt()).maxCoeff());
  }
  return least;
}

Answer by_history(const Diagnosis &d, const std::vector<Candidate> &all) {
  Answer out{"history matching", {}, false};
  if (implausibility(d, all.front()) <= kBeyond)
    return out;
  for (const Candidate &c : all)
    if (c.change >= 0 && implausibility(d, c) <= kBeyond)
      out.named.push_back(name_of(d, c.change));
  out.sure = out.named.size() == 1;
  return out;
}

/// Largest ln likelihood that the draws of a fitted model have.
double best_fit(const Diagnosis &d, const Candidate &c) {
  inference::SamplerSettings few;
  few.particles = 64;
  few.final_sweeps = 8;
  const inference::PosteriorProblem alone =
      inference::problem_of_model(d.of.problem, c.acting, d.film);
  const inference::Posterior posterior = inference::sample_posterior(alone, few);
  const auto states = inference::film_states(alone, posterior.draws);
  double best = -INFINITY;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const inference::Residuals r =
        inference::residuals_of(alone, {d.film}, states[k], posterior.draws[k]);
    const Cholesky factor(r.covariance);
    best = std::max(best, -0.5 * factor.matrixL().solve(r.residual).squaredNorm() -
                              factor.matrixLLT().diagonal().array().log().sum());
  }
  return best;
}

std::vector<Answer> by_likelihood(const Diagnosis &d, const std::vector<Candidate> &all) {
  Answer bic{"BIC", {}, true}, ratio{"likelihood ratio", {}, true};
  const double model = best_fit(d, all.front()),
               per_parameter = std::log(double(d.readings.size()));
  double least = -kStrongBic, largest = 0.0;
  for (const Candidate &c : all) {
    if (c.change < 0)
      continue;
    const double gain = 2.0 * (best_fit(d, c) - model),
                 more = double(c.acting.size()) - double(all.front().acting.size());
    if (more * per_parameter - gain < least) {
      least = more * per_parameter - gain;
      bic.named = {name_of(d, c.change)};
    }
    const double trials = double(all.size() - 1);
    if (more > 0.0 && gain > largest &&
        trials * inference::chance_beyond(gain, 1, inference::kNormal) < kChance) {
      largest = gain;
      ratio.named = {name_of(d, c.change)};
    }
  }
  return {bic, ratio};
}

} // namespace

std::vector<Answer> baseline_answers(const Diagnosis &d) {
  const std::vector<Candidate> all = candidates_of(d);
  std::vector<Answer> out = {by_cosine(d, all), by_history(d, all), by_robust_likelihood(d, all)};
  for (const auto &several : {by_likelihood(d, all), by_augmentations(d, all)})
    out.insert(out.end(), several.begin(), several.end());
  return out;
}

} // namespace calendem
