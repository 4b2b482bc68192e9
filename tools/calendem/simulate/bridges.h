// SPDX-License-Identifier: GPL-2.0-or-later
// Binder bridges along a run: bridges.csv from what the input scripts wrote, and what of it goes
// into the summary. They are no bonds of bodies and are counted apart from them.
#ifndef CALENDEM_SIMULATE_BRIDGES_H
#define CALENDEM_SIMULATE_BRIDGES_H

#include "simulate/collect.h"

namespace calendem {

/// Writes bridges.csv, a row for each of `rows`; returns made and broken, at the row of the largest
/// pressure and at the end, by what they join CBD to. Null, and no file, in a run without bridges.
nlohmann::json write_bridges(const std::string &folder, const std::vector<RawRow> &rows,
                             const RawRow &top);

} // namespace calendem

#endif
