// SPDX-License-Identifier: GPL-2.0-or-later
// A calendering case (case.toml): what `calendem run` simulates. Its keys are the rows of
// effects/settings.h.
#ifndef CALENDEM_BASE_CASE_H
#define CALENDEM_BASE_CASE_H

#include "base/toml_reader.h"
#include "effects/settings.h"

namespace calendem {

struct Recipe;

/// Most that the platen may move in the averaging window [um]: on release a tenth of a micrometre
/// is little against the way on which the pressure falls.
inline constexpr double kAverageTravel = 0.1;

/// Window over which pressure and gap are averaged [us].
double averaging_window(const Settings &settings);

/// Speeds of the platen at which a run takes days, a calender's for example; a sentence each.
std::vector<std::string> slow_speeds(const Settings &settings);

/// What the press shows [MPa, um].
PressInstruments instruments_of(const Settings &settings);

/// What the settings contradict, beyond what each key may hold.
void check_case(const Settings &settings, Mistakes &mistakes);

/// Throws Failure(2) with every mistake of the file. `electrode` is made absolute, relative to the
/// file. What the file does not give is what the electrode's material has.
Settings read_case(const std::string &file);
/// A case whose electrode is yet to be made, by this recipe.
Settings read_case(const std::string &file, const Recipe &recipe);

} // namespace calendem

#endif
