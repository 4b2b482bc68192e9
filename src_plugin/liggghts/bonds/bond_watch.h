// SPDX-License-Identifier: GPL-2.0-or-later
// What must hold of bonds in every step: each intact one acts, none is stretched beyond the range
// of histories. A rank sees its own faults at once; all ranks stop together where they meet.
#ifndef CALENDEM_BOND_WATCH_H
#define CALENDEM_BOND_WATCH_H

#include "bond_pairs.h"
#include "bond_settings.h"
#include "pointers.h"
#include <string>

namespace LAMMPS_NS {

class BondWatch : protected Pointers {
public:
  /// Messages name the fix `owner`.
  BondWatch(class LAMMPS *lmp, class Fix *owner) : Pointers(lmp), owner_(owner) {}

  void begin_run() { expected_ = -1; }
  bool has_stepped() const { return expected_ >= 0; }
  void count_acting(bigint bonds) { acting_ += bonds; }
  void check_stretch(double stretch) {
    if (stretch > kStretchLimit && overstretched_ == 0.0)
      overstretched_ = stretch;
  }
  /// One that this rank decides acts no more from the next step on.
  void count_break() { --expected_; }
  /// After a step's forces; counts anew where the lists are new.
  void end_step(const BondPairs &pairs, bool new_lists);
  bool is_wrong() const { return overstretched_ > 0.0 || missing_ != 0; }
  /// All ranks call. `intact`: of all ranks, by what was made and what has been gathered as broken;
  /// `waiting`: breaks of this rank that have not.
  void stop_if_wrong(bigint intact, bigint waiting);
  /// All bonds are there with so many spheres of all ranks.
  void set_spheres(bigint n) { spheres_ = spheres_ < 0 ? n : spheres_; }

private:
  class Fix *owner_;
  double overstretched_ = 0.0; // the first stretch beyond the limit, 0 if none
  // intact bonds and bridges that this rank decides: acted in this step; are there; did not act
  // when they had to
  bigint acting_ = 0, expected_ = -1, missing_ = 0;
  bigint spheres_ = -1; // of all ranks, when all bonds acted last

  void stop_overstretched(double stretch) const;
  void stop_lost(bigint acting, bigint intact, bigint spheres) const;
  std::string why_lost(bigint spheres) const;
};

} // namespace LAMMPS_NS

#endif
