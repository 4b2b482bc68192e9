// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/predictive.h"
#include <boost/math/tools/roots.hpp>
#include <numeric>

namespace calendem::inference {
namespace {

using Eigen::Index;

std::vector<int> all_films(const PosteriorProblem &problem) {
  std::vector<int> out(problem.films.size());
  std::iota(out.begin(), out.end(), 0);
  return out;
}

double scale_of_rest(double square, Index data, double degrees) {
  return degrees >= kNormal ? 1.0 : (degrees + square) / (degrees + double(data));
}

/// Scores and amplitudes of the new film under all draws.
FilmPredictions predictions_of(const PosteriorProblem &problem, const Posterior &posterior,
                               const NewData &wanted) {
  const auto count = Index(posterior.draws.size());
  Matrix scores(problem.parameters, count), amplitudes(Index(problem.effects.size()), count);
  for (Index d = 0; d < count; ++d) {
    const Draw &draw = posterior.draws[std::size_t(d)];
    scores.col(d) = draw.scores.col(wanted.material);
    amplitudes.col(d) = wanted.film >= 0 ? amplitudes_of(problem, draw, wanted.film)
                                         : Vector(draw.amplitudes.col(wanted.material));
  }
  return wanted.predict(scores, amplitudes);
}

/// Covariance of the new data's discrepancy and shared errors with those of the films.
Matrix covariance_with(const PosteriorProblem &problem, const Draw &draw, const NewData &wanted,
                       const Residuals &known) {
  const Index rows = std::max(wanted.discrepancy.rows(), wanted.shared_errors.rows());
  Matrix out = Matrix::Zero(rows, known.residual.size());
  const double size = draw.discrepancy * draw.discrepancy;
  for (std::size_t f = 0; f < known.films.size(); ++f) {
    const FilmData &film = problem.films[f];
    auto block = out.middleCols(known.begin[f], known.begin[f + 1] - known.begin[f]);
    if (wanted.shared_errors.size() > 0 && film.shared_errors.size() > 0)
      block += wanted.shared_errors * film.shared_errors.transpose();
    const bool common = wanted.shared_discrepancy.size() > 0 && film.shared_discrepancy.size() > 0;
    if (common)
      block += size * draw.shared *
               (film.material == wanted.material ? 1.0 : draw.material_correlation) *
               wanted.shared_discrepancy * film.shared_discrepancy.transpose();
    if (int(f) == wanted.film && wanted.discrepancy_with.size() > 0)
      block += size * (common ? 1.0 - draw.shared : 1.0) * wanted.discrepancy_with;
  }
  return out;
}

/// Variance of discrepancy, shared errors and readings of the new data before they are conditioned.
Vector variance_before(const Draw &draw, const NewData &wanted, Index rows) {
  Vector out = Vector::Zero(rows);
  const double size = draw.discrepancy * draw.discrepancy;
  const bool common = wanted.shared_discrepancy.size() > 0;
  if (wanted.discrepancy.size() > 0)
    out += size * (common ? 1.0 - draw.shared : 1.0) * wanted.discrepancy.diagonal();
  if (common)
    out += size * draw.shared * wanted.shared_discrepancy.rowwise().squaredNorm();
  if (wanted.shared_errors.size() > 0)
    out += wanted.shared_errors.rowwise().squaredNorm();
  if (wanted.errors.size() > 0)
    out += wanted.errors.diagonal();
  return out;
}

/// A part of the data under one draw, given the rest.
struct Conditional {
  Vector mean, variance;
  double log_density = 0.0;
};

Conditional given_the_rest(const Matrix &precision, const Vector &pull, const Vector &observed,
                           Index at, Index count) {
  const Cholesky factor(precision.block(at, at, count, count));
  const Matrix covariance = factor.solve(Matrix::Identity(count, count));
  const Vector off = covariance * pull.segment(at, count);
  Conditional out;
  out.mean = observed.segment(at, count) - off;
  out.variance = covariance.diagonal();
  out.log_density =
      log_student_t(off.dot(pull.segment(at, count)),
                    -2.0 * factor.matrixLLT().diagonal().array().log().sum(), int(count), kNormal);
  return out;
}

/// A stretch of the films' data, one behind another.
struct Stretch {
  int film, datum;
  Index at, count;
};

/// Weights of the draws without the data, from their logarithms, and what follows from them.
void weigh_without(const Posterior &posterior, const std::vector<double> &logs, LeftOutData &to) {
  const Eigen::Map<const Vector> log(logs.data(), Index(logs.size()));
  const double top = log.maxCoeff();
  Vector weights = (log.array() - top).exp();
  const double sum = weights.sum();
  to.log_density = -top - std::log(sum);
  weights /= sum;
  to.effective = 1.0 / weights.squaredNorm();
  for (std::size_t d = 0; d < posterior.draws.size(); ++d) {
    const double with = posterior.draws[d].weight;
    to.gain += with * std::log(with / std::max(weights[Index(d)], 1e-300));
  }
  for (NormalMixture &m : to.predicted)
    m.weights.assign(weights.begin(), weights.end());
}

std::vector<LeftOutData> leave_out(const PosteriorProblem &problem, const Posterior &posterior,
                                   const std::vector<Stretch> &stretches) {
  const auto states = film_states(problem, posterior.draws);
  std::vector<LeftOutData> out(stretches.size());
  std::vector<std::vector<double>> logs(stretches.size());
  for (std::size_t d = 0; d < posterior.draws.size(); ++d) {
    const Residuals data = residuals_of(problem, all_films(problem), states[d], posterior.draws[d]);
    const Index n = data.residual.size();
    const Matrix precision = Cholesky(data.covariance).solve(Matrix::Identity(n, n));
    const Vector pull = precision * data.residual;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      const Stretch &s = stretches[k];
      const FilmData &film = problem.films[std::size_t(s.film)];
      const Vector observed =
          s.datum < 0 ? film.observed : Vector(film.observed.segment(s.datum, 1));
      Vector shown = Vector::Zero(n);
      shown.segment(s.at, s.count) = observed;
      const Conditional c = given_the_rest(precision, pull, shown, s.at, s.count);
      logs[k].push_back(std::log(posterior.draws[d].weight) - c.log_density);
      out[k].predicted.resize(std::size_t(s.count));
      for (Index i = 0; i < s.count; ++i) {
        out[k].predicted[std::size_t(i)].means.push_back(c.mean[i]);
        out[k].predicted[std::size_t(i)].variances.push_back(c.variance[i]);
      }
    }
  }
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    out[k].film = stretches[k].film;
    out[k].datum = stretches[k].datum;
    weigh_without(posterior, logs[k], out[k]);
  }
  return out;
}

} // namespace

