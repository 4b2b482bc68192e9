// SPDX-License-Identifier: GPL-2.0-or-later
// Residual stress of drying: the binder shrinks while the foil holds the film. Binder bridges
// (binder_bridge.h) come to rest at a length shorter by eps than at their creation:
//   F_n = k_n (r - (1 - eps s) L),   k_n = E A / L,   s = min(1, t / t_d)
// L is the length at creation, t the time since then, t_d that of drying; 0: at once. A bridge
// whose ends are held bears k_n eps L = E A eps. A film whose cell keeps its sides bears the stress
//   sigma = Y eps / (1 - nu)
// in plane and none upwards, with its own effective modulus and Poisson's ratio Y and nu: a
// triangular layer of spacing a is under sqrt(3) k_n eps L / a per width. Bending, shear and twist
// start at rest.
// Signs: tension positive, as in parallel_bond.h.
// Energy: shrinking does the work sum of F_n L d(eps s) on the bridges; over a step, with the mean
// of F_n before and after it, this and the trapezoid work of F_n are the change of F_n^2 / 2 k_n
// exactly.
// Range: 0 <= eps <= 0.03 (kMost), where bridges break at the latest; those of a held film do at
// sigma_c / E. t_d is to be long beside a wave's way through the film, or the load swings.
// Source: Croll, J. Appl. Polym. Sci. 23 (1979) 847: a coating that shrinks on a base after it has
// set. Deviations: no solvent and no capillary pressure; the binder's shrinkage is given, not
// computed; bridges do not creep.
// Verified by tests/unit/physics/drying_shrinkage_test.cpp and tests/verification/drying_stress.
#ifndef CALENDEM_PHYSICS_DRYING_SHRINKAGE_H
#define CALENDEM_PHYSICS_DRYING_SHRINKAGE_H

#include <cmath>

namespace calendem {

struct DryingShrinkage {
  static constexpr double kMost = 0.03; ///< eps [-]

  double strain = 0.0; ///< eps [-], 0 to kMost
  double time = 0.0;   ///< t_d [us], >= 0

  /// s [-] a time dt [us] after it was `s`.
  double later(double s, double dt) const {
    return time > 0.0 ? std::fmin(1.0, s + dt / time) : 1.0;
  }
  /// Length at rest over that at creation [-].
  double rest(double s) const { return 1.0 - strain * s; }
};

} // namespace calendem

#endif
