// SPDX-License-Identifier: GPL-2.0-or-later
// compute ID all bond/bpm/atom  -> per-atom array: 1 intact bonds, 2 broken bonds, 3 body.
// compute ID all bond/bpm/body  -> global array, a row per body 1..max: 1 intact, 2 broken bonds
//                                  (each bond counted once).
#ifdef COMPUTE_CLASS

ComputeStyle(bond/bpm/atom, ComputeBondBpmAtom) ComputeStyle(bond/bpm/body, ComputeBondBpmBody)

#else
#ifndef LMP_COMPUTE_BOND_BPM_ATOM_H
#define LMP_COMPUTE_BOND_BPM_ATOM_H

#include "compute.h"

namespace LAMMPS_NS {

class ComputeBondBpmAtom : public Compute {
public:
  ComputeBondBpmAtom(class LAMMPS *, int &, int, char **);
  ~ComputeBondBpmAtom();
  void init();
  void compute_peratom();
  int pack_reverse_comm(int, int, double *);
  void unpack_reverse_comm(int, int *, double *);
  double memory_usage();

private:
  class FixBondBpm *fix_;
  int nmax_;
};

class ComputeBondBpmBody : public Compute {
public:
  ComputeBondBpmBody(class LAMMPS *, int &, int, char **);
  ~ComputeBondBpmBody();
  void init();
  void compute_array();

private:
  class FixBondBpm *fix_;
};

} // namespace LAMMPS_NS

#endif
#endif
