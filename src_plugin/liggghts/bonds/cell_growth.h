// SPDX-License-Identifier: GPL-2.0-or-later
// How the cell grows along x, for whoever needs no more of fix elongation, which stands behind it.
#ifndef CALENDEM_CELL_GROWTH_H
#define CALENDEM_CELL_GROWTH_H

#include "physics/web_elongation.h"

namespace LAMMPS_NS {

class CellGrowth {
public:
  virtual ~CellGrowth() {}

  /// The one of the run, NULL where the cell keeps its sides.
  static CellGrowth *find(class LAMMPS *lmp);

  /// How far the latest step has gone.
  virtual const calendem::ElongationStep &step() const = 0;
  /// By how much the cell will grow at most, over its side now.
  virtual double growth_to_come() const = 0;
};

} // namespace LAMMPS_NS

#endif
