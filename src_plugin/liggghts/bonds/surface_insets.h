// SPDX-License-Identifier: GPL-2.0-or-later
// At which distance two spheres that no bond joins meet:
//   both of one body    D (R_i + R_j), D `contact_diameter`; never shifted by an inset
//   all others          R_i + R_j - s_i - s_j
//   s of a primary      physics/surface_inset.h, S `surface_inset`, F `inset_fading`; 0 of a sphere
//                       of no body
// Surfaces that come out again as bonds break do so up to each other: a contact never begins with a
// force. Not for walls.
#ifndef CALENDEM_SURFACE_INSETS_H
#define CALENDEM_SURFACE_INSETS_H

#include "bond_pairs.h"
#include "bond_settings.h"
#include "pointers.h"
#include <vector>

namespace LAMMPS_NS {

class SurfaceInsets : protected Pointers {
public:
  explicit SurfaceInsets(class LAMMPS *lmp) : Pointers(lmp) {}

  /// s of this rank's atoms [um]; `body` by atom; `are_bonded(i, j, history)` of a pair. To be
  /// called when neighbours are listed; ghosts then get theirs by set().
  template <class AreBonded>
  void find(const BondSettings &settings, const BondPairs &pairs, const int *body,
            const AreBonded &are_bonded) {
    begin_count();
    if (settings.inset_fading > 0.0)
      pairs.for_each_neighbor([&](int i, int j, const BondHistory &bond) {
        if (are_bonded(i, j, bond))
          count(i, j);
      });
    end_count(settings, body);
  }
  double of(int i) const { return inset_.empty() ? 0.0 : inset_[i]; }
  void set(int i, double inset);

  /// Where i and j meet, as BondHistory::meeting_distance.
  double meeting_distance(const BondSettings &settings, bool one_body, int i, int j) const {
    const double D = settings.contact_diameter;
    if (one_body)
      return D < 1.0 ? D * (atom->radius[i] + atom->radius[j]) : 0.0;
    return settings.surface_inset > 0.0 ? -(inset_[i] + inset_[j]) : 0.0;
  }
  /// The distance to meet at from now on, where it was `before` and is to become `length`.
  double not_into_contact(int i, int j, double before, double length) const;

private:
  void begin_count();
  void count(int i, int j);
  void end_count(const BondSettings &settings, const int *body);

  std::vector<double> inset_; // of spheres and ghosts [um]; while it counts, bonds
};

} // namespace LAMMPS_NS

#endif
