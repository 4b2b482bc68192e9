// SPDX-License-Identifier: GPL-2.0-or-later
// The film after drying, before the press: what of drying.csv, which the input scripts write, goes
// into the summary.
#ifndef CALENDEM_SIMULATE_DRYING_H
#define CALENDEM_SIMULATE_DRYING_H

#include <nlohmann/json.hpp>
#include <string>

namespace calendem {

/// Null in a run without drying stress.
nlohmann::json dried_film(const std::string &folder);

} // namespace calendem

#endif
