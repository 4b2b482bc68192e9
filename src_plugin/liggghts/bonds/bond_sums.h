// SPDX-License-Identifier: GPL-2.0-or-later
// Counts and energies of bonds over all ranks; all ranks call.
#ifndef CALENDEM_BOND_SUMS_H
#define CALENDEM_BOND_SUMS_H

#include "bond_events.h"

namespace LAMMPS_NS {

class BondSums : protected Pointers {
public:
  BondSums(class LAMMPS *lmp, BondEvents &bonds) : Pointers(lmp), bonds_(bonds) {}

  bigint intact() const;
  /// As intact(); stops the run, with a message that names the fix `owner`, unless made = intact +
  /// broken and copies agree.
  bigint checked_intact(bigint made, bigint broken, class Fix *owner) const;
  /// True if of every pair on two ranks, or across a periodic side, both copies are intact or none.
  bool copies_agree() const;
  /// Strain energy [fJ] of what is in that state: kIntact, or kBridge between spheres.
  double strain_energy(BondState state) const;

private:
  BondEvents &bonds_;
};

} // namespace LAMMPS_NS

#endif
