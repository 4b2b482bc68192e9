// SPDX-License-Identifier: GPL-2.0-or-later
// What a pair's contact history holds for its bond: the one place that knows the order of the
// values.
#ifndef CALENDEM_BOND_BPM_HISTORY_H
#define CALENDEM_BOND_BPM_HISTORY_H

#include "physics/acting_contact.h"
#include "physics/parallel_bond.h"

namespace LAMMPS_NS {

/// State of a pair. The overlap at creation stays the contact's reference at least until a broken
/// pair's spheres have separated. A binder bridge stands beside the pair's contact, which goes on as
/// it was.
enum BondState {
  kNeverBonded = 0,
  kIntact = 1,
  kBrokenTouching = 2,
  kBrokenSeparated = 3,
  kBridge = 4
};

/// View of one pair's history values; vectors change sign in the host's mirrored copies. State and
/// meeting distance stand last, beside the friction's values: a contact without a bond reads no
/// more.
class BondHistory {
public:
  static constexpr int kSize = 11;

  explicit BondHistory(double *values) : h_(values) {}

  int state() const { return static_cast<int>(h_[kState]); }
  void set_state(BondState s) { h_[kState] = s; }
  /// Centre distance at the creation of the bond or the bridge [um].
  double length() const { return h_[kLength]; }
  /// Centre distance [um] from which the contact counts: that at creation while bonded, and until a
  /// broken pair has separated; 0: the sum of radii; negative: the sum of radii and this.
  double meeting_distance() const { return h_[kMeeting]; }
  double strength_factor() const { return h_[7]; }

  calendem::BondLoads loads() const { return {calendem::load(h_), calendem::load(h_ + 4), h_[3]}; }
  void set_loads(const calendem::BondLoads &l) {
    calendem::store(l.shear, h_);
    h_[3] = l.twist;
    calendem::store(l.bending, h_ + 4);
  }

  void create(double length, double strength_factor, BondState state = kIntact) {
    h_[kState] = state;
    h_[kLength] = length;
    if (state == kIntact)
      meet_at(length);
    h_[7] = strength_factor;
    set_loads({});
  }
  /// Sets meeting_distance().
  void meet_at(double distance) { h_[kMeeting] = distance; }

  /// True while a bond or a bridge joins the pair.
  bool acts() const { return state() == kIntact || state() == kBridge; }
  /// True while the contact's overlap is counted from its creation.
  bool has_reference() const { return state() == kIntact || state() == kBrokenTouching; }
  /// Memory of `model hertz_effects`, whose history value follows; NULL for a contact that the
  /// effects leave alone.
  const double *effect_memory() const { return has_reference() ? nullptr : h_ + kSize; }

  /// What the pair's contact acts on at the distance r [um].
  calendem::ActingContact contact(double r, double radius_sum) const {
    const double reference = reference_overlap(radius_sum);
    return {calendem::acting_overlap(radius_sum, r, reference),
            calendem::acting_distance(r, reference), state() != kIntact};
  }

  /// Overlap [um] at that distance, from which the contact counts.
  double reference_overlap(double radius_sum) const {
    const double at = meeting_distance();
    if (at == 0.0 || at >= radius_sum)
      return 0.0;
    return at > 0.0 ? radius_sum - at : -at;
  }

private:
  static constexpr int kLength = 8, kMeeting = 9, kState = 10;

  double *h_;
};

} // namespace LAMMPS_NS

#endif
