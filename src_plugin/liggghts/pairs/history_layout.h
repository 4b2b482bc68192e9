// SPDX-License-Identifier: GPL-2.0-or-later
// Where the values of a pair's contact history stand: the bond's, the memory of `model
// hertz_effects` if there is one, the tangential model's three.
#ifndef CALENDEM_HISTORY_LAYOUT_H
#define CALENDEM_HISTORY_LAYOUT_H

namespace LAMMPS_NS {

/// Offset of the first of the tangential model's values, -1 if it has none; an error if the pair
/// style stores others.
int friction_history_offset(class LAMMPS *lmp, int bond_offset);

} // namespace LAMMPS_NS

#endif
