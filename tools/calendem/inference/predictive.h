// SPDX-License-Identifier: GPL-2.0-or-later
// What the draws of a posterior predict: data of films that were not measured, and measured data as
// the others predict them.
#ifndef CALENDEM_INFERENCE_PREDICTIVE_H
#define CALENDEM_INFERENCE_PREDICTIVE_H

#include "inference/likelihood.h"

namespace calendem::inference {

/// A number under each draw: a normal distribution each, with the draws' weights.
struct NormalMixture {
  std::vector<double> weights, means, variances;
  double mean() const;
  double probability_below(double value) const;
  double quantile(double share) const;
};

/// Data that are asked for.
struct NewData {
  int material = 0; ///< the problem's number of materials: another one
  int film = -1;    ///< of the problem, that is pressed again; -1: another film
  std::function<FilmPredictions(const Matrix &scores, const Matrix &amplitudes)> predict;
  Matrix errors;             ///< covariance of their readings; empty: of the film itself
  Matrix discrepancy;        ///< as in FilmData
  Matrix discrepancy_with;   ///< the same of these data (rows) with those of `film`
  Matrix shared_discrepancy; ///< as in FilmData
  Matrix shared_errors;      ///< as in FilmData
};

/// States of all films under each draw, asked of the model at once.
std::vector<std::vector<FilmState>> film_states(const PosteriorProblem &problem,
                                                const std::vector<Draw> &draws);

/// A mixture for each datum: under a draw the discrepancy and the errors that films share are
/// conditioned on all films' data.
std::vector<NormalMixture> predictive(const PosteriorProblem &problem, const Posterior &posterior,
                                      const NewData &wanted);

/// Data that are left out: draws are weighted by the inverse of their probability given all others
/// (importance sampling, Gelfand, Dey and Chang 1992).
struct LeftOutData {
  int film = 0;
  int datum = -1; ///< -1: all of the film
  std::vector<NormalMixture> predicted;
  double effective = 0.0;   ///< draws that carry this: few are not to be trusted
  double log_density = 0.0; ///< of the data left out
  double gain = 0.0;        ///< what they say of the draws [nats]
};
std::vector<LeftOutData> leave_each_datum_out(const PosteriorProblem &problem,
                                              const Posterior &posterior);
std::vector<LeftOutData> leave_each_film_out(const PosteriorProblem &problem,
                                             const Posterior &posterior);

/// Posterior predictive p-value of all data (Gelman, Meng and Stern 1996): the probability of a
/// larger square of the residuals in their covariance, averaged over the draws.
double adequacy(const PosteriorProblem &problem, const Posterior &posterior);

} // namespace calendem::inference

#endif