double NormalMixture::mean() const {
  return std::inner_product(weights.begin(), weights.end(), means.begin(), 0.0);
}

double NormalMixture::probability_below(double value) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < means.size(); ++k)
    sum += weights[k] * (variances[k] > 0.0
                             ? 0.5 * std::erfc((means[k] - value) / std::sqrt(2.0 * variances[k]))
                             : double(means[k] < value));
  return sum;
}

double NormalMixture::quantile(double share) const {
  double low = INFINITY, high = -INFINITY;
  for (std::size_t k = 0; k < means.size(); ++k) {
    const double reach = 9.0 * std::sqrt(std::max(0.0, variances[k])) + 1e-9;
    low = std::min(low, means[k] - reach);
    high = std::max(high, means[k] + reach);
  }
  const auto [left, right] =
      boost::math::tools::bisect([&](double value) { return probability_below(value) - share; },
                                 low, high, boost::math::tools::eps_tolerance<double>(30));
  return 0.5 * (left + right);
}

std::vector<std::vector<FilmState>> film_states(const PosteriorProblem &problem,
                                                const std::vector<Draw> &draws) {
  std::vector<std::vector<FilmState>> out(draws.size());
  const auto count = Index(draws.size());
  Matrix scores(problem.parameters, count), amplitudes(Index(problem.effects.size()), count);
  for (int f = 0; f < int(problem.films.size()); ++f) {
    for (Index d = 0; d < count; ++d) {
      const Draw &draw = draws[std::size_t(d)];
      scores.col(d) = draw.scores.col(problem.films[std::size_t(f)].material);
      amplitudes.col(d) = amplitudes_of(problem, draw, f);
    }
    const FilmPredictions all = problem.predict(f, scores, amplitudes);
    for (Index d = 0; d < count; ++d)
      out[std::size_t(d)].push_back(state_of(all, d));
  }
  return out;
}

