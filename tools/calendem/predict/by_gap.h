// SPDX-License-Identifier: GPL-2.0-or-later
// A film pressed to a gap instead of a pressure: how much pressure that takes, and what is left of it
// after release. The gap is the thickness of the coating under load: that of rigid rolls, less the
// foil. Real rolls and presses yield; theirs is smaller when they are set.
#ifndef CALENDEM_PREDICT_BY_GAP_H
#define CALENDEM_PREDICT_BY_GAP_H

#include "predict/prediction.h"
#include <optional>

namespace calendem {

/// Pressure in MPa, thickness in um, the others 0-1.
struct AtGap {
  double gap = 0.0; ///< [um]
  Band pressure, after, thickness_after, springback, cracked;
  std::optional<Band> broken, tortuosity; ///< as the bank has them
  /// Probability that the pressure lies below or above the bank's; its bands end there.
  double below = 0.0, above = 0.0;
  int runs = 0; ///< of its own; 0: by the bank's emulators
};

/// A film at gaps under each draw: draws x gaps.
struct GapDraws {
  Film film;
  std::vector<double> gaps;           ///< [um]
  double solid = 0.0;                 ///< thickness without pores [um]
  double lowest = 0.0, highest = 0.0; ///< pressures that the bands may hold [MPa]
  Predictions log_pressure;           ///< of MPa
  Predictions springback, cracked, broken, inverse_tortuosity; ///< as FilmNumber; empty: not known
  /// By gap: the share of draws whose pressure lies below or above the bank's.
  std::vector<double> below, above;
  int runs = 0; ///< of its own at each gap; 0: by the bank's emulators
};

/// A film against pressure under each draw: draws x pressures at equal ratios.
struct FilmCurves {
  std::vector<double> pressures;                               ///< [MPa]
  Predictions load;                                            ///< porosity under load
  Predictions springback, cracked, broken, inverse_tortuosity; ///< as FilmNumber; empty: not known
};
FilmCurves curves_at(const std::vector<double> &pressures, const PredictionsOf &of);
/// The pressures of such curves.
std::vector<double> pressures_of_curves(const FilmBank &bank);

/// Adds the log pressure at which each draw's porosity under load meets `porosities` (draws x gaps),
/// and the other numbers there.
void add_met(const FilmCurves &curves, const std::vector<std::vector<double>> &porosities,
             GapDraws &draws);

/// By the bank's emulators. Per draw the porosity under load falls with pressure; where it meets that
/// of the gap is the draw's pressure, with the porosity's error over its slope. Throws Failure(2) for
/// a gap that leaves the film no pores, or does not touch it.
GapDraws under_gaps(const FilmBank &bank, const Calibration &calibration, const Film &film,
                    const std::vector<double> &gaps);
/// Without draws yet. Throws as under_gaps.
GapDraws gaps_of(const FilmBank &bank, const Film &film, const std::vector<double> &gaps);

/// Throws Failure(2) for a gap whose pressure no draw has within the bank's.
void check_reached(const GapDraws &draws);

std::vector<AtGap> at_gaps(const GapDraws &draws);
/// The porosity after release follows from gap and springback.
PredictionsOf numbers_at_gaps(const GapDraws &draws);
/// In what a film lies beyond the bank, in words. Runs need the emulators only for what the model
/// error changes.
std::vector<std::string> beyond_at_gaps(const FilmBank &bank, const Film &film, int runs);
/// Its pressures are the medians of those that the gaps take.
PredictedFilm film_at_gaps(const FilmBank &bank, const GapDraws &draws);

} // namespace calendem

#endif
