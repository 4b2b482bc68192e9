// SPDX-License-Identifier: GPL-2.0-or-later
// The phases, by their atom type in the input scripts.
#ifndef CALENDEM_LAWS_PHASES_H
#define CALENDEM_LAWS_PHASES_H

namespace calendem {

enum class Phase { Am = 1, Cbd, Collector, Platen };

} // namespace calendem

#endif