std::vector<NormalMixture> predictive(const PosteriorProblem &problem, const Posterior &posterior,
                                      const NewData &wanted) {
  const FilmPredictions bare = predictions_of(problem, posterior, wanted);
  const auto states = film_states(problem, posterior.draws);
  std::vector<NormalMixture> out(std::size_t(bare.mean.rows()));
  for (std::size_t d = 0; d < posterior.draws.size(); ++d) {
    const Draw &draw = posterior.draws[d];
    const FilmState own = state_of(bare, Index(d));
    const Residuals data = residuals_of(problem, all_films(problem), states[d], draw);
    const Cholesky factor(data.covariance);
    Vector mean = own.mean, variance = variance_before(draw, wanted, mean.size());
    if (const Matrix with = covariance_with(problem, draw, wanted, data); with.rows() > 0) {
      const Vector pull = factor.solve(data.residual);
      mean += with * pull;
      const Matrix explained = factor.matrixL().solve(with.transpose());
      variance -= explained.colwise().squaredNorm().transpose();
      variance *=
          scale_of_rest(data.residual.dot(pull), data.residual.size(), problem.degrees_of_freedom);
    }
    if (own.variance.size() > 0)
      variance += own.variance;
    if (own.scatter.size() > 0)
      variance += own.scatter;
    variance += own.errors.rowwise().squaredNorm();
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k].weights.push_back(draw.weight);
      out[k].means.push_back(mean[Index(k)]);
      out[k].variances.push_back(std::max(0.0, variance[Index(k)]));
    }
  }
  return out;
}

std::vector<LeftOutData> leave_each_datum_out(const PosteriorProblem &problem,
                                              const Posterior &posterior) {
  std::vector<Stretch> stretches;
  Index at = 0;
  for (int f = 0; f < int(problem.films.size()); ++f)
    for (Index k = 0; k < problem.films[std::size_t(f)].observed.size(); ++k)
      stretches.push_back({f, int(k), at++, 1});
  return leave_out(problem, posterior, stretches);
}

std::vector<LeftOutData> leave_each_film_out(const PosteriorProblem &problem,
                                             const Posterior &posterior) {
  std::vector<Stretch> stretches;
  Index at = 0;
  for (int f = 0; f < int(problem.films.size()); ++f) {
    const Index count = problem.films[std::size_t(f)].observed.size();
    stretches.push_back({f, -1, at, count});
    at += count;
  }
  return leave_out(problem, posterior, stretches);
}

double adequacy(const PosteriorProblem &problem, const Posterior &posterior) {
  const auto states = film_states(problem, posterior.draws);
  double out = 0.0;
  for (std::size_t d = 0; d < posterior.draws.size(); ++d) {
    const Residuals data = residuals_of(problem, all_films(problem), states[d], posterior.draws[d]);
    const double square = Cholesky(data.covariance).matrixL().solve(data.residual).squaredNorm();
    out += posterior.draws[d].weight *
           chance_beyond(square, int(data.residual.size()), problem.degrees_of_freedom);
  }
  return out;
}

} // namespace calendem::inference
