// SPDX-License-Identifier: GPL-2.0-or-later
// Stable time step of a bonded cluster under velocity Verlet, whatever the directions of its bonds.
// x_i = (u, theta) is how far sphere i moves and turns, B_i x_i = (u + theta x arm, theta) what of it
// arrives where a bond is cut, D = diag(k_n, k_t, k_t, k_twist, k_bend, k_bend) along and across the
// bond. Twice its energy is the square of a difference, with |a - b|^2 <= 2 |a|^2 + 2 |b|^2:
//   |B_i x_i - B_j x_j|^2_D <= 2 x_i^T B_i^T D B_i x_i + 2 x_j^T B_j^T D B_j x_j.
// The sum over all bonds falls apart into a block for each sphere: what its bonds resist it with,
// doubled by neighbours in opposition. So for the damping coefficients, C_i:
//   x^T K x <= sum over i of x_i^T (2 K_i) x_i,   K_i = sum over the bonds of i of B_i^T D B_i.
// The damping force of the host's integrator lags. With masses and inertias I = 2/5 m R^2 scaled to
// one, a mode z^n x, x* x = 1, under
//   u(n+1) - 2 u(n) + u(n-1) = -dt C (u(n) - u(n-1)) - dt^2 K u(n)
// fulfils z^2 - (2 - dt c - dt^2 k) z + 1 - dt c = 0 with c = x* C x, k = x* K x. Both roots lie
// within the unit circle if dt^2 k + 2 dt c <= 4, hence all modes do if for each sphere
//   2 - dt^2 K_i - 2 dt C_i   is positive definite.
// The bound is the largest such dt of 24 binary digits, so that the order of the bonds does not
// matter. Of one oscillator it is dt = (sqrt(C^2 + 4 K) - C)/K, 2/omega when C = 0. A bound, not the
// exact limit: a cubic body is really stable up to about 1.2 times it. Left out: a loaded bond also
// turns its load, which adds stiffness in proportion to its strain.
// Contacts enter as bonds along the line of centres with k_n = 2 E* a, k_t = 8 G* a (a: radius of
// the area), arms R, the longest, and the host's damping c = 2 sqrt(5/6) |beta| sqrt(k m*). Where
// contacts are still to grow, a sphere with six of them, two per axis, stands for all, each under
// the mean force of a packing of solid fraction 0.6 at the pressure P: F = 4 pi R^2 P/(0.6 * 6). Of
// a bonded pair the stiffer of bond and contact bears F: softer bonds count beside the six contacts,
// stiffer ones without. Also here: Rayleigh time T_R = pi R sqrt(rho/G) / (0.1631 nu + 0.8766).
// Deviations: none (the paper uses 1.5 % of the Rayleigh time). Verified by
// tests/unit/physics/time_step_bound_test.cpp and tests/verification/timestep.
#ifndef CALENDEM_PHYSICS_TIME_STEP_BOUND_H
#define CALENDEM_PHYSICS_TIME_STEP_BOUND_H

#include "parallel_bond.h"
#include <initializer_list>

namespace calendem {

inline double rayleigh_time(double radius, double density, double E, double nu) {
  return kPi * radius * std::sqrt(density / shear_modulus(E, nu)) / (0.1631 * nu + 0.8766);
}

/// K_i or C_i of one sphere. What couples its motion u and its turn theta is u (c x theta), c a sum
/// of k_t arm n.
struct SphereBlock {
  double translation[3][3] = {}, rotation[3][3] = {};
  Vec3 coupling;

  /// `n` points from the other sphere to this one; `length` is twice the arm.
  void add(const BondCoefficients &k, const Vec3 &n, double length) {
    const double arm = 0.5 * length, turn = k.bend + arm * arm * k.shear;
    const double nn[3] = {n.x, n.y, n.z};
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        translation[a][b] += (k.normal - k.shear) * nn[a] * nn[b];
        rotation[a][b] += (k.twist - turn) * nn[a] * nn[b];
      }
      translation[a][a] += k.shear;
      rotation[a][a] += turn;
    }
    coupling = coupling + (arm * k.shear) * n;
  }
  void add(const SphereBlock &more) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        translation[a][b] += more.translation[a][b];
        rotation[a][b] += more.rotation[a][b];
      }
    coupling = coupling + more.coupling;
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

