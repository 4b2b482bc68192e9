// SPDX-License-Identifier: GPL-2.0-or-later
#include "history_layout.h"
#include "bond_bpm_history.h"
#include "contact_effects.h"
#include "error.h"
#include "force.h"
#include "pair_gran.h"

int LAMMPS_NS::friction_history_offset(LAMMPS *lmp, int bond_offset) {
  PairGran *pair = static_cast<PairGran *>(lmp->force->pair_match("gran", 1));
  const int first = bond_offset + BondHistory::kSize +
                    (ContactEffects::in_use(lmp) ? ContactEffects::kMemory : 0);
  const int rest = pair->dnum_pair() - first;
  if (rest == 0)
    return -1;
  if (rest != 3)
    lmp->error->all(FLERR, "fix bond/bpm works with 'model hertz|hertz_effects tangential "
                           "history|no_history|off' without rolling friction history; the pair "
                           "style stores other values too");
  return first;
}
