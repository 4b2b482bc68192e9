// SPDX-License-Identifier: GPL-2.0-or-later
// Simple ways to name an effect from the same emulators, which a diagnosis must beat.
#ifndef CALENDEM_WITHHELD_BASELINES_H
#define CALENDEM_WITHHELD_BASELINES_H

#include "diagnose/inference/diagnosis.h"
#include <map>
#include <string>

namespace calendem {

/// What each baseline names:
/// - always none;
/// - largest residual: if a block is beyond the threshold, the effect that puts the largest share
///   of its signature into the largest block;
/// - cosine match: if the residual is beyond the 95 % point of chi-squared, the effect whose
///   signature has the largest cosine with it;
/// - BIC: the least -2 ln L + k ln n (Schwarz, Ann. Stat. 6 (1978) 461) of none and each effect,
///   with L at the mode of likelihood times prior.
/// Residuals are those of the recalibrated base model, signatures those of amplitudes one standard
/// score to either side of the prior's middle, in the metric in which recalibration is free.
std::map<std::string, std::string> baselines(const inference::Problem &problem,
                                             const inference::Diagnosis &diagnosis);

} // namespace calendem

#endif
