// SPDX-License-Identifier: GPL-2.0-or-later
// How far contacts are beyond the range of Hertz' law (hertz_contact.h), or of the law that takes its
// place (law_interface.h: range).
//   strain of a contact: s = delta / R_min,  R_min the smaller radius of the pair, R at a flat wall
// delta is the overlap [um] that the law acts on: for a bonded pair, the overlap beyond the one at
// the bond's creation. Hertz' law asks for a contact radius a << R of each body, for its strains
// are of order a/R (Johnson, Contact Mechanics, 1985, section 4.2); a^2 = R* delta, so for equal
// spheres a/R_min = sqrt(s/2), and 0.22, 0.32, 0.39 at the limits below; at a wall sqrt(s). The
// parabola in place of the sphere is the smaller error: alone it makes a rigid sphere on a
// half-space 1, 2, 3 % too stiff at the limits (against Sneddon, Int. J. Eng. Sci. 3, 1965, 47-57).
// The larger one is the half-space, which a small sphere with contacts all round is not.
// What lies beyond is counted, not corrected. Verified by tests/unit/physics/contact_range_test.cpp
// and tests/verification/contact_range.
#ifndef CALENDEM_PHYSICS_CONTACT_RANGE_H
#define CALENDEM_PHYSICS_CONTACT_RANGE_H

namespace calendem {

inline constexpr int kRangeLimits = 4; ///< the last: the range of the contact's own law
inline constexpr double kRangeLimit[kRangeLimits - 1] = {0.1, 0.2, 0.3};
inline constexpr double kHertzRange = 0.2;

/// Sums over contacts. Of several ranks: add `of`, take the largest `largest`.
struct ContactRange {
  /// Number, force [nN], strain; then number and force of those beyond each limit.
  enum { kContacts, kForce, kStrain, kBeyond, kForceBeyond = kBeyond + kRangeLimits };
  static constexpr int kSums = kForceBeyond + kRangeLimits;

  double of[kSums] = {};
  double largest = 0.0; ///< strain

  /// @param overlap [um] > 0  @param smaller_radius [um] > 0  @param force [nN] > 0, elastic
  /// @param range of its law, of the smaller radius
  void add(double overlap, double smaller_radius, double force, double range = kHertzRange) {
    const double strain = overlap / smaller_radius;
    of[kContacts] += 1.0;
    of[kForce] += force;
    of[kStrain] += strain;
    largest = strain > largest ? strain : largest;
    for (int k = 0; k < kRangeLimits; ++k)
      if (strain > (k < kRangeLimits - 1 ? kRangeLimit[k] : range)) {
        of[kBeyond + k] += 1.0;
        of[kForceBeyond + k] += force;
      }
  }
  double mean() const { return of[kContacts] > 0.0 ? of[kStrain] / of[kContacts] : 0.0; }
};

} // namespace calendem

#endif
