// SPDX-License-Identifier: GPL-2.0-or-later
// What measured films leave of their materials: weighted draws of parameters, of the effects that
// act, and of how wrong the model is. Diagnosis, calibration, prediction and design read this list.
#ifndef CALENDEM_INFERENCE_POSTERIOR_H
#define CALENDEM_INFERENCE_POSTERIOR_H

#include "inference/quantities.h"
#include "inference/student_t.h"
#include <cmath>

namespace calendem::inference {

/// Score of the amplitude of an effect that does not act.
inline constexpr double kOff = -INFINITY;
inline bool acts(double score) { return score != kOff; }

/// An effect acts or not; its amplitude is the image of a standard normal score.
struct EffectPrior {
  double probability = 0.1; ///< that it acts, whatever others do; 1: it is known to act
  bool of_film = false;     ///< a fault of press or reading: each film's own, else its material's
};

/// Readings of one film. Matrices may be empty where nothing of the kind exists.
struct FilmData {
  int material = 0;
  Vector observed;
  Matrix measurement;          ///< covariance of the readings' errors as stated
  Matrix fixed;                ///< covariance of errors that no draw changes
  Matrix emulator_correlation; ///< between data; empty: none
  Matrix scatter_correlation;  ///< of packings, between data; empty: none
  Matrix discrepancy;          ///< covariance of a model discrepancy of size 1 within the film
  /// data x q. Its product with another film's is the covariance of their discrepancies if all of
  /// it is common to both; with itself about `discrepancy`.
  Matrix shared_discrepancy;
  Matrix shared_errors; ///< data x errors that all films have in common, for one sd of each
};

/// What the model predicts of one film's data under several states: data x states.
struct FilmPredictions {
  Matrix mean;
  Matrix variance;            ///< of the emulators; empty: none
  Matrix scatter;             ///< variance between packings; empty: none
  std::vector<Matrix> errors; ///< change by one sd of each error common to the film's data
};

/// Scores of the parameters (parameters x states) and of the amplitudes (effects x states, kOff).
using Predictor =
    std::function<FilmPredictions(int film, const Matrix &scores, const Matrix &amplitudes)>;
/// ln likelihood of what else was measured of a material, for each state. May be empty.
using MaterialLikelihood =
    std::function<Vector(int material, const Matrix &scores, const Matrix &amplitudes)>;

struct PosteriorProblem {
  int parameters = 0; ///< of each material
  std::vector<EffectPrior> effects;
  int materials = 1;
  std::vector<FilmData> films;
  Predictor predict;
  MaterialLikelihood other_data;
  double degrees_of_freedom = kNormal; ///< of the t distribution of all residuals
  Prior discrepancy{Prior::log_uniform, 0.1, 10.0};
  double understated = 0.0; ///< probability that the errors stated of a film are too small
  Prior understatement{Prior::log_uniform, 1.5, 5.0}; ///< factor on them
};

/// One state of the world.
struct Draw {
  double weight = 1.0;
  int particle = 0;      ///< draws of one particle follow each other in a chain
  Matrix scores;         ///< parameters x materials, and in a posterior one that was not measured
  Matrix amplitudes;     ///< effects x the same; scores, kOff
  Matrix faults;         ///< effects x films; scores, kOff
  Vector understatement; ///< of each film, 1: as stated
  double discrepancy = 0.0; ///< size of the model discrepancy
  double shared = 0.5;      ///< share of its variance that a material's films have in common
  double material_correlation = 0.5; ///< of scores, effects and shared discrepancy
};

/// The amplitudes that act in a film.
Vector amplitudes_of(const PosteriorProblem &problem, const Draw &draw, int film);

struct SamplerSettings {
  int particles = 512;
  int sweeps = 2;           ///< over all blocks at each temperature
  int final_sweeps = 8;     ///< at the end
  int keep_every = 2;       ///< of these sweeps
  double least_share = 0.5; ///< effective share of the particles after a step of temperature
  std::uint64_t seed = 1;
};

/// A step from prior to posterior.
struct TemperatureStep {
  double temperature = 0.0; ///< power of the likelihood, 0-1
  double effective = 0.0;   ///< particles after reweighting
  double switches = 0.0;    ///< accepted share of moves that change effects
  double parameters = 0.0;  ///< accepted share of moves of the parameters
};

struct Posterior {
  std::vector<Draw> draws;   ///< weights sum to 1
  double log_evidence = 0.0; ///< ln of the data's probability density
  std::vector<TemperatureStep> steps;
  int particles = 0;
  long states = 0; ///< that the predictor was asked for, over all films
};

/// Sequential Monte Carlo from prior to posterior (Del Moral, Doucet and Jasra, J. R. Stat. Soc. B 68
/// (2006) 411): particles drawn from the prior are reweighted by small powers of the likelihood,
/// resampled and moved. Moves exchange one effect for another, none or another amplitude, chosen by
/// a local linear model of the data (`local_model.h`); accepting by Metropolis and Hastings makes
/// them exact. Deterministic.
Posterior sample_posterior(const PosteriorProblem &problem, const SamplerSettings &settings = {});

} // namespace calendem::inference

#endif
