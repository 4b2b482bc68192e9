// SPDX-License-Identifier: GPL-2.0-or-later
// How far inside the tip of a primary the surface of its body lies for others.
//   s = S (1 - F (1 - min(1, n / 6)))
// S is the inset on a whole body [um], F the part of it that goes with the bonds, n the number of
// bonds of the primary. A grain on the surface of a body has six to seven; without any it is a
// sphere that has the grain's own volume up to its tips. So small bodies and fragments keep the
// volume of their grains (docs/model/particles.md). Verified by tests/unit/physics/surface_inset_test.cpp,
// tests/unit/pack/surface_test.cpp and tests/verification/slip.
#ifndef CALENDEM_PHYSICS_SURFACE_INSET_H
#define CALENDEM_PHYSICS_SURFACE_INSET_H

#include <cmath>

namespace calendem {

inline constexpr double kBondsOnASurface = 6.0;

/// Inset [um] of a primary with that many bonds; `whole` [um], `fading` from 0 to 1.
inline double surface_inset(double whole, double fading, double bonds) {
  return whole * (1.0 - fading * (1.0 - std::fmin(1.0, bonds / kBondsOnASurface)));
}

} // namespace calendem

#endif
