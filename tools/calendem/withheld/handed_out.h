// SPDX-License-Identifier: GPL-2.0-or-later
// What a laboratory would hand in of a truth: an experiment file with its curves, with noise, and
// nothing that a laboratory cannot measure.
#ifndef CALENDEM_WITHHELD_HANDED_OUT_H
#define CALENDEM_WITHHELD_HANDED_OUT_H

#include "diagnose/compare/gap.h"
#include "withheld/truths.h"

namespace calendem {

/// What the press shows at one pressure: a run for each sample. What is handed out is their mean.
using PressedSamples = std::vector<SimulatedRun>;

/// Writes experiment.toml, a curve for each pressure and the recipe into `folder`, which is made.
/// `shown`: of one truth, by the bank's pressures. `seed`: of the noise. `id`: the case's name.
void hand_out(const std::string &folder, const std::string &id, const Round &round,
              const Truth &truth, const std::vector<PressedSamples> &shown, std::uint64_t seed);

} // namespace calendem

#endif
