// SPDX-License-Identifier: GPL-2.0-or-later
#include "bond_sums.h"
#include "error.h"
#include "fix.h"
#include "mpi_liggghts.h"
#include <algorithm>

using namespace LAMMPS_NS;

bigint BondSums::intact() const {
  bigint mine = 0, all = 0;
  bonds_.pairs().for_each_intact([&mine](int, int, const BondHistory &) { ++mine; });
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  return all;
}

bigint BondSums::checked_intact(bigint made, bigint broken, Fix *owner) const {
  const bigint found = intact();
  char message[256];
  snprintf(message, sizeof message,
           "bonds do not add up: " BIGINT_FORMAT " made, " BIGINT_FORMAT " intact, " BIGINT_FORMAT
           " logged as broken. A bond vanished without a break, or broke on one rank only",
           made, found, broken);
  if (found + broken != made || !copies_agree())
    error->fix_error(FLERR, owner, message);
  return found;
}

bool BondSums::copies_agree() const {
  const BondPairs &pairs = bonds_.pairs();
  bigint mine = 0, all = 0;
  pairs.for_each_acting_copy([&](int i, int j, const BondHistory &) {
    if (j >= atom->nlocal)
      mine += pairs.decides(i, j) ? 1 : -1;
  });
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  return all == 0;
}

double BondSums::strain_energy(BondState state) const {
  const BondPairs &pairs = bonds_.pairs();
  double mine = 0.0, all = 0.0;
  pairs.for_each_acting_copy([&](int i, int j, const BondHistory &bond) {
    if (bond.state() != state || !pairs.decides(i, j))
      return;
    mine += bonds_.pair_of(i, j, bond).strain_energy(bond.loads());
  });
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}
