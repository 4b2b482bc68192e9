// SPDX-License-Identifier: GPL-2.0-or-later
// The grid on which positions along periodic sides are kept: shifts by a side are exact on it, and
// both copies of a pair do the same arithmetic, whichever ranks hold them.
#ifndef CALENDEM_POSITION_GRID_H
#define CALENDEM_POSITION_GRID_H

#include "pointers.h"

namespace LAMMPS_NS {

class PositionGrid : protected Pointers {
public:
  explicit PositionGrid(class LAMMPS *lmp) : Pointers(lmp), spacing_() {}

  /// Chooses the grid and puts the faces of the box on it.
  void choose();
  /// Stops the run if ghosts could lie beyond the box by more than its half; names the fix `owner`.
  void check_box(class Fix *owner) const;
  void put_atoms_on();
  /// Along axis k [um], 0 along a side that is not periodic.
  double spacing(int k) const { return spacing_[k]; }

private:
  double spacing_[3];
};

} // namespace LAMMPS_NS

#endif
