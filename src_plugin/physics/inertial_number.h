// SPDX-License-Identifier: GPL-2.0-or-later
// Inertial number of a film under a platen: the time in which the pressure moves a sphere by its
// diameter, over the time in which the film is strained by 1.
//   I = |v| / h * d * sqrt(rho / P)
// I below 1e-3 is quasi-static, from 1e-3 to 0.1 a dense flow (GDR MiDi, Eur. Phys. J. E 14, 2004,
// 341-365, for shear rates). Deviations: the rate is that of compression, v/h. Verified by
// tests/unit/physics/inertial_number_test.cpp.
#ifndef CALENDEM_PHYSICS_INERTIAL_NUMBER_H
#define CALENDEM_PHYSICS_INERTIAL_NUMBER_H

#include <cmath>

namespace calendem {

inline constexpr double kQuasiStaticInertialNumber = 1e-3;

/// Mean over the spheres of the active material.
struct MeanSphere {
  double diameter = 0.0; ///< [um]
  double density = 0.0;  ///< mass over volume of the spheres [g/cm3 = pg/um3]
};

/// @param speed of the platen [um/us], either sign  @param gap thickness of the film [um] > 0
/// @param pressure [kPa]; NaN where it is not positive: nothing holds the film together
inline double inertial_number(double speed, double gap, const MeanSphere &sphere, double pressure) {
  return pressure > 0.0
             ? std::fabs(speed) / gap * sphere.diameter * std::sqrt(sphere.density / pressure)
             : std::nan("");
}

} // namespace calendem

#endif
