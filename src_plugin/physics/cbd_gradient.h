// SPDX-License-Identifier: GPL-2.0-or-later
// Carbon-binder domain over the height of a coating: the solvent that leaves through the surface
// takes binder and carbon along.
//   content at z over its mean   c(z) = 1 + g (2 z - 1)
//   share of it below z          F(z) = (1 - g) z + g z^2
//   moment                       <2 z - 1> = g / 3
//   spheres' scatter of it       sd(3 <2 z - 1>) = sqrt((3 - g^2) / N)
// z = 0 at the collector, 1 at the surface; g > 0: more at the surface, (1 + g) / (1 - g) times as
// much as at the collector. Range: -1 <= g <= 1; 0: none. Spheres follow c if
// each of a film without gradient is kept with the chance c / (1 + |g|): all at g = 0. Where bodies
// leave them more room, as at the film's ends, c is what multiplies their content there.
// Energy: none, it is where the spheres are placed. Source: Font et al. 2018 compute binder drawn
// to the surface by fast drying, Nikpour et al. 2022 measure gradients either way; a straight line
// is their first term. Deviations: g is not computed from the drying rate; carbon goes with the
// binder. Verified by tests/unit/physics/cbd_gradient_test.cpp, tests/unit/pack/placement_test.cpp
// and tests/regression/coating.
#ifndef CALENDEM_PHYSICS_CBD_GRADIENT_H
#define CALENDEM_PHYSICS_CBD_GRADIENT_H

#include <cmath>

namespace calendem {

struct CbdGradient {
  double slope = 0.0; ///< g [-], -1 to 1

  /// Content at height z [-] over its mean.
  double content(double z) const { return 1.0 + slope * (2.0 * z - 1.0); }
  double share_below(double z) const { return z * (1.0 - slope + slope * z); }
  /// Chance of a sphere at z to be kept.
  double kept(double z) const { return content(z) / (1.0 + std::fabs(slope)); }
  /// Standard deviation of slope_of of n spheres.
  double scatter(double n) const { return std::sqrt((3.0 - slope * slope) / n); }

  /// The slope with this mean height [-] of the spheres.
  static double slope_of(double mean_height) { return 3.0 * (2.0 * mean_height - 1.0); }
};

} // namespace calendem

#endif
