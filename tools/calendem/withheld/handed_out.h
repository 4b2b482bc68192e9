// SPDX-License-Identifier: GPL-2.0-or-later
// What a laboratory would hand in of a truth: an experiment file with its curves, with noise, and
// nothing that a laboratory cannot measure.
#ifndef CALENDEM_WITHHELD_HANDED_OUT_H
#define CALENDEM_WITHHELD_HANDED_OUT_H

#include "compare/gap.h"
#include "withheld/truths.h"

namespace calendem {

/// What a press shows of a run, free of noise. Pressures MPa, lengths um, fractions 0-1.
struct ShownRun {
  SimulatedRun run; ///< with the compression's curve
  std::vector<double> release_pressure, release_displacement;
};

/// What the press shows at one pressure: a run for each sample. What is handed out is their mean.
using PressedSamples = std::vector<ShownRun>;

/// Throws Failure(2) if files of the run are missing or damaged.
ShownRun read_shown_run(const std::string &folder);

/// Writes experiment.toml, a curve for each pressure and the recipe into `folder`, which is made.
/// `shown`: of one truth, by the bank's pressures. `seed`: of the noise. `id`: the case's name.
void hand_out(const std::string &folder, const std::string &id, const Round &round,
              const Truth &truth, const std::vector<PressedSamples> &shown, std::uint64_t seed);

} // namespace calendem

#endif
