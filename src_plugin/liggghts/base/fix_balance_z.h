// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all balance/z
//
// Moves the faces between ranks along z whenever neighbour lists are built, so that every slab has
// as many particles and listed pairs as the others: film_cuts.h. Changes no result. Scalar: the
// largest slab's work over the mean when the faces were set last [-]; 1 with one rank along z.
#ifdef FIX_CLASS

FixStyle(balance/z, FixBalanceZ)

#else
#ifndef LMP_FIX_BALANCE_Z_H
#define LMP_FIX_BALANCE_Z_H

#include "fix.h"
#include <vector>

namespace LAMMPS_NS {

class FixBalanceZ : public Fix {
public:
  FixBalanceZ(class LAMMPS *, int, char **);
  int setmask();
  void setup_pre_exchange();
  void pre_exchange();
  double compute_scalar();

private:
  double imbalance_; ///< before the faces moved

  double height() const;
  std::vector<double> work_of_layers() const;
};

} // namespace LAMMPS_NS

#endif
#endif
