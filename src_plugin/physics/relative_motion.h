// SPDX-License-Identifier: GPL-2.0-or-later
// How two spheres i and j stand to each other and move: what bonds and contacts are computed from.
//   d = x_i - x_j,  v = v_i - v_j,  n = d/r from j to i
// Source: none, a definition. Verified by tests/unit/physics/bond_pair_test.cpp and
// tests/unit/physics/contact_pair_test.cpp.
#ifndef CALENDEM_PHYSICS_RELATIVE_MOTION_H
#define CALENDEM_PHYSICS_RELATIVE_MOTION_H

#include "vector3.h"

namespace calendem {

/// Motion of the pair at the end of a step; velocities are those that moved it through the step.
struct PairMotion {
  Vec3 d;       ///< x_i - x_j [um]
  Vec3 v;       ///< v_i - v_j [um/us]
  Vec3 spin_i;  ///< omega_i [rad/us]
  Vec3 spin_j;  ///< omega_j [rad/us]
  Vec3 n;       ///< d / r
  double r = 0; ///< |d| [um]
};

inline PairMotion pair_motion(const Vec3 &d, double r, const Vec3 &v, const Vec3 &spin_i,
                              const Vec3 &spin_j) {
  return {d, v, spin_i, spin_j, (1.0 / r) * d, r};
}

/// Where the spheres stand, for what does not depend on their velocities.
inline PairMotion pair_at_rest(const Vec3 &d) { return pair_motion(d, norm(d), {}, {}, {}); }

/// Mass [pg] with which two spheres move against each other.
inline double effective_mass(double mass_i, double mass_j) {
  return mass_i * mass_j / (mass_i + mass_j);
}

} // namespace calendem

#endif
