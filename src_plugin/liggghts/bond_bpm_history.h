// SPDX-License-Identifier: GPL-2.0-or-later
// What a pair's contact history holds for its bond: the one place that knows the order of the
// values.
#ifndef CALENDEM_BOND_BPM_HISTORY_H
#define CALENDEM_BOND_BPM_HISTORY_H

#include "physics/parallel_bond.h"

namespace LAMMPS_NS {

/// State of a pair. The overlap at creation stays the contact's reference until a broken pair's
/// spheres have separated.
enum BondState { kNeverBonded = 0, kIntact = 1, kBrokenTouching = 2, kBrokenSeparated = 3 };

/// View of one pair's history values; vectors change sign in the host's mirrored copies.
class BondHistory {
public:
  static constexpr int kSize = 10;

  explicit BondHistory(double *values) : h_(values) {}

  int state() const { return static_cast<int>(h_[0]); }
  void set_state(BondState s) { h_[0] = s; }
  double length() const { return h_[1]; } ///< centre distance at creation [um]
  double strength_factor() const { return h_[2]; }

  calendem::BondLoads loads() const {
    return {calendem::load(h_ + 3), calendem::load(h_ + 7), h_[6]};
  }
  void set_loads(const calendem::BondLoads &l) {
    calendem::store(l.shear, h_ + 3);
    h_[6] = l.twist;
    calendem::store(l.bending, h_ + 7);
  }

  void create(double length, double strength_factor) {
    h_[0] = kIntact;
    h_[1] = length;
    h_[2] = strength_factor;
    set_loads({});
  }

  /// True while the contact's overlap is counted from its creation.
  bool has_reference() const { return state() == kIntact || state() == kBrokenTouching; }
  /// Memory of `model hertz_effects`, whose history value follows; NULL for a contact that the
  /// effects leave alone.
  const double *effect_memory() const { return has_reference() ? nullptr : h_ + kSize; }

  /// Overlap [um] at creation, subtracted from the contact's overlap while the reference lives.
  double reference_overlap(double radius_sum) const {
    return has_reference() && h_[1] < radius_sum ? radius_sum - h_[1] : 0.0;
  }

private:
  double *h_;
};

} // namespace LAMMPS_NS

#endif
