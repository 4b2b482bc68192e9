// SPDX-License-Identifier: GPL-2.0-or-later
// Films whose data are linear in all scores, so that the probability of every set of effects has a
// closed form for each size of the discrepancy.
#ifndef CALENDEM_TESTS_INFERENCE_LINEAR_FILMS_H
#define CALENDEM_TESTS_INFERENCE_LINEAR_FILMS_H

#include "base/random.h"
#include "inference/posterior.h"

namespace calendem::inference {

inline Matrix normal_matrix(int rows, int columns, Random &random) {
  Matrix out(rows, columns);
  for (double &v : out.reshaped())
    v = random.normal();
  return out;
}

/// One film, or one for each of several materials.
struct LinearFilms {
  Matrix slopes;                     ///< data x parameters
  Matrix signatures;                 ///< data x effects: change at amplitude 1
  double middle = 1.0, spread = 0.3; ///< of amplitudes: middle + spread score
  PosteriorProblem problem;

  LinearFilms(int data, int parameters, int effects, double alike, std::uint64_t seed) {
    Random random(seed, 1);
    slopes = 1.5 * normal_matrix(data, parameters, random);
    const Matrix common = normal_matrix(data, 1, random);
    signatures = std::sqrt(1.0 - alike) * normal_matrix(data, effects, random) +
                 std::sqrt(alike) * common.replicate(1, effects);
    problem.parameters = parameters;
    problem.effects.resize(std::size_t(effects));
    FilmData film;
    film.observed = Vector::Zero(data);
    film.measurement = Matrix::Identity(data, data);
    film.discrepancy = Matrix(data, data);
    for (int i = 0; i < data; ++i)
      for (int j = 0; j < data; ++j)
        film.discrepancy(i, j) = std::exp(-0.5 * (i - j) * (i - j) / 16.0);
    problem.films = {film};
    problem.discrepancy = {Prior::log_uniform, 1e-3, 1.001e-3};
    problem.predict = [this](int, const Matrix &scores, const Matrix &amplitudes) {
      FilmPredictions out;
      out.mean = slopes * scores + signatures * strengths(amplitudes);
      return out;
    };
  }
  LinearFilms(const LinearFilms &) = delete;
  LinearFilms &operator=(const LinearFilms &) = delete;

  Matrix strengths(const Matrix &scores) const {
    return scores.unaryExpr([this](double s) { return acts(s) ? middle + spread * s : 0.0; });
  }

  /// Length of an effect's signature, beyond what parameters make up for, in the noise.
  double signal(int effect) const {
    const Matrix c = slopes * slopes.transpose() + problem.films[0].measurement;
    const Vector s = signatures.col(effect);
    return middle * std::sqrt(s.dot(Cholesky(c).solve(s)));
  }

  Vector draw(const std::vector<int> &acting, Random &random) const {
    Vector out = slopes * normal_matrix(int(slopes.cols()), 1, random);
    for (const int e : acting)
      out += signatures.col(e) * (middle + spread * random.normal());
    return out + Cholesky(problem.films[0].measurement).matrixL() *
                     normal_matrix(int(out.size()), 1, random);
  }

  /// ln density of a film's data under a set of effects (bits) and a size of the discrepancy.
  double log_density(unsigned set, double discrepancy) const {
    const FilmData &film = problem.films[0];
    Matrix c = slopes * slopes.transpose() + film.measurement +
               discrepancy * discrepancy * film.discrepancy;
    Vector off = film.observed;
    double log_prior = 0.0;
    for (int e = 0; e < int(problem.effects.size()); ++e) {
      const double p = problem.effects[std::size_t(e)].probability;
      const bool on = set >> unsigned(e) & 1U;
      log_prior += p < 1.0 ? std::log(on ? p : 1.0 - p) : (on ? 0.0 : -1e9);
      if (!on)
        continue;
      off -= middle * signatures.col(e);
      c += spread * spread * signatures.col(e) * signatures.col(e).transpose();
    }
    const Cholesky factor(c);
    return log_prior + log_student_t(factor.matrixL().solve(off).squaredNorm(),
                                     2.0 * factor.matrixLLT().diagonal().array().log().sum(),
                                     int(off.size()), kNormal);
  }

  /// Probability of every set, and ln of the evidence behind them; the discrepancy by `nodes`
  /// points of equal probability.
  Vector exact(double &log_evidence, int nodes = 1) const {
    const auto sets = 1U << problem.effects.size();
    Matrix logs(sets, nodes);
    for (int k = 0; k < nodes; ++k)
      for (unsigned s = 0; s < sets; ++s)
        logs(s, k) = log_density(s, problem.discrepancy.value(normal_quantile((k + 0.5) / nodes)));
    const double top = logs.maxCoeff();
    const Matrix all = (logs.array() - top).exp() / nodes;
    log_evidence = top + std::log(all.sum());
    return all.rowwise().sum() / all.sum();
  }
  Vector exact_inclusion(double &log_evidence, int nodes = 1) const {
    const Vector sets = exact(log_evidence, nodes);
    Vector out = Vector::Zero(Eigen::Index(problem.effects.size()));
    for (unsigned s = 0; s < sets.size(); ++s)
      for (Eigen::Index e = 0; e < out.size(); ++e)
        out[e] += s >> unsigned(e) & 1U ? sets[s] : 0.0;
    return out;
  }
};

} // namespace calendem::inference

#endif
