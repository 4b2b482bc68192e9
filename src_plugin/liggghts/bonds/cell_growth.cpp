// SPDX-License-Identifier: GPL-2.0-or-later
#include "cell_growth.h"
#include "fix.h"
#include "lammps.h"
#include "modify.h"

using namespace LAMMPS_NS;

CellGrowth *CellGrowth::find(LAMMPS *lmp) {
  return dynamic_cast<CellGrowth *>(lmp->modify->find_fix_style_strict("elongation", 0));
}