/// Largest stable step [us] of one oscillator: K [1/us^2], C [1/us].
inline double stable_step(double K, double C) {
  return K > 0.0 ? (std::sqrt(C * C + 4.0 * K) - C) / K : HUGE_VAL;
}

/// A sphere's blocks, scaled by mass [pg] and inertia.
class ScaledSphere {
public:
  ScaledSphere(const SphereBlock &stiffness, const SphereBlock &damping, double mass, double radius)
      : mass_(mass), inertia_(0.4 * mass * radius * radius) {
    scale(stiffness, K_);
    scale(damping, C_);
  }

  /// At no larger step than this [us] is each axis stable by itself; infinite without bonds.
  double step_of_axes() const {
    double least = HUGE_VAL;
    for (int a = 0; a < 6; ++a)
      least = std::fmin(least, stable_step(2.0 * K_[a][a], 2.0 * C_[a][a]));
    return least;
  }
  /// True if 2 - dt^2 K - 2 dt C is positive definite: if its pivots are.
  bool is_stable(double dt) const {
    double left[6][6];
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b <= a; ++b)
        left[a][b] = (a == b ? 2.0 : 0.0) - dt * (dt * K_[a][b] + 2.0 * C_[a][b]);
    for (int p = 0; p < 6; ++p) {
      if (!(left[p][p] > 0.0))
        return false;
      for (int a = p + 1; a < 6; ++a)
        for (int b = p + 1; b <= a; ++b)
          left[a][b] -= left[a][p] * left[b][p] / left[p][p];
    }
    return true;
  }

private:
  double mass_, inertia_;
  double K_[6][6] = {}, C_[6][6] = {}; // the lower halves

  void scale(const SphereBlock &block, double (&to)[6][6]) const {
    const Vec3 c = (1.0 / std::sqrt(mass_ * inertia_)) * block.coupling;
    const double cross[3][3] = {{0.0, c.z, -c.y}, {-c.z, 0.0, c.x}, {c.y, -c.x, 0.0}};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        to[a][b] = block.translation[a][b] / mass_;
        to[a + 3][b + 3] = block.rotation[a][b] / inertia_;
        to[a + 3][b] = cross[a][b];
      }
  }
};

/// Bound [us] that one sphere of mass [pg] and radius [um] sets; infinite without bonds. Where it is
/// above `enough`, that is returned.
inline double stable_step(const SphereBlock &stiffness, const SphereBlock &damping, double mass,
                          double radius, double enough = HUGE_VAL) {
  const ScaledSphere sphere(stiffness, damping, mass, radius);
  const double most = sphere.step_of_axes();
  if (most == HUGE_VAL || (enough < most && sphere.is_stable(enough)))
    return std::fmin(most, enough);
  float high = static_cast<float>(most), low = high / 8.0f; // six axes at a sixth of it are stable
  for (float middle = 0.5f * (low + high); low < middle && middle < high;
       middle = 0.5f * (low + high))
    (sphere.is_stable(middle) ? low : high) = middle;
  return low;
}

/// Bound [us] for a sphere with six such contacts beside the blocks `k` and `c`.
inline double stable_step_of_contacts(const BondCoefficients &stiffness,
                                      const BondCoefficients &damping, double mass, double radius,
                                      SphereBlock k = SphereBlock(),
                                      SphereBlock c = SphereBlock()) {
  for (const Vec3 &n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    for (int side = 0; side < 2; ++side) {
      k.add(stiffness, (side ? -1.0 : 1.0) * n, 2.0 * radius);
      c.add(damping, (side ? -1.0 : 1.0) * n, 2.0 * radius);
    }
  return stable_step(k, c, mass, radius);
}

} // namespace calendem

#endif
