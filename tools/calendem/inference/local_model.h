// SPDX-License-Identifier: GPL-2.0-or-later
// How the data of one material change with its parameters and effects near a pivot: linear in the
// parameters, piecewise linear in the score of an effect's amplitude. Moves of the sampler are
// proposed by it; whether they are accepted is decided by the model itself.
#ifndef CALENDEM_INFERENCE_LOCAL_MODEL_H
#define CALENDEM_INFERENCE_LOCAL_MODEL_H

#include "base/random.h"
#include "inference/likelihood.h"
#include "inference/materials_alike.h"

namespace calendem::inference {

/// An effect of a material, or of one of its films.
struct Switch {
  int effect = 0;
  int film = -1; ///< -1: of the material
};
double &score_of(Draw &draw, int material, const Switch &at);
double score_of(const Draw &draw, int material, const Switch &at);
std::vector<int> films_of(const PosteriorProblem &problem, int material);
std::vector<Switch> switches_of(const PosteriorProblem &problem, int material);

/// An effect with the score of its amplitude. `place`: of the switch, -1: no effect.
struct Choice {
  int place = -1;
  double score = 0.0;
};

/// Predictions of a material's films at the pivot, beside it along each parameter, and with each
/// switch at each node. Once for all sizes of the discrepancy.
struct Neighbourhood {
  std::vector<int> films;
  std::vector<FilmState> pivot;
  Matrix slopes;  ///< data x parameters
  Matrix changes; ///< data x (switch, node): what the effect changes
  long states = 0;
};
Neighbourhood neighbourhood_of(const PosteriorProblem &problem, const Draw &pivot, int material);

class LocalModel {
public:
  /// `errors`: a draw whose discrepancy and factors on errors are those of the particles that use
  /// this; `temperature`: the power of the likelihood.
  LocalModel(const PosteriorProblem &problem, const Neighbourhood &near, const Draw &errors,
             double prior_variance, double temperature);

  double discrepancy() const { return discrepancy_; }
  /// What the data, and the parameters that make up for it, change when an effect acts.
  Vector change(const Choice &choice) const;
  Vector shift(const Choice &choice) const;
  /// Mean of the parameters' posterior, given a residual at `scores`.
  Vector centre(const Vector &residual, const Vector &scores, const Vector &prior_mean) const;
  /// Factor L of that posterior's covariance L L^T.
  const Matrix &spread() const { return spread_; }
  /// Distance in this covariance, squared.
  double square(const Vector &scores) const;

private:
  friend class Choices;
  double discrepancy_, prior_variance_;
  Matrix gain_;     ///< parameters x data
  Matrix spread_;   ///< of the parameters
  Matrix shifts_;   ///< parameters x (switch, node)
  Matrix changes_;  ///< data x (switch, node), beside what the shift makes up for
  Matrix weights_;  ///< the same in the inverse covariance
  Vector squares_;  ///< of each node
  Vector products_; ///< of each node with the next
  Eigen::Index column(const Choice &choice, double &along) const;
};

/// Prior of a switch.
struct SwitchPrior {
  double log_odds = 0.0;
  ScorePrior score;
};

/// Distribution of which effect to add to a state, and with what amplitude.
class Choices {
public:
  /// `residual`, `offset`: of the data, and of the parameters from their prior mean, in the state
  /// without the effect. `open`: switches to choose from. `none`: or no effect.
  Choices(const LocalModel &model, const Vector &residual, const Vector &offset,
          const std::vector<SwitchPrior> &priors, const std::vector<char> &open, bool none);
  Choice draw(Random &random) const;
  double log_density(const Choice &choice) const;

private:
  /// exp(c0 + c1 t - c2 t^2 / 2) along one segment, t from 0 to 1.
  struct Parabola {
    int place, segment;
    double c0, c1, c2, log_mass;
  };
  const LocalModel &model_;
  const std::vector<SwitchPrior> &priors_;
  Vector linear_; ///< of each (switch, node)
  bool none_;
  std::vector<Parabola> parabolas_;
  double log_total_;
  Parabola parabola(int place, int segment) const;
};

} // namespace calendem::inference

#endif
