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
};

/// Per draw the porosity under load falls with pressure; where it meets that of the gap is the
/// draw's pressure, with the porosity's error over its slope. Throws Failure(2) for a gap that
/// leaves the film no pores, or does not touch it.
std::vector<AtGap> at_gaps(const FilmBank &bank, const Calibration &calibration, const Film &film,
                           const std::vector<double> &gaps);

} // namespace calendem

#endif
