// SPDX-License-Identifier: GPL-2.0-or-later
// Measured films as a problem of the inference: what a bank predicts of every reading, and all errors
// of readings, press, emulator and model. Diagnosis and calibration sample its posterior.
#ifndef CALENDEM_FILMS_FILM_PROBLEM_H
#define CALENDEM_FILMS_FILM_PROBLEM_H

#include "base/experiment.h"
#include "compare/observables.h"
#include "films/emulated_run.h"
#include "inference/posterior.h"

namespace calendem {

/// A reading of a pressed film.
struct Reading {
  int film = 0; ///< place in MeasuredFilms::films
  std::string condition, specimen;
  double pressure = 0.0;    ///< largest [MPa]
  double pressure_sd = 0.0; ///< of its logarithm, the same error in all of a film's readings
  Observable observable;
  /// Standard deviations of the film's porosity by specimen: before, and under and after pressure.
  double specimen_porosity_before = 0.0, specimen_porosity = 0.0;
};

/// Films in the bank's inputs, and what was read of them.
struct MeasuredFilms {
  std::vector<std::string> materials; ///< names
  std::vector<Film> films;
  std::vector<Reading> readings;
  std::vector<double> cells; ///< of each film: how many of the bank's a sample is as large as
};

/// Names for experiments that name no material, and of one that was not measured.
inline constexpr const char *kUnnamed = "unnamed", *kOther = "other";

/// Place of a material among the names, to which it is added. Throws Failure(2) if it is `kOther`.
int place_of_material(const Experiment &experiment, std::vector<std::string> &names);

/// Adds the film of an experiment with all readings of conditions whose pressure is within the
/// bank's. What is left out is reported in `warnings`. Throws Failure(2) if the film is of another
/// kind than the bank's, or nothing is left.
void add_readings(const Experiment &experiment, const FilmBank &bank, MeasuredFilms &to,
                  std::vector<std::string> &warnings);

/// Readings of numbers of the film itself, as calibrate has them.
Observable observable_of(FilmNumber number, double measured, double sd);

/// The model's discrepancy in the share of cracked particles, in units of that in porosities: of 1 to
/// 4 points, 5 to 20 %. An estimate.
inline constexpr double kCrackedPerPorosity = 5.0;

/// Systematic errors of the bank and ranges of what the model is off by, as porosities 0-1.
struct ModelError {
  double numerics = 0.0;           ///< the bank's: one shift of all porosities
  double low = 0.003, high = 0.04; ///< of the discrepancy, log-uniform
};
ModelError model_error_of(const FilmBank &bank);
inference::Prior discrepancy_of(const ModelError &error);

struct ProblemOptions {
  std::vector<std::string> acting; ///< effects of the model that may be wrong
  double wrong = 0.1;       ///< probability that it is, about each effect: acts instead of not, ...
  bool faults = false;      ///< of the press may act, those of the bank's file
  double understated = 0.0; ///< probability that a film's errors are larger than stated
  ModelError error;
};

/// Effects that act in the case of a bank.
std::vector<std::string> acting_in(const Settings &settings, const FilmBank &bank);

/// The posterior's parameters and effects, in its order.
struct FilmProblem {
  inference::PosteriorProblem problem;
  std::vector<inference::Parameter> parameters; ///< FilmBank::material()
  std::vector<inference::Parameter> effects;    ///< FilmBank::effects(), then faults of the press
  std::vector<std::vector<int>> excluded;       ///< FilmBank::excluded_by, of each effect
  /// Place in MeasuredFilms::readings of each film's data.
  std::vector<std::vector<int>> readings;
};

/// `bank` and `measured` have to outlive it.
FilmProblem problem_of(const FilmBank &bank, const MeasuredFilms &measured,
                       const ProblemOptions &options);

/// A material in its units, from scores.
Material material_of(const FilmProblem &problem, const inference::Vector &scores,
                     const inference::Vector &amplitudes);

} // namespace calendem

#endif
