// SPDX-License-Identifier: GPL-2.0-or-later
// Bonded-particle model: the elastic cylinder (parallel bond) between two primary spheres.
//
// Equations (Xu et al., eqs 4-5, after Potyondy & Cundall 2004, doi:10.1016/j.ijrmms.2004.09.011):
//   dF_n = (E A / l) v_n dt        dF_t = (G A / l) v_t dt,  G = E / (2 (1 + nu))
//   dM_n = (G J / l) w_n dt        dM_t = (E I / l) w_t dt
//   A = pi R^2,  I = pi R^4 / 4,  J = 2 I,  R = lambda min(R_i, R_j),  l = centre distance at
//   creation
//
// Kinematics. d = x_i - x_j, n = d / |d|. The bond is cut at the middle of the centre line, so both
// arms are d/2 whatever the radii, overlap or gap, and the relative velocity at the cut is
//   u = v_i - v_j - (w_i + w_j) / 2 x d.
// A rigid motion gives u = 0 identically. Over a step v is the chord (d_new - d_old)/dt, which
// belongs to the middle of the step; d and n of eqs 4-5 are taken there too. Stored vectors follow
// the pair's rigid rotation tau (swing from the centres' velocities, twist from the mean spin along
// the line) by the midpoint rule F' - F = tau x (F' + F) + dF. An increment along the line turns
// into one along n_new, where the last projection drops it.
//
// Signs: F_n > 0 is tension. F_t, M_n n and M_t act on particle i, their opposites on j.
// Energy: F_n^2/2k_n + F_t^2/2k_t + M_n^2/2k_w + M_t^2/2k_b. By the midpoint rule its change over a
// step is the trapezoid work of the loads, which velocity Verlet takes from the kinetic energy:
// bodies that spin and vibrate keep theirs within Verlet's own swing, O(dt^2), without drift (1e6
// production steps at 10 rad/us move the mean by 2e-9). `damping` adds viscous forces that are not
// stored and do not enter failure.
// Valid for 0.01 <= |d|/l <= 10 and turns below 1 rad per step; outside the host stops the run.
// Deviations: F_n is the exact integral of eq. 4, E A (|d| - l)/l, not a running sum, so it cannot
// drift; the paper's R_min in eqs 6-7 is R (they agree at lambda = 1).
// Verified by tests/unit/physics/parallel_bond_test.cpp,
// tests/unit/physics/parallel_bond_energy_test.cpp and tests/verification/pair, rotation, cluster.
#ifndef CALENDEM_PHYSICS_PARALLEL_BOND_H
#define CALENDEM_PHYSICS_PARALLEL_BOND_H

#include "pi.h"
#include "relative_motion.h"
#include "vector3.h"

namespace calendem {

/// Material and geometry shared by all bonds of a run.
struct BondMaterial {
  double youngs_modulus = 0.0; ///< E_b [kPa], > 0
  double shear_modulus = 0.0;  ///< G_b [kPa], > 0
  double radius_ratio = 1.0;   ///< lambda [-], (0, 1.5]
  double damping = 0.0; ///< fraction of critical damping of the pair's axial mode [-], [0, 1]
  double rest = 1.0;    ///< length without tension over that at creation [-]; binder_bridge.h
};

inline double shear_modulus(double youngs_modulus, double poisson_ratio) {
  return youngs_modulus / (2.0 * (1.0 + poisson_ratio));
}

/// Section of the cylinder. Lengths in um.
struct BondSection {
  double radius; ///< R
  double area;   ///< A
  double I;      ///< second moment of area; J = 2 I

