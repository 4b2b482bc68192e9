// SPDX-License-Identifier: GPL-2.0-or-later
// A film that was not measured: its numbers against pressure with the bands that hold half and 90 %,
// and which pressures meet what is wanted of it. And how far such predictions hold: every film left
// out in turn, beside two rules of thumb fitted on the same data.
#ifndef CALENDEM_PREDICT_PREDICTION_H
#define CALENDEM_PREDICT_PREDICTION_H

#include "predict/calibration.h"
#include <functional>
#include <map>

namespace calendem {

/// A mean over draws, each a normal.
struct Mixture {
  std::vector<MeanVariance> of;
  double probability_below(double value) const;
  double quantile(double share) const;
};

constexpr double kMostTortuosity = 100.0;

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
  std::vector<Band> modulus; ///< of unloading [GPa]
  /// Broken bonds; tortuosity factor of the macro pores through the plane, kMostTortuosity where
  /// hardly a path is left. Empty: the bank does not have them.
  std::vector<Band> broken, tortuosity;
  std::vector<Band> cbd_nanoporosity; ///< after release; empty: the bank does not have it
  std::vector<std::string> beyond;    ///< in what it lies outside the bank
  int runs = 0;                       ///< of its own at each pressure; 0: by the bank's emulators
};

/// Tortuosity from the band of its inverse.
Band tortuosity_of(const Band &inverse);

/// Normals of a number under each draw.
using PredictionsOf = std::function<Predictions(FilmNumber)>;
PredictedFilm predicted_from(const Film &film, const std::vector<double> &pressures,
                             const PredictionsOf &of);
/// By the bank's emulators, with what an error of the press's pressure adds (`pressure_sd` of its
/// logarithm).
Predictions under_draws(const FilmBank &bank, const Calibration &calibration, const Query &query,
                        double pressure_sd);
/// Porosity under load from that after release and the springback, which scatter independently.
Predictions under_load_of(const Predictions &after, const Predictions &springback);

/// `pressure_sd`: of the press that will be used, of its logarithm.
PredictedFilm predicted(const FilmBank &bank, const Calibration &calibration, const Film &film,
                        const std::vector<double> &pressures, double pressure_sd);

/// A reading of a film, with the errors of measurement and press.
Band band_of_reading(const FilmBank &bank, const Calibration &calibration, const Film &film,
                     const Datum &reading);

/// What a film shall be after calendering.
struct Target {
  double porosity = 0.0, within = 0.01; ///< total porosity after release, 0-1
  double cracked_below = 1.0;           ///< share of the particles
  double tortuosity_below = kMostTortuosity;
};

/// Probabilities of meeting the target at a pressure [MPa] or gap [um].
struct Chance {
  double at = 0.0;
  double porosity = 0.0, cracked = 0.0, tortuosity = 0.0; ///< of each, mean over the draws
  double all = 0.0;                                       ///< of all together, mean over the draws
  double assured = 0.0; ///< of all together, for kAssured of the draws or more
};

/// The data leave materials open; this share of them has the assured probability or more.
constexpr double kAssured = 0.8;

/// Chance of each pressure, or gap, to meet the target.
std::vector<Chance> chances_from(const std::vector<double> &settings, const PredictionsOf &of,
                                 const Target &target);
std::vector<Chance> chances(const FilmBank &bank, const Calibration &calibration, const Film &film,
                            const std::vector<double> &pressures, double pressure_sd,
                            const Target &target);

/// The one with the largest assured probability; where none is as much as 1 %, with the largest
/// mean.
std::size_t best_of(const std::vector<Chance> &chances);

/// Points at equal ratios from `low` to `high`.
std::vector<double> spread_pressures(double low, double high, int count);

/// A rule for porosity after calendering [0-1] from that before it and the pressure [MPa].
struct RuleOfThumb {
  std::string name;
  std::vector<double> constants;
  double (*porosity)(const std::vector<double> &constants, double before, double pressure);
};

/// Porosities of films and pressures.
struct Pressed {
  double before = 0.0, pressure = 0.0, after = 0.0;
};

/// Both with their constants from least squares.
/// Heckel (Trans. Metall. Soc. AIME 221 (1961) 671): ln(before / after) = pressure / K + A.
/// Meyer et al. (J. Mater. Process. Technol. 249 (2017) 172), who have line load and density in
/// place of pressure and porosity: after = least + (before - least) exp(-pressure / c).
std::vector<RuleOfThumb> rules_of_thumb(const std::vector<Pressed> &data);

struct LeftOut {
  std::string film, condition;
  FilmNumber number = FilmNumber::PorosityAfter;
  double pressure = 0.0, measured = 0.0; ///< MPa; 0-1
  Band predicted;                        ///< with measurement's and press's errors
  std::map<std::string, double> rules;   ///< of a porosity, by the name of the rule of thumb
};

/// Every reading of a film, predicted from the other films; films are left out side by side, a thread each. Empty with
/// one film.
std::vector<LeftOut> left_out(const FilmBank &bank, const Calibration &calibration,
                              const CalibrationSettings &settings);

} // namespace calendem

#endif
