// SPDX-License-Identifier: GPL-2.0-or-later
// Simplified JKR cohesion (Xu et al., eq. 3): attraction F_C = CED * A with A the area of the
// circle in which two spheres of radii R_i, R_j at centre distance r intersect (the lens's section)
//   A = pi/4 * [(R_i+R_j)^2 - r^2] [r^2 - (R_i-R_j)^2] / r^2
// and 0 outside |R_i-R_j| < r < R_i+R_j. CED: cohesion energy density [kPa = 1e3 J/m^3], >= 0.
// Not conservative at pull-off only through Hertz; the pair force depends on r alone.
// Deviations: none (LIGGGHTS `sjkr` uses the same area; `sjkr2` about twice it).
// Verified by tests/unit/physics/sjkr_cohesion_test.cpp and tests/verification/contact.
#ifndef CALENDEM_PHYSICS_SJKR_COHESION_H
#define CALENDEM_PHYSICS_SJKR_COHESION_H

namespace calendem {

/// Area [um^2] of the lens's section; radii and distance in um.
inline double lens_area(double r, double radius_i, double radius_j) {
  const double sum = radius_i + radius_j;
  const double difference = radius_i - radius_j;
  if (r >= sum || r * r <= difference * difference)
    return 0.0;
  constexpr double kQuarterPi = 0.78539816339744830962;
  return kQuarterPi * (sum - r) * (sum + r) * (r - difference) * (r + difference) / (r * r);
}

/// Attractive force [nN], >= 0.
inline double sjkr_force(double cohesion_energy_density, double r, double radius_i,
                         double radius_j) {
  return cohesion_energy_density * lens_area(r, radius_i, radius_j);
}

} // namespace calendem

#endif
