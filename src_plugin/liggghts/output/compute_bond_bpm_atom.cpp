// SPDX-License-Identifier: GPL-2.0-or-later
#include "compute_bond_bpm_atom.h"
#include "comm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "memory.h"
#include "update.h"
#include <algorithm>
#include <vector>

using namespace LAMMPS_NS;

ComputeBondBpmAtom::ComputeBondBpmAtom(LAMMPS *lmp, int &iarg, int narg, char **arg)
    : Compute(lmp, iarg, narg, arg), fix_(NULL), nmax_(0) {
  if (narg != iarg)
    error->all(FLERR, "compute bond/bpm/atom takes no arguments");
  array_atom = NULL; // the host leaves it unset
  peratom_flag = 1;
  size_peratom_cols = 3;
  comm_reverse = 1;
}

ComputeBondBpmAtom::~ComputeBondBpmAtom() { memory->destroy(array_atom); }

void ComputeBondBpmAtom::init() { fix_ = FixBondBpm::find(lmp, "compute bond/bpm/atom"); }

void ComputeBondBpmAtom::compute_peratom() {
  invoked_peratom = update->ntimestep;
  if (atom->nmax > nmax_) {
    nmax_ = atom->nmax;
    memory->destroy(array_atom);
    memory->create(array_atom, nmax_, 3, "bond/bpm/atom:array");
  }
  for (int i = 0; i < atom->nlocal + atom->nghost; ++i)
    array_atom[i][0] = 0.0;
  fix_->pairs().for_each_intact([this](int i, int j, const BondHistory &) {
    array_atom[i][0] += 1.0;
    array_atom[j][0] += 1.0;
  });
  comm->reverse_comm_compute(this);
  for (int i = 0; i < atom->nlocal; ++i) {
    array_atom[i][1] = fix_->broken_of(i);
    array_atom[i][2] = fix_->body(i);
  }
}

int ComputeBondBpmAtom::pack_reverse_comm(int n, int first, double *buf) {
  for (int k = 0; k < n; ++k)
    buf[k] = array_atom[first + k][0];
  return 1;
}

void ComputeBondBpmAtom::unpack_reverse_comm(int n, int *list, double *buf) {
  for (int k = 0; k < n; ++k)
    array_atom[list[k]][0] += buf[k];
}

double ComputeBondBpmAtom::memory_usage() { return 3.0 * nmax_ * sizeof(double); }

ComputeBondBpmBody::ComputeBondBpmBody(LAMMPS *lmp, int &iarg, int narg, char **arg)
    : Compute(lmp, iarg, narg, arg), fix_(NULL) {
  if (narg != iarg)
    error->all(FLERR, "compute bond/bpm/body takes no arguments");
  array = NULL;
  array_flag = 1;
  extarray = 0;
  size_array_rows = 0;
  size_array_cols = 2;
}

ComputeBondBpmBody::~ComputeBondBpmBody() { memory->destroy(array); }

void ComputeBondBpmBody::init() {
  fix_ = FixBondBpm::find(lmp, "compute bond/bpm/body");
  size_array_rows = fix_->bodies();
  memory->destroy(array);
  memory->create(array, std::max(size_array_rows, 1), 2, "bond/bpm/body:array");
}

void ComputeBondBpmBody::compute_array() {
  invoked_array = update->ntimestep;
  std::vector<double> mine(size_array_rows, 0.0), all(size_array_rows, 0.0);
  fix_->pairs().for_each_intact([&](int i, int j, const BondHistory &) {
    mine[fix_->body(i < atom->nlocal ? i : j) - 1] += 1.0;
  });
  MPI_Allreduce(mine.data(), all.data(), size_array_rows, MPI_DOUBLE, MPI_SUM, world);
  for (int b = 0; b < size_array_rows; ++b) {
    array[b][0] = all[b];
    array[b][1] = 0.0;
  }
  for (const BreakEvent &e : fix_->breaks())
    array[static_cast<int>(e.body) - 1][1] += 1.0;
}
