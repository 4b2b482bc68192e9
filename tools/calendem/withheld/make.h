// SPDX-License-Identifier: GPL-2.0-or-later
// calendem withheld make: draws truths, runs them, seals them, hands out what a laboratory would.
#ifndef CALENDEM_WITHHELD_MAKE_H
#define CALENDEM_WITHHELD_MAKE_H

#include "withheld/handed_out.h"
#include <optional>

namespace calendem {

struct MakeOptions {
  std::string round_file, folder, liggghts;
  int jobs = 1;
  std::optional<std::uint64_t> seed; ///< truths that can be drawn again: for tests, not sealed
};

/// Writes folder/sealed (secret, truth.json, study/) and folder/handed_out (commitment.json and a
/// folder for each case, in an order that tells nothing). The same call goes on where it was.
/// Throws Failure: 2 bad input, 3 stopped or no run usable. Truths whose runs fail are left out.
void make_round(const MakeOptions &options);

/// The part without runs: hands out and seals. `shown`: what the press shows of each truth, empty
/// where a run is not usable.
void seal_round(const std::string &folder, const Round &round, const std::vector<Truth> &truths,
                const std::vector<std::vector<PressedSamples>> &shown, const std::string &secret);

} // namespace calendem

#endif
