// SPDX-License-Identifier: GPL-2.0-or-later
// Methods that let every observable be off by itself, beside the changes of effects.
#include "baselines.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace calendem {
namespace {

using Eigen::Index;
using inference::Cholesky;
using inference::Matrix;
using inference::Vector;

constexpr double kLevel = 0.05; // of the corrected p-value

/// The image of a standard normal score that has a Laplace distribution of scale 1.
double laplace(double score) {
  return std::copysign(-std::log(std::erfc(std::fabs(score) / std::sqrt(2.0))), score);
}

/// ln evidence of a candidate if each observable of the film is off by an amount of its own.
double robust_evidence(const Diagnosis &d, const Candidate &c) {
  inference::PosteriorProblem alone = inference::problem_of_model(d.of.problem, c.acting, d.film);
  const Matrix deviations = deviations_of(d);
  const Index own = alone.parameters;
  alone.degrees_of_freedom = inference::kNormal;
  alone.parameters += int(deviations.cols());
  alone.predict = [deviations, own, at = d.film, predict = alone.predict](
                      int film, const Matrix &scores, const Matrix &amplitudes) {
    inference::FilmPredictions out = predict(film, scores.topRows(own), amplitudes);
    if (film == at)
      out.mean += deviations * scores.bottomRows(deviations.cols()).unaryExpr(&laplace);
    return out;
  };
  inference::SamplerSettings few;
  few.particles = 64;
  few.final_sweeps = few.keep_every = 1;
  return inference::sample_posterior(alone, few).log_evidence;
}

} // namespace

Answer by_robust_likelihood(const Diagnosis &d, const std::vector<Candidate> &all) {
  Answer out{"robust BSL", {}, true};
  const double model = robust_evidence(d, all.front());
  double sum = 1.0, largest = 0.0;
  for (const Candidate &c : all) {
    if (c.change < 0)
      continue;
    const double prior = d.changes.all[std::size_t(c.change)].prior,
                 bayes_factor = std::exp(robust_evidence(d, c) - model),
                 odds = prior / (1.0 - prior) * bayes_factor;
    sum += odds;
    if (odds > largest) {
      largest = odds;
      out.named.clear();
      if (bayes_factor >= inference::kStrong)
        out.named = {name_of(d, c.change)};
    }
  }
  if (largest < inference::kCertain * sum)
    out.named.clear();
  return out;
}

namespace {

/// Residuals of worlds in which the recalibrated model is true, with the tails of the problem's errors.
Matrix worlds_of(const Diagnosis &d, const Matrix &expected) {
  Matrix out = inference::noise_of(expected);
  const double nu = d.of.problem.degrees_of_freedom;
  for (Index w = 0; w < out.cols(); ++w)
    out.col(w) *= std::sqrt(
        nu / quantile(boost::math::chi_squared(nu), (double(w) + 0.5) / double(out.cols())));
  return out;
}

/// Filters of shapes: what they make of a residual is standard normal where the model is true, and its square
/// the statistic of the ratio of likelihoods for a shape of free size. A linear recalibration of data x
/// with errors C leaves r = C S^-1 x, S including what the parameters vary: C^-1 s of r is S^-1 s of x.
Matrix matched_filters(const Matrix &errors, const Matrix &expected, const Matrix &shapes) {
  Matrix out = Cholesky(errors).solve(shapes);
  for (auto filter : out.colwise())
    filter /= std::sqrt(std::max(1e-300, filter.dot(expected * filter)));
  return out;
}

/// Share of the worlds in which a statistic is at least as large, of each row and column.
Matrix shares_beyond(const Matrix &statistics, const Matrix &of_worlds) {
  Matrix out(statistics.rows(), statistics.cols());
  for (Index i = 0; i < out.rows(); ++i) {
    Vector sorted = of_worlds.row(i);
    std::sort(sorted.begin(), sorted.end());
    for (Index k = 0; k < out.cols(); ++k)
      out(i, k) =
          double(sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), statistics(i, k))) /
          double(sorted.size());
  }
  return out;
}

} // namespace

std::vector<Answer> by_augmentations(const Diagnosis &d, const std::vector<Candidate> &all) {
  const auto at = first_datum(d), n = Index(d.readings.size()), effects = Index(all.size()) - 1;
  const Matrix expected = d.model.expected.block(at, at, n, n);
  Matrix shapes(n, effects + Index(d.blocks.size()));
  shapes << mean_changes(d, all), deviations_of(d);
  const Matrix filters = matched_filters(d.model.covariance.block(at, at, n, n), expected, shapes);
  const auto tested = [&](const Matrix &residuals) { // effects have one sign, deviations either
    Matrix t = filters.transpose() * residuals;
    t.topRows(effects) = t.topRows(effects).cwiseMax(0.0);
    return Matrix(t.cwiseAbs2());
  };
  const Matrix worlds = tested(worlds_of(d, expected)),
               here = tested(d.model.residual.segment(at, n)),
               chances = shares_beyond(here, worlds);
  const Matrix least = shares_beyond(worlds, worlds).colwise().minCoeff();
  Index first = 0;
  for (Index i = 1; i < here.rows(); ++i)
    if (std::make_pair(chances(i), -here(i)) < std::make_pair(chances(first), -here(first)))
      first = i;
  Answer one{"augmented", {}, true}, sum{"augmented sum", {}, false};
  if ((least.array() <= chances(first)).cast<double>().mean() < kLevel)
    one.named = {first < effects ? name_of(d, all[std::size_t(first) + 1].change) : "unknown"};
  if (shares_beyond(here.colwise().sum(), worlds.colwise().sum())(0) < kLevel)
    sum.named = {"unknown"};
  return {one, sum};
}

} // namespace calendem
