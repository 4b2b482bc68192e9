// SPDX-License-Identifier: GPL-2.0-or-later
// How far contacts are beyond the range of Hertz' law (hertz_contact.h).
//   strain of a contact: s = delta / R_min,  R_min the smaller radius of the pair, R at a flat wall
// delta is the overlap [um] that the law acts on: for a bonded pair, the overlap beyond the one at
// the bond's creation. Hertz' law asks for a contact radius a << R of each body, for its strains
// are of order a/R (Johnson, Contact Mechanics, 1985, section 4.2); a^2 = R* delta, so for equal
// spheres a/R_min = sqrt(s/2), and 0.22, 0.32, 0.39 at the limits below; at a wall sqrt(s).
// What lies beyond is counted, not corrected. Verified by
// tests/unit/physics/contact_range_test.cpp, tests/verification/contact_range.
#ifndef CALENDEM_PHYSICS_CONTACT_RANGE_H
#define CALENDEM_PHYSICS_CONTACT_RANGE_H

namespace calendem {

inline constexpr int kRangeLimits = 3;
inline constexpr double kRangeLimit[kRangeLimits] = {0.1, 0.2, 0.3};

/// Sums over contacts; add `of` of all ranks, but take their largest `largest`.
struct ContactRange {
  enum { kContacts, kForce, kStrain, kBeyond, kForceBeyond = kBeyond + kRangeLimits };
  static constexpr int kSums = kForceBeyond + kRangeLimits;

  double of[kSums] =
      {}; ///< contacts, force [nN], strain; of those beyond each limit: contacts, force
  double largest = 0.0; ///< strain

  /// @param overlap [um] > 0  @param smaller_radius [um] > 0  @param force [nN] > 0, elastic,
  /// normal
  void add(double overlap, double smaller_radius, double force) {
    const double strain = overlap / smaller_radius;
    of[kContacts] += 1.0;
    of[kForce] += force;
    of[kStrain] += strain;
    largest = strain > largest ? strain : largest;
    for (int k = 0; k < kRangeLimits; ++k)
      if (strain > kRangeLimit[k]) {
        of[kBeyond + k] += 1.0;
        of[kForceBeyond + k] += force;
      }
  }
  double mean() const { return of[kContacts] > 0.0 ? of[kStrain] / of[kContacts] : 0.0; }
};

} // namespace calendem

#endif
