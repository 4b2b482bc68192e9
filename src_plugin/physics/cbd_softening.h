// SPDX-License-Identifier: GPL-2.0-or-later
// Carbon black and PVdF under warm rolls: moduli and limits of pressure of the carbon-binder domain
// become smaller by one factor,
//   f = exp(-(T - 25)/tau),   tau = 106 K
// 1 at 25 C. Its modulus E, the limit p_y of its contacts with its hardening, and the pressure at
// which its nanopores collapse with its scale are multiplied by f: Hertz's law and the yield overlap
// (p_y/E)^2 keep their form. Cohesion, Poisson's ratio, friction and the bulk of confined spheres stay.
// Signs: T above 25 C softens. Energy: conservative as the laws it scales; T does not change in a run.
// Range: 10 to 120 C (kColdest, kHottest), from below room temperature to rolls in use; beyond what
// was measured (25 to 80 C) it is extrapolated. The whole film has the rolls' temperature.
// Source: Hong et al. 2026, doi:10.1016/j.ensm.2026.105321, carbon black and PVdF 1 : 1: at 80 C a
// modulus smaller by 41 %, f = 0.59; depth under a sphere at equal load 1193 nm at 25 C, 1948 nm at
// 80 C, which in full plasticity goes as 1/p_y, f = 0.612. They ask for tau of 104.2 and 112.2 K;
// 106 K, f(80) = 0.595, lies within 1 % of the one and 3 % of the other.
// Deviations: none of the measurements gives the law between 25 and 80 C; the exponential is assumed.
// Verified by tests/unit/physics/cbd_softening_test.cpp and tests/verification/cbd_softening.
#ifndef CALENDEM_PHYSICS_CBD_SOFTENING_H
#define CALENDEM_PHYSICS_CBD_SOFTENING_H

#include <cmath>

namespace calendem {

struct CbdSoftening {
  static constexpr double kReference = 25.0;                 ///< [C]
  static constexpr double kScale = 106.0;                    ///< tau [K]
  static constexpr double kColdest = 10.0, kHottest = 120.0; ///< [C]

  /// f [-] at `temperature` [C].
  static double factor(double temperature) {
    return std::exp(-(temperature - kReference) / kScale);
  }
};

} // namespace calendem

#endif
