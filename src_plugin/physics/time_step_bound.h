// SPDX-License-Identifier: GPL-2.0-or-later
// Stable time step of a bonded cluster under velocity Verlet.
// Gershgorin on each sphere: its neighbours moving (turning) in opposition double the sum of its
// bonds' stiffnesses, so no eigenvalue of the cluster exceeds
//   K = max_i { 2 sum k_axis / m_i , 2 sum (k_moment + k_t l^2/4)_axis / I_i },  I = 2/5 m R^2,
// taken per axis. Damping is summed the same way into C. The lagged damping force of the host's
// integrator makes the step stable below
//   dt = (sqrt(C^2 + 4 K) - C) / K      (2/omega when C = 0).
// A bound, not the exact limit: a cubic body is really stable up to about 1.2 times it.
// Also here: Rayleigh time T_R = pi R sqrt(rho/G) / (0.1631 nu + 0.8766).
// Deviations: none (the paper uses 1.5 % of the Rayleigh time).
// Verified by tests/unit/physics/time_step_bound_test.cpp and tests/verification/timestep.
#ifndef CALENDEM_PHYSICS_TIME_STEP_BOUND_H
#define CALENDEM_PHYSICS_TIME_STEP_BOUND_H

#include "parallel_bond.h"

namespace calendem {

inline double rayleigh_time(double radius, double density, double E, double nu) {
  return kPi * radius * std::sqrt(density / shear_modulus(E, nu)) / (0.1631 * nu + 0.8766);
}

/// Sums over the bonds of one sphere, per axis.
struct BondRowSum {
  double translation[3] = {0.0, 0.0, 0.0};
  double rotation[3] = {0.0, 0.0, 0.0};

  void add(const BondCoefficients &k, const Vec3 &n, double length) {
    const double nn[3] = {n.x * n.x, n.y * n.y, n.z * n.z};
    const double arm = 0.25 * length * length * k.shear;
    for (int a = 0; a < 3; ++a) {
      translation[a] += k.normal * nn[a] + k.shear * (1.0 - nn[a]);
      rotation[a] += k.twist * nn[a] + (k.bend + arm) * (1.0 - nn[a]);
    }
  }
};

/// Largest stable step [us] for one row: K [1/us^2], C [1/us].
inline double stable_step(double K, double C) {
  return K > 0.0 ? (std::sqrt(C * C + 4.0 * K) - C) / K : HUGE_VAL;
}

/// Bound [us] that one sphere of mass [pg] and radius [um] sets; infinite without bonds.
inline double stable_step(const BondRowSum &stiffness, const BondRowSum &damping, double mass,
                          double radius) {
  const double inertia = 0.4 * mass * radius * radius;
  double least = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    const double dt_t =
        stable_step(2.0 * stiffness.translation[a] / mass, 2.0 * damping.translation[a] / mass);
    const double dt_r =
        stable_step(2.0 * stiffness.rotation[a] / inertia, 2.0 * damping.rotation[a] / inertia);
    least = std::fmin(least, std::fmin(dt_t, dt_r));
  }
  return least;
}

} // namespace calendem

#endif
