// SPDX-License-Identifier: GPL-2.0-or-later
// Stable time step of a bonded cluster under velocity Verlet.
// Gershgorin on each sphere: its neighbours moving (turning) in opposition double the sum of its
// bonds' stiffnesses, so no eigenvalue of the cluster exceeds
//   K = max_i { 2 sum k_axis / m_i , 2 sum (k_moment + k_t l^2/4)_axis / I_i },  I = 2/5 m R^2,
// taken per axis. Damping is summed the same way into C. The lagged damping force of the host's
// integrator makes the step stable below
//   dt = (sqrt(C^2 + 4 K) - C) / K      (2/omega when C = 0).
// A bound, not the exact limit: a cubic body is really stable up to about 1.2 times it.
// Contacts enter as bonds along the line of centres with k_n = 2 E* a, k_t = 8 G* a (a: radius of
// the area) and the host's damping c = 2 sqrt(5/6) |beta| sqrt(k m*). Where contacts are still to
// grow, a sphere with six of them, two per axis, stands for all, each under the mean force of a
// packing of solid fraction 0.6 at the pressure P: F = 4 pi R^2 P/(0.6 * 6). Of a bonded pair the
// stiffer of bond and contact bears F: softer bonds count beside the six contacts, stiffer ones
// without. Also here: Rayleigh
// time T_R = pi R sqrt(rho/G) / (0.1631 nu + 0.8766). Deviations: none (the paper uses 1.5 % of the
// Rayleigh time). Verified by tests/unit/physics/time_step_bound_test.cpp and
// tests/verification/timestep.
#ifndef CALENDEM_PHYSICS_TIME_STEP_BOUND_H
#define CALENDEM_PHYSICS_TIME_STEP_BOUND_H

#include "parallel_bond.h"
#include <initializer_list>

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
  void add(const BondRowSum &more) {
    for (int a = 0; a < 3; ++a) {
      translation[a] += more.translation[a];
      rotation[a] += more.rotation[a];
    }
  }
};

/// Contact with an area of radius a [um]; E*, G* [kPa].
inline BondCoefficients contact_stiffness(double E_eff, double G_eff, double a) {
  return {2.0 * E_eff * a, 8.0 * G_eff * a, 0.0, 0.0};
}

/// |beta| = |ln e|/sqrt(ln^2 e + pi^2), e the restitution; mass_eff [pg].
inline BondCoefficients contact_damping(const BondCoefficients &k, double beta, double mass_eff) {
  const double c = 2.0 * std::sqrt(5.0 / 6.0) * std::fabs(beta);
  return {c * std::sqrt(k.normal * mass_eff), c * std::sqrt(k.shear * mass_eff), 0.0, 0.0};
}

/// Mean normal force [nN] on a contact of spheres of this radius [um] under a pressure [kPa].
inline double mean_contact_force(double pressure, double radius) {
  return 4.0 * kPi * radius * radius * pressure / (0.6 * 6.0);
}

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

/// Bound [us] for a sphere with six such contacts beside the rows `k` and `c`.
inline double stable_step_of_contacts(const BondCoefficients &stiffness,
                                      const BondCoefficients &damping, double mass, double radius,
                                      BondRowSum k = BondRowSum(), BondRowSum c = BondRowSum()) {
  for (const Vec3 &n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    for (int side = 0; side < 2; ++side) {
      k.add(stiffness, n, 2.0 * radius);
      c.add(damping, n, 2.0 * radius);
    }
  return stable_step(k, c, mass, radius);
}

} // namespace calendem

#endif
