// SPDX-License-Identifier: GPL-2.0-or-later
// Material parameters and effects as measured films leave them: draws from the posterior over the
// bank's emulators, averaged over which effect acts. Films of one material share them; those of
// several have their own, more or less alike.
#ifndef CALENDEM_PREDICT_CALIBRATION_H
#define CALENDEM_PREDICT_CALIBRATION_H

#include "base/experiment.h"
#include "films/film_problem.h"
#include <map>
#include <utility>
#include <vector>

namespace calendem {

/// A measured number of a film after one pressing.
struct Datum {
  int film = 0; ///< place in Calibration::films
  std::string condition;
  FilmNumber number = FilmNumber::PorosityAfter;
  double pressure = 0.0;    ///< [MPa]
  double pressure_sd = 0.0; ///< of its logarithm, the same error in all of a film's data
  double measured = 0.0, sd = 0.0;
};

/// Single particles of one diameter that were crushed.
struct Crushed {
  int material = 0;                            ///< place in Calibration::materials
  double diameter = 0.0, load = 0.0, sd = 0.0; ///< [um], [mN]
};

/// The model's own error.
struct ModelDiscrepancy {
  double sd = 0.0;     ///< of porosity 0-1
  double shared = 0.5; ///< of its variance, that all films of one material have in common, 0-1
};

struct Draw {
  /// One for each of Calibration::materials, and last for one more that was not measured.
  std::vector<Material> materials;
  ModelDiscrepancy missed;
  /// Correlation between materials of each parameter and amplitude (of its normal score), 0-1, and
  /// the probability that two have the same effects because they are alike.
  double alike = 0.5;
  const Material &of(const Film &film) const { return materials[std::size_t(film.material)]; }
};

/// Effects that may act together.
struct EffectSet {
  std::string name;                ///< "none", an effect, "a + b"
  std::vector<int> effects;        ///< places in FilmBank::effects()
  std::vector<double> probability; ///< in each of Calibration::materials
};

struct Calibration {
  std::vector<std::string> materials = {""}; ///< names
  std::vector<Film> films;
  std::vector<Datum> data;
  std::vector<Crushed> crushed;
  ModelError error;
  std::vector<Draw> draws; ///< of equal weight
  double acceptance = 1.0; ///< of the sampler's moves of parameters, the least over its steps
};

/// Adds the film of an experiment and its data: porosities after, cracked particles and nanopores of
/// conditions whose pressure is known and within the bank's, and crushed particles. What is left out is reported in `not_said`.
/// Experiments that name the same material share it. Throws Failure(2) if it is another electrode,
/// or nothing is left.
void add_experiment(const Experiment &experiment, const FilmBank &bank, Calibration &to,
                    std::vector<std::string> &not_said);

/// The films that have data, with them, as readings; their samples are large.
MeasuredFilms measured_films(const Calibration &calibration);

struct CalibrationSettings {
  int samples = 512; ///< of the sampler
  int draws = 400;   ///< that are kept
};

/// The sets of effects that act in draws, the most probable in any material first.
std::vector<EffectSet> effect_sets_of(const FilmBank &bank, const Calibration &calibration);
std::string name_of(const FilmBank &bank, const std::vector<int> &effects);
/// The effects that act in a material.
std::vector<int> effects_of(const Material &material);
/// Probability that one of the bank's effects acts in a material, alone or with others.
double acting(const Calibration &calibration, int effect, std::size_t material);

/// Fills the draws from films, data and error. Before the data the model is wrong about each effect -
/// it acts, or it does not, other than in the bank's reference material - with a probability of 10 %.
/// Deterministic.
void calibrate(const FilmBank &bank, const CalibrationSettings &settings, Calibration &calibration);

/// What speaks against trusting a calibration: parameters that the data drive to an end of the bank's
/// range (half of the draws lie in its outer tenth), the model's own error at its upper end, a
/// sampler that hardly moved.
std::vector<std::string> warnings_of(const FilmBank &bank, const Calibration &calibration);

/// ", NAME", to stand behind a parameter's name; empty where there is only one material.
std::string of_material(const Calibration &calibration, std::size_t material);

/// By what they are, not by their names.
bool is_same_film(const Film &a, const Film &b);

struct Query {
  Film film;
  FilmNumber number = FilmNumber::PorosityAfter;
  std::vector<double> pressures; ///< [MPa]
};

/// By draws, then pressures; none of a number that is not known.
using Predictions = std::vector<std::vector<MeanVariance>>;

/// By draws, then data: each datum as all others predict it, with the errors of measurement and press.
Predictions each_from_the_others(const FilmBank &bank, const Calibration &calibration);

/// What the model misses of a film's runs, given the data: mean and variance at each wanted pressure.
Predictions missed_given_data(const FilmBank &bank, const Calibration &calibration,
                              const std::vector<Draw> &draws, const Query &query);

/// Given the data, at each wanted pressure: mean and variance of emulators and model error, not of a
/// press. Errors of the emulator are in part common to films that are alike.
Predictions given_data(const FilmBank &bank, const Calibration &calibration,
                       const std::vector<Draw> &draws, const Query &query);

} // namespace calendem

#endif
