// SPDX-License-Identifier: GPL-2.0-or-later
// compute ID all bond/bpm  -> global vector:
//   1 bonds made, 2 intact, 3 broken, broken by 4 tension 5 bending 6 shear 7 torsion,
//   8 strain energy of the intact bonds [fJ], 9 strain energy released by breaks [fJ]
// Asserts made = intact + broken whenever it is asked.
#ifdef COMPUTE_CLASS

ComputeStyle(bond/bpm, ComputeBondBpm)

#else
#ifndef LMP_COMPUTE_BOND_BPM_H
#define LMP_COMPUTE_BOND_BPM_H

#include "compute.h"

namespace LAMMPS_NS {

class ComputeBondBpm : public Compute {
public:
  ComputeBondBpm(class LAMMPS *, int &, int, char **);
  ~ComputeBondBpm();
  void init();
  void compute_vector();

private:
  class FixBondBpm *fix_;
};

} // namespace LAMMPS_NS

#endif
#endif
