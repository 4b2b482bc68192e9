// SPDX-License-Identifier: GPL-2.0-or-later
#include "body_atoms.h"
#include "atom.h"
#include "memory.h"
#include <algorithm>

using namespace LAMMPS_NS;

BodyAtoms::~BodyAtoms() {
  memory->destroy(body_);
  memory->destroy(broken_);
}

void BodyAtoms::grow_arrays(int nmax) {
  memory->grow(body_, nmax, "bond/bpm:body");
  memory->grow(broken_, nmax, "bond/bpm:broken");
  for (int *values : {body_, broken_})
    std::fill(values + std::min(nmax_, nmax), values + nmax, 0);
  nmax_ = nmax;
}

void BodyAtoms::copy_arrays(int i, int j) {
  body_[j] = body_[i];
  broken_[j] = broken_[i];
}

void BodyAtoms::set_arrays(int i, int body) {
  body_[i] = body;
  broken_[i] = 0;
}

int BodyAtoms::pack_exchange(int i, double *buf) const {
  buf[0] = body_[i];
  buf[1] = broken_[i];
  return 2;
}

int BodyAtoms::unpack_exchange(int nlocal, const double *buf) {
  body_[nlocal] = static_cast<int>(buf[0]);
  broken_[nlocal] = static_cast<int>(buf[1]);
  return 2;
}

int BodyAtoms::pack_restart(int i, double *buf) const {
  buf[0] = kRestartSize;
  buf[1] = body_[i];
  buf[2] = broken_[i];
  return kRestartSize;
}

void BodyAtoms::unpack_restart(int nlocal, int nth) {
  const double *values = atom->extra[nlocal];
  int m = 0;
  for (int i = 0; i < nth; ++i)
    m += static_cast<int>(values[m]);
  body_[nlocal] = static_cast<int>(values[m + 1]);
  broken_[nlocal] = static_cast<int>(values[m + 2]);
}
