// SPDX-License-Identifier: GPL-2.0-or-later
// Forces and torques on atoms, summed as whole numbers: the order of the pairs does not matter, so
// that they are the same on any number of ranks. Their units follow from the largest sphere that
// there ever was, or will be; a sum that leaves their range stops the run.
#ifndef CALENDEM_FORCE_SUMS_H
#define CALENDEM_FORCE_SUMS_H

#include "bond_events.h"
#include "pair_tile.h"
#include "pointers.h"
#include <vector>

namespace LAMMPS_NS {

/// Sums of forces and torques on an atom, in units of a FixedPoint; unsigned, as they may pass
/// through numbers that are too large on their way. The last of each is a SumCheck.
struct alignas(64) WholeForce {
  unsigned long long force[4], torque[4];
};

class ForceSums : protected Pointers {
public:
  explicit ForceSums(class LAMMPS *lmp) : Pointers(lmp) {}

  void connect(BondEvents *bonds) { bonds_ = bonds; }
  /// For contacts of those moduli [kPa] between types up to `types`; all ranks must call.
  void choose_units(const double *const *moduli, int types);

  /// Zero for so many atoms and ghosts.
  void clear(int atoms);
  /// Rounds the step's forces and torques on the tile's spheres, and adds them.
  void add_tile(const PairTile &tile, PairStep &step);
  /// To what the host's atoms have.
  void add_to_atoms(class PairGran *pair);

  /// Stops the run: the forces on that atom were beyond the units of their sum.
  void stop_overflow(int tag) const;

private:
  BondEvents *bonds_ = nullptr;
  std::vector<WholeForce> sums_;
  calendem::FixedPoint force_unit_, torque_unit_; // [nN], [nN um]

  double largest_radius(int types) const;
  void report_overflow(const PairTile &tile, const PairStep &step);
};

} // namespace LAMMPS_NS

#endif
