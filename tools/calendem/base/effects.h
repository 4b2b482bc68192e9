// SPDX-License-Identifier: GPL-2.0-or-later
// The table of effects (registry/effects.h) by name and as JSON.
#ifndef CALENDEM_BASE_EFFECTS_H
#define CALENDEM_BASE_EFFECTS_H

#include "registry/effects.h"
#include <nlohmann/json_fwd.hpp>

namespace calendem {

/// Throws Failure(2) with the names there are.
const Effect &find_effect(const std::string &name);

/// The first key that its parameter moves, of the case or of the recipe.
const Key &key_of(const Effect &effect);

/// Folder in tests/ that checks it.
std::string folder_of_tests(const Effect &effect);

nlohmann::json to_json(const Effect &effect);

} // namespace calendem

#endif
