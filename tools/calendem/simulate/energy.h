// SPDX-License-Identifier: GPL-2.0-or-later
// The energy ledger of a run: work of the platen against what it has become.
#ifndef CALENDEM_SIMULATE_ENERGY_H
#define CALENDEM_SIMULATE_ENERGY_H

#include "simulate/collect.h"

namespace calendem {

/// A ledger with more than this fraction of the work unaccounted for does not close.
inline constexpr double kLedgerLimit = 0.01;

/// Every term, in fJ and since the first row, at maximum pressure and at the end, and what is left
/// over: `unaccounted_fraction` is the largest |rest| of any row over the largest work. Terms that
/// the run did not measure are NaN (null in the file).
nlohmann::json energy_ledger(const std::vector<RawRow> &rows, const RawRow &top);

/// Warning when the ledger does not close; empty when it does or was not kept.
std::string ledger_warning(const nlohmann::json &energy);

} // namespace calendem

#endif