  explicit BondSection(double R) : radius(R), area(kPi * R * R), I(0.25 * area * R * R) {}
};

/// One coefficient per way in which a bond deforms: stiffnesses k_n, k_t [nN/um], k_twist, k_bend
/// [nN um/rad], or viscous coefficients of the same times us.
struct BondCoefficients {
  double normal = 0.0;
  double shear = 0.0;
  double twist = 0.0;
  double bend = 0.0;
};

struct BondStiffness : BondCoefficients {
  BondStiffness(const BondMaterial &m, const BondSection &s, double length) {
    const double inverse_length = 1.0 / length;
    normal = m.youngs_modulus * s.area * inverse_length;
    shear = m.shear_modulus * s.area * inverse_length;
    bend = m.youngs_modulus * s.I * inverse_length;
    twist = 2.0 * m.shear_modulus * s.I * inverse_length;
  }
};

/// F_n [nN] at the centre distance r of a bond of that length [um] at creation.
inline double bond_tension(const BondMaterial &m, const BondStiffness &k, double r, double length) {
  return k.normal * (r - m.rest * length);
}

/// Loads that a bond remembers, as acting on particle i.
struct BondLoads {
  Vec3 shear;         ///< F_t [nN], at right angles to n
  Vec3 bending;       ///< M_t [nN um], at right angles to n
  double twist = 0.0; ///< M_n [nN um], along n
};

/// Velocity of i relative to j where the bond is cut; `d` is the centre line.
inline Vec3 cut_velocity(const PairMotion &m, const Vec3 &d) {
  return m.v - 0.5 * cross(m.spin_i + m.spin_j, d);
}

/// Centre line in the middle of the step that ended at m.d.
inline Vec3 middle_of(const PairMotion &m, double dt) { return m.d - (0.5 * dt) * m.v; }

/// Rotation of the pair during a step as the Cayley vector tan(angle/2) * axis.
inline Vec3 pair_rotation(const PairMotion &m, const Vec3 &middle, double inverse_square,
                          double dt) {
  const double along = 0.5 * dot(m.spin_i + m.spin_j, middle);
  return (0.5 * dt * inverse_square) * (cross(middle, m.v) + along * middle);
}

/// Turns `a` by the Cayley vector `tau`; keeps its length for any |tau|.
inline Vec3 turn(const Vec3 &a, const Vec3 &tau, double two_over_1_plus_tau2) {
  const Vec3 ta = cross(tau, a);
  return a + two_over_1_plus_tau2 * (ta + cross(tau, ta));
}

/// Carries the loads through one step of length dt [us]. The midpoint rule above, solved for F', is
/// turn(F + dF/2) + dF/2.
inline void advance(BondLoads &loads, const PairMotion &m, const BondStiffness &k, double dt) {
  const Vec3 middle = middle_of(m, dt);
  const double inverse_square = 1.0 / norm_squared(middle);
  const Vec3 tau = pair_rotation(m, middle, inverse_square, dt);
  const double c = 2.0 / (1.0 + norm_squared(tau));
  const Vec3 spin = m.spin_i - m.spin_j;
  const Vec3 half_shear = (-0.5 * k.shear * dt) * cut_velocity(m, middle);
  const Vec3 half_bending = (-0.5 * k.bend * dt) * spin;
  loads.shear = reject(turn(loads.shear + half_shear, tau, c) + half_shear, m.n);
  loads.bending = reject(turn(loads.bending + half_bending, tau, c) + half_bending, m.n);
  loads.twist -= (k.twist * dt * std::sqrt(inverse_square)) * dot(spin, middle);
}

/// Force and moment on particle i. On j act the opposite force and `torque_j`.
struct BondAction {
  Vec3 force;
  Vec3 torque_i;
  Vec3 torque_j;
};

/// Viscous coefficients from one square root: k_n, k_t, ... share A, I and l.
struct BondDamping : BondCoefficients {
  BondDamping() = default;

  /// mass_eff [pg] = m_i m_j / (m_i + m_j); radius_min [um] = min(R_i, R_j).
  BondDamping(const BondMaterial &m, const BondSection &s, const BondStiffness &k, double mass_eff,
              double radius_min) {
    if (m.damping <= 0.0)
      return;
    const double ratio = std::sqrt(m.shear_modulus / m.youngs_modulus);
    normal = 2.0 * m.damping * std::sqrt(k.normal * mass_eff);
    shear = normal * ratio;
    bend = normal * 0.5 * std::sqrt(0.4) * s.radius * radius_min;
    twist = bend * std::sqrt(2.0) * ratio;
  }
};

/// Total action of the bond: elastic loads, tension and damping, with the moments of the shear
/// force about both centres, so that linear and angular momentum are conserved to round-off.
inline BondAction action(const BondLoads &loads, double tension, const PairMotion &m,
                         const BondDamping &c) {
  Vec3 shear = loads.shear;
  Vec3 moment = loads.bending + loads.twist * m.n;
  double normal = tension;
  if (c.normal > 0.0) {
    const Vec3 spin = m.spin_i - m.spin_j;
    const double spin_n = dot(spin, m.n);
    shear = shear - c.shear * reject(cut_velocity(m, m.d), m.n);
    moment = moment - c.bend * (spin - spin_n * m.n) - (c.twist * spin_n) * m.n;
    normal += c.normal * dot(m.v, m.n);
  }
  const Vec3 lever = 0.5 * cross(m.d, shear);
  return {shear - normal * m.n, moment - lever, -(moment + lever)};
}

/// The part of it that the bond dissipates by.
inline BondAction damping_action(const PairMotion &m, const BondDamping &c) {
  return action(BondLoads(), 0.0, m, c);
}

/// Elastic energy [fJ] of a bond.
inline double strain_energy(const BondLoads &loads, double tension, const BondStiffness &k) {
  return 0.5 * (tension * tension / k.normal + norm_squared(loads.shear) / k.shear +
                loads.twist * loads.twist / k.twist + norm_squared(loads.bending) / k.bend);
}

} // namespace calendem

#endif
