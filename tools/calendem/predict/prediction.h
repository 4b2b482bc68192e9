// SPDX-License-Identifier: GPL-2.0-or-later
// A film that was not measured: its numbers against pressure with the bands that hold half and 90 %,
// and which pressures meet what is wanted of it.
#ifndef CALENDEM_PREDICT_PREDICTION_H
#define CALENDEM_PREDICT_PREDICTION_H

#include "predict/calibration.h"
#include <functional>

namespace calendem {

/// A mean over draws, each a normal.
struct Mixture {
  std::vector<Guess> of;
  double probability_below(double value) const;
  double quantile(double share) const;
};

struct Band {
  double median = 0.0, low50 = 0.0, high50 = 0.0, low90 = 0.0, high90 = 0.0;
};
/// `low`, `high`: what the number can be at all.
Band band_of(const Mixture &mixture, double low, double high);

/// What is predicted of a film, 0-1 and MPa.
struct PredictedFilm {
  Film film;
  std::vector<double> pressures;
  std::vector<Band> under_load, after, springback, cracked;
  std::vector<Band> modulus;       ///< of unloading [GPa]
  std::vector<std::string> beyond; ///< in what it lies outside the bank
  int runs = 0;                    ///< of its own at each pressure; 0: by the bank's emulators
};

/// By draws, then pressures.
using Guesses = std::vector<std::vector<Guess>>;
/// Normals of a number under each draw.
using GuessesOf = std::function<Guesses(FilmNumber)>;
PredictedFilm predicted_from(const Film &film, const std::vector<double> &pressures,
                             const GuessesOf &of);

/// `pressure_sd`: of the press that will be used, of its logarithm.
PredictedFilm predicted(const FilmBank &bank, const Calibration &calibration, const Film &film,
                        const std::vector<double> &pressures, double pressure_sd);

/// A measured porosity after release, with the errors of measurement and press.
Band porosity_band(const FilmBank &bank, const Calibration &calibration, const Film &film,
                   double pressure, double pressure_sd, double sd);

/// What a film shall be after calendering.
struct Target {
  double porosity = 0.0, within = 0.01; ///< total porosity after release, 0-1
  double cracked_below = 1.0;           ///< share of the particles
};

struct Chance {
  double pressure = 0.0;
  double porosity = 0.0, cracked = 0.0; ///< probability of each
  double both = 0.0;
};

/// Of each pressure to meet the target.
std::vector<Chance> chances_from(const std::vector<double> &pressures, const GuessesOf &of,
                                 const Target &target);
std::vector<Chance> chances(const FilmBank &bank, const Calibration &calibration, const Film &film,
                            const std::vector<double> &pressures, double pressure_sd,
                            const Target &target);

/// Points at equal ratios from `low` to `high`.
std::vector<double> spread_pressures(double low, double high, int count);

} // namespace calendem

#endif
