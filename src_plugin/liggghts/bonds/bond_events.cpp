// SPDX-License-Identifier: GPL-2.0-or-later
#include "bond_events.h"
#include "error.h"
#include "fix.h"
#include "modify.h"

using namespace LAMMPS_NS;

BondEvents *BondEvents::find(LAMMPS *lmp, const char *caller) {
  const int n = lmp->modify->n_fixes_style_strict("bond/bpm");
  if (n != 1) {
    char message[256];
    snprintf(message, sizeof message,
             "%s needs exactly one 'fix ID all bond/bpm ...' in the script; found %d", caller, n);
    lmp->error->all(FLERR, message);
  }
  return dynamic_cast<BondEvents *>(lmp->modify->find_fix_style_strict("bond/bpm", 0));
}
