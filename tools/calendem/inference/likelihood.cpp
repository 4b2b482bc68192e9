// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/likelihood.h"

namespace calendem::inference {
namespace {

using Eigen::Index;

/// Adds the covariance of errors with these variances.
void add_correlated(const Vector &variance, const Matrix &correlation, Matrix &to) {
  if (variance.size() == 0)
    return;
  if (correlation.size() == 0) {
    to.diagonal() += variance;
    return;
  }
  const Vector sd = variance.cwiseMax(0.0).cwiseSqrt();
  to += sd.asDiagonal() * correlation * sd.asDiagonal();
}

/// The columns of a film that others share: errors, then discrepancy.
Matrix shared_columns(const FilmData &film) {
  Matrix out(film.observed.size(), film.shared_errors.cols() + film.shared_discrepancy.cols());
  if (film.shared_errors.size() > 0)
    out.leftCols(film.shared_errors.cols()) = film.shared_errors;
  if (film.shared_discrepancy.size() > 0)
    out.rightCols(film.shared_discrepancy.cols()) = film.shared_discrepancy;
  return out;
}

/// Number of common errors and of columns of the common discrepancy.
struct Shared {
  Index errors = 0, columns = 0;
  explicit Shared(const PosteriorProblem &problem) {
    for (const FilmData &f : problem.films) {
      errors = std::max(errors, f.shared_errors.cols());
      columns = std::max(columns, f.shared_discrepancy.cols());
    }
  }
};

/// How a film's shared columns depend on independent standard normals: common errors, the
/// discrepancy of all materials, those of each material.
Matrix loadings(const PosteriorProblem &problem, const Shared &shared, const FilmData &film,
                const Draw &draw) {
  const Index e = film.shared_errors.cols(), q = film.shared_discrepancy.cols();
  Matrix out = Matrix::Zero(e + q, shared.errors + shared.columns * (1 + problem.materials));
  out.topLeftCorner(e, e).setIdentity();
  const double of_all = draw.discrepancy * std::sqrt(draw.shared * draw.material_correlation),
               own = draw.discrepancy * std::sqrt(draw.shared * (1.0 - draw.material_correlation));
  for (Index j = 0; j < q; ++j) {
    out(e + j, shared.errors + j) = of_all;
    out(e + j, shared.errors + shared.columns * (1 + film.material) + j) = own;
  }
  return out;
}

} // namespace

FilmState state_of(const FilmPredictions &p, Index column) {
  FilmState out;
  out.mean = p.mean.col(column);
  if (p.variance.size() > 0)
    out.variance = p.variance.col(column);
  if (p.scatter.size() > 0)
    out.scatter = p.scatter.col(column);
  out.errors.resize(out.mean.size(), Index(p.errors.size()));
  for (std::size_t k = 0; k < p.errors.size(); ++k)
    out.errors.col(Index(k)) = p.errors[k].col(column);
  return out;
}

Matrix own_covariance(const PosteriorProblem &problem, int place, const FilmState &own,
                      const Draw &draw) {
  const FilmData &film = problem.films[std::size_t(place)];
  const double factor = draw.understatement[place];
  Matrix out = factor * factor * film.measurement;
  if (film.fixed.size() > 0)
    out += film.fixed;
  add_correlated(own.variance, film.emulator_correlation, out);
  add_correlated(own.scatter, film.scatter_correlation, out);
  if (own.errors.cols() > 0)
    out.noalias() += own.errors * own.errors.transpose();
  const double apart = film.shared_discrepancy.size() > 0 ? 1.0 - draw.shared : 1.0;
  if (film.discrepancy.size() > 0)
    out += apart * draw.discrepancy * draw.discrepancy * film.discrepancy;
  return out;
}

Matrix shared_covariance(const PosteriorProblem &problem, int a, int b, const Draw &draw) {
  const FilmData &one = problem.films[std::size_t(a)], &other = problem.films[std::size_t(b)];
  Matrix out = Matrix::Zero(one.observed.size(), other.observed.size());
  if (one.shared_errors.size() > 0 && other.shared_errors.size() > 0)
    out += one.shared_errors * other.shared_errors.transpose();
  const double alike = one.material == other.material ? 1.0 : draw.material_correlation;
  if (one.shared_discrepancy.size() > 0 && other.shared_discrepancy.size() > 0)
    out += alike * draw.shared * draw.discrepancy * draw.discrepancy * one.shared_discrepancy *
           other.shared_discrepancy.transpose();
  return out;
}

FilmTerms terms_of(const PosteriorProblem &problem, int place, const FilmState &state,
                   const Draw &draw) {
  const FilmData &film = problem.films[std::size_t(place)];
  const Cholesky factor(own_covariance(problem, place, state, draw));
  const auto lower = factor.matrixL();
  const Vector white = lower.solve(film.observed - state.mean);
  FilmTerms out;
  out.square = white.squaredNorm();
  out.log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  if (film.shared_errors.size() + film.shared_discrepancy.size() > 0) {
    const Matrix columns = lower.solve(shared_columns(film));
    out.gram = columns.transpose() * columns;
    out.pull = columns.transpose() * white;
  }
  return out;
}

double log_likelihood(const PosteriorProblem &problem, const Draw &draw,
                      const std::vector<FilmTerms> &terms) {
  const Shared shared(problem);
  const Index size = shared.errors + shared.columns * (1 + problem.materials);
  double square = 0.0, log_determinant = 0.0;
  Index data = 0;
  Matrix inner = Matrix::Identity(size, size);
  Vector pull = Vector::Zero(size);
  for (std::size_t f = 0; f < terms.size(); ++f) {
    const FilmData &film = problem.films[f];
    data += film.observed.size();
    square += terms[f].square;
    log_determinant += terms[f].log_determinant;
    if (terms[f].pull.size() == 0)
      continue;
    const Matrix by = loadings(problem, shared, film, draw);
    inner.noalias() += by.transpose() * terms[f].gram * by;
    pull.noalias() += by.transpose() * terms[f].pull;
  }
  if (size > 0) { // Woodbury
    const Cholesky factor(inner);
    square -= factor.matrixL().solve(pull).squaredNorm();
    log_determinant += 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  }
  const double out = log_student_t(square, log_determinant, int(data), problem.degrees_of_freedom);
  return std::isfinite(out) ? out : -INFINITY; // where the model predicts nothing
}

Residuals residuals_of(const PosteriorProblem &problem, const std::vector<int> &films,
                       const std::vector<FilmState> &states, const Draw &draw) {
  Residuals out;
  out.films = films;
  out.begin.push_back(0);
  for (const int f : films)
    out.begin.push_back(out.begin.back() + problem.films[std::size_t(f)].observed.size());
  out.residual.resize(out.begin.back());
  out.covariance.resize(out.begin.back(), out.begin.back());
  for (std::size_t i = 0; i < films.size(); ++i) {
    const Index at = out.begin[i], n = out.begin[i + 1] - at;
    out.residual.segment(at, n) = problem.films[std::size_t(films[i])].observed - states[i].mean;
    for (std::size_t j = 0; j < films.size(); ++j)
      out.covariance.block(at, out.begin[j], n, out.begin[j + 1] - out.begin[j]) =
          shared_covariance(problem, films[i], films[j], draw);
    out.covariance.block(at, at, n, n) += own_covariance(problem, films[i], states[i], draw);
  }
  return out;
}

std::vector<std::vector<FilmState>> film_states(const PosteriorProblem &problem,
                                                const std::vector<Draw> &draws) {
  std::vector<std::vector<FilmState>> out(draws.size());
  const auto count = Eigen::Index(draws.size());
  Matrix scores(problem.parameters, count), amplitudes(Eigen::Index(problem.effects.size()), count);
  for (int f = 0; f < int(problem.films.size()); ++f) {
    for (Eigen::Index d = 0; d < count; ++d) {
      const Draw &draw = draws[std::size_t(d)];
      scores.col(d) = draw.scores.col(problem.films[std::size_t(f)].material);
      amplitudes.col(d) = amplitudes_of(problem, draw, f);
    }
    const FilmPredictions all = problem.predict(f, scores, amplitudes);
    for (Eigen::Index d = 0; d < count; ++d)
      out[std::size_t(d)].push_back(state_of(all, d));
  }
  return out;
}

} // namespace calendem::inference
