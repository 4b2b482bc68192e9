// SPDX-License-Identifier: GPL-2.0-or-later
// All that inference needs to know, whatever made it: emulators, or a formula in a test.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_PROBLEM_H
#define CALENDEM_DIAGNOSE_INFERENCE_PROBLEM_H

#include "base/random.h"
#include "diagnose/inference/bank.h"
#include "diagnose/inference/feature_map.h"
#include <functional>

namespace calendem::inference {

/// An effect that is on, with the scores of its parameters.
struct Applied {
  int effect = 0;
  Vector scores;
};

/// All of a prediction, or what the effects that are on change.
enum class Part { whole, change };

/// What is predicted of all features.
struct Prediction {
  Vector mean;
  Vector variance; ///< of the emulators
  Vector scatter;  ///< variance that the effects add between cells; empty: none
};

/// A prediction and its derivatives along the scores, the base parameters' and then the effects' in
/// order: features x scores.
struct Slopes {
  Matrix mean, variance, scatter; ///< scatter: empty where the prediction's is
  Prediction here;
};

/// How the points of a measured curve scatter beside a smooth line.
struct PointNoise {
  std::string condition;
  double score = 0.0; ///< about standard normal if their errors are as stated
  Vector measured;    ///< share of measurement in the variance of each direction, 0..1

  /// How many times as large as stated their errors look; 0: smaller than anything explains.
  double times_stated() const;
};

struct Problem {
  Vector observed; ///< features
  std::vector<Feature> features;
  std::vector<Block> blocks;
  std::vector<Roughness> roughness;    ///< of the truncation residuals among the features
  std::vector<PointNoise> point_noise; ///< no features: only understated noise predicts it
  Matrix measurement;                  ///< covariance that is known
  Matrix scatter;                      ///< of the packings, estimated
  Matrix correlation;                  ///< of the emulators' errors between features; empty: none
  /// Correlation of the scatter that effects add, times the share of a cell's variance that the
  /// sample's mean keeps; 0 between specimens.
  Matrix added_scatter;
  double degrees_of_freedom = 1e6;     ///< of the t distribution of observed - predicted
  int base_parameters = 0;             ///< number of scores of the base model
  std::vector<ModelledEffect> effects; ///< measurement faults too
  Matrix discrepancy;                  ///< covariance of the unknown, of one standard deviation
  std::function<Prediction(const Vector &base, const std::vector<Applied> &)> predict;
  /// Where scores of the base do not count from its prior: those that do. Empty: they are the same.
  std::function<Vector(const Vector &base)> scores_of_the_prior;
  /// Empty: by differences.
  std::function<Slopes(const Vector &base, const std::vector<Applied> &on)> slopes;
};

/// The problem's, or central differences of step 1e-4.
Slopes slopes_of(const Problem &problem, const Vector &base, const std::vector<Applied> &on);

/// Data of this problem without the effect among the hypotheses.
Problem without_effect(const Problem &problem, int effect);

/// Features as they would be measured if the base parameters and effects were these and all that
/// the problem says of its errors were true.
Vector drawn(const Problem &problem, const Vector &base, const std::vector<Applied> &on,
             Random &random);

/// Covariance of the emulators' errors and of the scatter that effects add.
Matrix errors_of(const Problem &problem, const Prediction &prediction);

/// Covariance of observed - predicted: measurement, scatter and the prediction's errors.
Matrix covariance_about(const Problem &problem, const Prediction &prediction);

/// Square of observed - predicted in the inverse covariance, and ln of that covariance's
/// determinant; their derivatives along the scores that slopes are of.
struct Misfit {
  double square = 0.0, log_determinant = 0.0;
  Vector square_slopes, determinant_slopes;
};
/// `covariance` is covariance_about the prediction, and more that does not change with the scores.
Misfit misfit_of(const Problem &problem, const Vector &observed, const Prediction &prediction,
                 const Matrix &covariance, const Slopes &slopes);

/// The base model about a point: mean + sensitivity (scores - at).
struct Linearised {
  Vector at, mean;
  Matrix sensitivity; ///< features x base parameters
  Matrix covariance;  ///< of observed - predicted, at this point
};
Linearised linearise(const Problem &problem, const Vector &base);

/// What of a covariance the base parameters cannot take up: P K P^T, P the projection off their
/// sensitivities in the metric of the inverse covariance.
Matrix beyond_recalibration(const Linearised &base, const Matrix &discrepancy);

/// Covariance of observed - mean before anything is known of the base parameters: covariance +
/// sensitivity sensitivity^T. In its inverse's metric recalibration within the priors is free.
Matrix recalibrated_covariance(const Linearised &base);

} // namespace calendem::inference

#endif
