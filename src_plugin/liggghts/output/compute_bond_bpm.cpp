// SPDX-License-Identifier: GPL-2.0-or-later
#include "compute_bond_bpm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "update.h"

using namespace LAMMPS_NS;

ComputeBondBpm::ComputeBondBpm(LAMMPS *lmp, int &iarg, int narg, char **arg)
    : Compute(lmp, iarg, narg, arg), fix_(NULL) {
  if (narg != iarg)
    error->all(FLERR, "compute bond/bpm takes no arguments: 'compute ID all bond/bpm'");
  vector_flag = 1;
  size_vector = 9;
  extvector = 0;
  vector = new double[size_vector]();
}

ComputeBondBpm::~ComputeBondBpm() { delete[] vector; }

void ComputeBondBpm::init() { fix_ = FixBondBpm::find(lmp, "compute bond/bpm"); }

void ComputeBondBpm::compute_vector() {
  invoked_vector = update->ntimestep;
  for (int n = 0; n < size_vector; ++n)
    vector[n] = fix_->compute_vector(n);
}
