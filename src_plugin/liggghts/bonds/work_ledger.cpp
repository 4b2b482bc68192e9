// SPDX-License-Identifier: GPL-2.0-or-later
#include "work_ledger.h"
#include "fix.h"
#include "lammps.h"
#include "modify.h"

using namespace LAMMPS_NS;

WorkLedger *WorkLedger::find(LAMMPS *lmp) {
  return dynamic_cast<WorkLedger *>(lmp->modify->find_fix_style_strict("energy/bpm", 0));
}
