// SPDX-License-Identifier: GPL-2.0-or-later
// Simplified JKR cohesion (Xu et al., eq. 3): attraction F_C = CED * A with A the area of the
// circle in which two spheres of radii R_i, R_j at centre distance r intersect (the lens's section)
//   A = pi/4 * [(R_i+R_j)^2 - r^2] [r^2 - (R_i-R_j)^2] / r^2
// and 0 outside |R_i-R_j| < r < R_i+R_j. CED: cohesion energy density [kPa = 1e3 J/m^3], >= 0.
// Conservative: the force depends on r alone. With S = R_i + R_j, D = R_i - R_j its potential is
//   U = -CED * integral of A from r to S = -CED pi/4 (S - r)^2 [(2 S + r)/3 - D^2/r]
// A flat wall at distance r from the centre (the limit R_j -> infinity):
//   A = pi (R^2 - r^2),  U = -CED pi (R - r)^2 (2 R + r)/3
// Deviations: none; LIGGGHTS `sjkr` uses the same areas. `sjkr2` takes 4 pi R* delta between
// spheres, about twice: a CED that belongs to it has half its cohesion here, and the same at walls.
// Verified by tests/unit/physics/sjkr_cohesion_test.cpp and tests/verification/contact.
#ifndef CALENDEM_PHYSICS_SJKR_COHESION_H
#define CALENDEM_PHYSICS_SJKR_COHESION_H

#include "pi.h"

namespace calendem {

/// Area [um^2] of the lens's section; radii and distance in um.
inline double lens_area(double r, double radius_i, double radius_j) {
  const double sum = radius_i + radius_j;
  const double difference = radius_i - radius_j;
  if (r >= sum || r * r <= difference * difference)
    return 0.0;
  // grouped so that exchanging the spheres changes no bit
  return 0.25 * kPi * (sum - r) * (sum + r) * ((r - difference) * (r + difference)) / (r * r);
}

/// Attractive force [nN], >= 0.
inline double sjkr_force(double cohesion_energy_density, double r, double radius_i,
                         double radius_j) {
  return cohesion_energy_density * lens_area(r, radius_i, radius_j);
}

/// Pull of a flat wall, `r` from the centre.
inline double sjkr_wall_force(double cohesion_energy_density, double r, double radius) {
  return r < radius ? cohesion_energy_density * kPi * (radius - r) * (radius + r) : 0.0;
}

inline double sjkr_wall_potential(double cohesion_energy_density, double r, double radius) {
  if (r >= radius)
    return 0.0;
  return -cohesion_energy_density * kPi * (radius - r) * (radius - r) * (2.0 * radius + r) / 3.0;
}

/// Potential [fJ], <= 0, zero at first touch; below r = |R_i - R_j|, where no force acts, constant.
inline double sjkr_potential(double cohesion_energy_density, double r, double radius_i,
                             double radius_j) {
  const double sum = radius_i + radius_j;
  const double difference = radius_i > radius_j ? radius_i - radius_j : radius_j - radius_i;
  if (r >= sum)
    return 0.0;
  if (r <= difference) // of equal spheres D^2/r has the limit 0
    r = difference;
  const double last = r > 0.0 ? difference * difference / r : 0.0;
  return -cohesion_energy_density * 0.25 * kPi * (sum - r) * (sum - r) *
         ((2.0 * sum + r) / 3.0 - last);
}

} // namespace calendem

#endif
