// SPDX-License-Identifier: GPL-2.0-or-later
// The settings of a calendering run: one row each, those of the base model here, those of an effect
// in its own row. From them come the keys of case.toml, the variables and defaults of the input
// scripts, and what these write into settings.txt. Keys of a table stand together.
#ifndef CALENDEM_EFFECTS_SETTINGS_H
#define CALENDEM_EFFECTS_SETTINGS_H

#include "effects/effects.h"
#include <vector>

namespace calendem {

const std::vector<Key> &case_keys();

} // namespace calendem

#endif
