// SPDX-License-Identifier: GPL-2.0-or-later
// What the contact of two spheres acts on where their surfaces do not meet at the sum of radii: at
// a bond's creation, inside a primary whose surface lies deeper, or where primaries of one body
// meet. With r the distance of the centres and d_0 >= 0 the overlap from which the contact counts
// (its reference)
//   overlap  d = max(0, R_i + R_j - r - d_0)      for Hertz and the laws that take its place
//   distance r' = r + d_0                         for cohesion, whose lens ends at r' = R_i + R_j
// All in um. Whoever takes a force, an energy, a stiffness or a pressure from an overlap takes it
// from here. Source: none, a definition. Verified by
// tests/unit/physics/acting_contact_test.cpp and tests/verification/acting_contact.
#ifndef CALENDEM_PHYSICS_ACTING_CONTACT_H
#define CALENDEM_PHYSICS_ACTING_CONTACT_H

namespace calendem {

inline double acting_overlap(double radius_sum, double r, double reference) {
  const double beyond = radius_sum - r - reference;
  return beyond > 0.0 ? beyond : 0.0;
}

inline double acting_distance(double r, double reference) { return r + reference; }

/// A contact as its laws see it.
struct ActingContact {
  double overlap;  ///< [um], 0: no force of Hertz
  double distance; ///< [um]
  bool coheres;    ///< cohesion acts: the pair is not bonded
};

} // namespace calendem

#endif
