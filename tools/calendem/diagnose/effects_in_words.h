// SPDX-License-Identifier: GPL-2.0-or-later
// An effect's row of gap.json in words.
#ifndef CALENDEM_DIAGNOSE_EFFECTS_IN_WORDS_H
#define CALENDEM_DIAGNOSE_EFFECTS_IN_WORDS_H

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace calendem {

/// "effects.x.y, effects.x.z"
std::string keys_of(const nlohmann::ordered_json &row);

/// "effects.x.y = 0.300 (95 %: 0.200 to 0.400)": with the same decimals.
std::string setting_of(const nlohmann::ordered_json &row);

} // namespace calendem

#endif
