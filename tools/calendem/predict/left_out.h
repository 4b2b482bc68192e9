// SPDX-License-Identifier: GPL-2.0-or-later
// How far predictions of films hold that the model was not calibrated on: every film left out in
// turn, beside two rules of thumb that are fitted on the same data.
#ifndef CALENDEM_PREDICT_LEFT_OUT_H
#define CALENDEM_PREDICT_LEFT_OUT_H

#include "predict/prediction.h"
#include <map>

namespace calendem {

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

/// Of a film, 0-1; the bank's own where it is no parameter.
double porosity_before(const FilmBank &bank, const Film &film);

/// Both with their constants from least squares.
/// Heckel (Trans. Metall. Soc. AIME 221 (1961) 671): ln(before / after) = pressure / K + A.
/// Meyer et al. (J. Mater. Process. Technol. 249 (2017) 172), who have line load and density in
/// place of pressure and porosity: after = least + (before - least) exp(-pressure / c).
std::vector<RuleOfThumb> rules_of_thumb(const std::vector<Pressed> &data);

struct LeftOut {
  std::string film, condition;
  double pressure = 0.0, measured = 0.0; ///< MPa; porosity 0-1
  Band predicted;                        ///< with measurement's and press's errors
  std::map<std::string, double> rules;   ///< porosity by the name of the rule of thumb
};

/// Every porosity after calendering, predicted from the other films. Empty with one film.
std::vector<LeftOut> left_out(const FilmBank &bank, const Calibration &calibration,
                              const CalibrationSettings &settings);

} // namespace calendem

#endif
