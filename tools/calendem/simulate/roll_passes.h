// SPDX-License-Identifier: GPL-2.0-or-later
// What the passes under a roll amount to: line load, length of the nip, and the times of the real
// passage against those of the run.
#ifndef CALENDEM_SIMULATE_ROLL_PASSES_H
#define CALENDEM_SIMULATE_ROLL_PASSES_H

#include "physics/roll_nip.h"
#include "simulate/collect.h"

namespace calendem {

RollNip roll_nip(const Settings &settings);

/// For each pass its smallest gap, largest pressure, and line load and contact length on both sides
/// of the nip; the time under the roll at the web's real speed, and how much faster the run was.
nlohmann::json roll_passes(const std::vector<RawRow> &rows, const Settings &settings);

} // namespace calendem

#endif
