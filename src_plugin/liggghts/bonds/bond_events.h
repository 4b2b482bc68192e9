// SPDX-License-Identifier: GPL-2.0-or-later
// What the loops over pairs know of bonds: their settings, when they are made, and to whom a loop
// tells what happens to them. fix bond/bpm stands behind it.
#ifndef CALENDEM_BOND_EVENTS_H
#define CALENDEM_BOND_EVENTS_H

#include "bond_pairs.h"
#include "bond_settings.h"

namespace LAMMPS_NS {

class BondEvents {
public:
  virtual ~BondEvents() {}

  /// The one fix bond/bpm of the run; an error that names `caller` if there is none or several.
  static BondEvents *find(class LAMMPS *lmp, const char *caller);

  virtual BondPairs &pairs() = 0;
  virtual const BondSettings &settings() const = 0;
  virtual const BondSettings &bridge_settings() const = 0;
  const BondSettings &settings_of(const BondHistory &bond) const {
    return bond.state() == kBridge ? bridge_settings() : settings();
  }
  /// The pair's bond or bridge where its spheres stand now.
  calendem::BondPair pair_of(int i, int j, const BondHistory &bond) {
    return pairs().bond_of(settings_of(bond).material, i, j, bond);
  }
  /// True while binder bridges shrink, in this step or the next one.
  virtual bool shrinks() const = 0;

  /// True in the set-up in which bonds are made: make_bond() and make_bridge() then make the
  /// pair's, if it is to have one, at the distance r [um].
  virtual bool creating() const = 0;
  virtual void make_bond(int i, int j, double r, BondHistory &bond) const = 0;
  virtual void make_bridge(int i, int j, double r, BondHistory &bond) const = 0;
  /// The spheres of a broken pair have separated.
  virtual void mark_separated(int i, int j, BondHistory &bond) const = 0;

  /// This copy of a bond fails in this step; it acts until the step's last force.
  virtual void record_break(int i, int j, BondHistory bond, const calendem::BondPair &,
                            const calendem::BondLoads &) = 0;
  /// A bond is as long as that multiple of the sum of radii.
  virtual void check_stretch(double stretch) = 0;
  /// Bonds and bridges that this rank decides and that have acted in this step.
  virtual void count_acting(bigint bonds) = 0;
  void count_acting_pair(int i, int j) { count_acting(pairs().decides(i, j)); }
  /// Forces on the atom with that tag are beyond the units of their sum.
  virtual void report_overflow(int tag) = 0;
  /// Radius of the largest sphere so far, restarts included, if the largest now has `now` [um].
  virtual double largest_radius(double now) = 0;
};

} // namespace LAMMPS_NS

#endif
