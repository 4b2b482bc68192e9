// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a restart file is complete. LIGGGHTS itself reads a cut one without a word, or never
// ends.
#ifndef CALENDEM_SIMULATE_RESTART_FILE_H
#define CALENDEM_SIMULATE_RESTART_FILE_H

#include <string>

namespace calendem {

/// The file ends, as the host writes it, with one chunk per rank (count of values, values; every
/// atom's record begins with its own length) and these hold `atoms` atoms in all.
bool restart_is_whole(const std::string &file, long atoms);

} // namespace calendem

#endif
