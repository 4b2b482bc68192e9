// SPDX-License-Identifier: GPL-2.0-or-later
// sealed make: draws truths, runs them, seals them, and hands out what a laboratory
// would: experiment files with curves and noise, and nothing that a laboratory cannot measure.
#ifndef CALENDEM_TESTS_VALIDATION_SEALED_MAKE_H
#define CALENDEM_TESTS_VALIDATION_SEALED_MAKE_H

#include "diagnose/measured_runs.h"
#include "sealed/truths.h"
#include <optional>

namespace calendem {

struct MakeOptions {
  std::string round_file, folder, liggghts;
  int jobs = 1;
  int sets = 0; ///< only the first so many sets of samples, which are in random order; 0: all
  std::optional<std::uint64_t> seed; ///< truths that can be drawn again: for tests, not sealed
};

/// The command line in the folder of this program: it makes packings and runs.
std::string calendem_beside();

/// Writes folder/sealed (secret, truth.json, study/) and folder/handed_out (commitment.json and a
/// folder for each case, in an order that reveals nothing). The same call goes on where it was.
/// Throws Failure: 2 bad input, 3 stopped or no run usable. Truths whose runs fail are left out.
void make_round(const MakeOptions &options);

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

/// Writes what a laboratory would report of the truth. `shown`: of one truth, by the bank's
/// pressures, of one repeat or of several. `seed`: of the noise. `id`: the case's name.
void hand_out(const std::string &folder, const std::string &id, const Round &round,
              const Truth &truth, const std::vector<PressedSamples> &shown, std::uint64_t seed);

} // namespace calendem

#endif
