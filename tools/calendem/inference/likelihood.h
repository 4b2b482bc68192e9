// SPDX-License-Identifier: GPL-2.0-or-later
// Probability of the films' data in one state of the world. A film's own errors are factorised by
// themselves, so that a move of one material leaves the factors of other films; what films have in
// common is of low rank.
#ifndef CALENDEM_INFERENCE_LIKELIHOOD_H
#define CALENDEM_INFERENCE_LIKELIHOOD_H

#include "inference/posterior.h"

namespace calendem::inference {

/// Predictions of one film in one state.
struct FilmState {
  Vector mean, variance, scatter;
  Matrix errors; ///< data x errors common to the film's data
};
FilmState state_of(const FilmPredictions &predictions, Eigen::Index column);

/// A film's data seen through its own errors.
struct FilmTerms {
  double square = 0.0, log_determinant = 0.0;
  Matrix gram; ///< of the columns that films share, in the inverse of its own covariance
  Vector pull; ///< these columns times the residual, in the same
};
FilmTerms terms_of(const PosteriorProblem &problem, int film, const FilmState &state,
                   const Draw &draw);

/// ln of the probability density of all films' data.
double log_likelihood(const PosteriorProblem &problem, const Draw &draw,
                      const std::vector<FilmTerms> &terms);

/// Covariance of the errors of two films' data; `a` and `b` are places of films, `own` a film's state.
Matrix own_covariance(const PosteriorProblem &problem, int film, const FilmState &own,
                      const Draw &draw);
Matrix shared_covariance(const PosteriorProblem &problem, int a, int b, const Draw &draw);

/// The films' data, one behind another: what is left of them and its covariance.
struct Residuals {
  std::vector<int> films;
  std::vector<Eigen::Index> begin; ///< of each film, and the end
  Vector residual;
  Matrix covariance;
};
Residuals residuals_of(const PosteriorProblem &problem, const std::vector<int> &films,
                       const std::vector<FilmState> &states, const Draw &draw);

/// States of all films under each draw, asked of the model at once.
std::vector<std::vector<FilmState>> film_states(const PosteriorProblem &problem,
                                                const std::vector<Draw> &draws);

} // namespace calendem::inference

#endif
