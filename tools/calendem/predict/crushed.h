// SPDX-License-Identifier: GPL-2.0-or-later
// Loads at which single particles of a material break: what a laboratory measured says of the strength, and what the
// strength says of loads that were not measured.
#ifndef CALENDEM_PREDICT_CRUSHED_H
#define CALENDEM_PREDICT_CRUSHED_H

#include "predict/prediction.h"

namespace calendem {

/// How wrong the model may be of all loads of one material, standard deviation of ln: the grains of a
/// powder are not the model's. An estimate.
constexpr double kCrushingModel = 0.3;

/// Adds the crushing loads of an experiment. What is left out is reported in `not_said`.
void add_crushed(const Experiment &experiment, const FilmBank &bank, int material, Calibration &to,
                 std::vector<std::string> &not_said);

/// Logarithm of the likelihood of the loads that were measured of one material (its place in
/// Calibration::materials), but for a constant.
double log_likelihood_of_crushed(const FilmBank &bank, const Calibration &calibration, int material,
                                 const Material &as);

/// Loads that lie beyond two standard deviations of what the strength that was found means, in words.
std::vector<std::string> contradicting_loads(const FilmBank &bank, const Calibration &calibration);

struct Crushing {
  int material = 0;                ///< place in Calibration::materials
  double diameter = 0.0;           ///< [um]
  Band load;                       ///< at which half of the particles break [mN]
  double measured = 0.0, sd = 0.0; ///< [mN]; 0: not measured
};

/// Crushing of each material, at the bank's diameters and those that were measured: under all
/// draws, given the loads that were measured. Empty if the bank has no crushed particles.
std::vector<Crushing> crushing_of(const FilmBank &bank, const Calibration &calibration);

} // namespace calendem

#endif
