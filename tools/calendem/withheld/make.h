// SPDX-License-Identifier: GPL-2.0-or-later
// calendem withheld make: draws truths, runs them, seals them, and hands out what a laboratory
// would: experiment files with curves and noise, and nothing that a laboratory cannot measure.
#ifndef CALENDEM_WITHHELD_MAKE_H
#define CALENDEM_WITHHELD_MAKE_H

#include "diagnose/compare/gap.h"
#include "withheld/truths.h"
#include <optional>

namespace calendem {

struct MakeOptions {
  std::string round_file, folder, liggghts;
  int jobs = 1;
  int sets = 0; ///< only the first so many sets of samples, which are in random order; 0: all
  std::optional<std::uint64_t> seed; ///< truths that can be drawn again: for tests, not sealed
};

/// Writes folder/sealed (secret, truth.json, study/) and folder/handed_out (commitment.json and a
/// folder for each case, in an order that reveals nothing). The same call goes on where it was.
/// Throws Failure: 2 bad input, 3 stopped or no run usable. Truths whose runs fail are left out.
void make_round(const MakeOptions &options);

/// What the press shows of one specimen at one pressure: a run for each sample. What is handed out is
/// their mean.
using PressedSamples = std::vector<SimulatedRun>;

/// A truth, and what the press shows of it at each pressure, of one repeat after the other; empty
/// where a run is not usable.
struct PressedTruth {
  Truth truth;
  std::vector<PressedSamples> shown;
  std::vector<PressedSamples> without_cause; ///< of its companion; empty: it has none
};

/// The part without runs: hands out and seals. Beside the truth it seals what would have been handed
/// out without its cause, with the same errors of measurement: sealed/without_cause/NNN, and both of
/// each sample of each repeat alone: sealed/samples/NNN/K and K_without. Of an intervention two experiments are
/// handed out, NNN/before and NNN/after.
void seal_round(const std::string &folder, const Round &round,
                const std::vector<PressedTruth> &truths, const std::string &secret);

/// Writes experiment.toml, a curve for each pressure and the recipe into `folder`, which is made.
/// `shown`: of one truth, by the bank's pressures, of one repeat or of several. `seed`: of the noise. `id`: the case's name.
void hand_out(const std::string &folder, const std::string &id, const Round &round,
              const Truth &truth, const std::vector<PressedSamples> &shown, std::uint64_t seed);

} // namespace calendem

#endif
