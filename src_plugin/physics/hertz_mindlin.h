// SPDX-License-Identifier: GPL-2.0-or-later
// Hertz-Mindlin contact with viscous damping and Coulomb friction (Xu et al., eqs 1-2), the same
// arithmetic as the host's `model hertz tangential history`, bit for bit.
//   F_n = 4/3 E* a delta - gamma_n v_n,   a = sqrt(R* delta)
//   F_t = -k_t s - gamma_t v_t,           k_t = 8 G* a,  |F_t| <= mu |F_n|
//   gamma_n = c sqrt(2 E* a m*),  gamma_t = c sqrt(8 G* a m*),  c = -2 sqrt(5/6) beta,
//   beta = ln e / sqrt(ln^2 e + pi^2)
// s: tangential displacement, integrated and kept at right angles to n; a sliding contact has no
// damping and s is shortened to the force it still carries.
// Signs: n points from j to i; forces act on i, their opposites on j; F_n > 0 repels.
// Energy: dissipates by damping and slip; the normal force without damping is conservative.
// Valid for delta << R (physics/hertz_contact.h); beyond it the law goes on as written.
// Source: Tsuji et al. 1992 (damping), Johnson, Contact Mechanics, ch. 4 and 7.
// Deviations: none from the host. Verified by tests/unit/physics/hertz_mindlin_test.cpp,
// tests/verification/contact and tests/reliability/same_physics.
#ifndef CALENDEM_PHYSICS_HERTZ_MINDLIN_H
#define CALENDEM_PHYSICS_HERTZ_MINDLIN_H

#include "relative_motion.h"

namespace calendem {

/// Constants of a pair of materials.
struct ContactMaterial {
  double modulus;        ///< E* [kPa]
  double shear_modulus;  ///< G* [kPa]
  double damping;        ///< beta [-], <= 0
  double friction;       ///< mu [-]
  double cohesion = 0.0; ///< energy density, sjkr_cohesion.h [kPa]
};

/// Relative motion at the contact point.
struct ContactMotion {
  double normal_velocity; ///< v_n [um/us], > 0 when parting
  Vec3 sliding_velocity;  ///< v_t [um/us]
  double arm_i, arm_j;    ///< from the centres to the contact point [um]
  Vec3 spin;              ///< of the spheres, weighted by their arms [rad/us]
};

/// The contact point lies in the middle of the spheres' overlap.
inline ContactMotion contact_motion(const PairMotion &m, double radius_i, double radius_j) {
  const double normal = dot(m.v, m.n), overlap = radius_i + radius_j - m.r;
  const double arm_i = radius_i - 0.5 * overlap, arm_j = radius_j - 0.5 * overlap;
  const Vec3 spin = (1.0 / m.r) * (arm_i * m.spin_i + arm_j * m.spin_j);
  return {normal, m.v - normal * m.n - cross(spin, m.d), arm_i, arm_j, spin};
}

/// Elastic force [nN] of a contact of radius a [um].
inline double hertz_mindlin_elastic(double modulus, double contact_radius, double overlap) {
  return 4. / 3. * modulus * contact_radius * overlap;
}

/// What a contact of radius a [um] resists motion by.
struct ContactResistance {
  double tangential_stiffness;               ///< k_t [nN/um]
  double normal_damping, tangential_damping; ///< gamma [nN us/um]
};

inline ContactResistance contact_resistance(const ContactMaterial &m, double contact_radius,
                                            double mass_eff) {
  constexpr double kSqrtFiveSixths = 0.91287092917527685576161630466800355658790782499663875;
  const double normal = 2. * m.modulus * contact_radius;
  const double tangential = 8. * m.shear_modulus * contact_radius;
  const double c = -2. * kSqrtFiveSixths * m.damping;
  return {tangential, c * std::sqrt(normal * mass_eff), c * std::sqrt(tangential * mass_eff)};
}

/// Adds a step's sliding to the tangential displacement and keeps it in the contact's plane.
inline Vec3 slide(const Vec3 &displacement, const ContactMotion &motion, const Vec3 &n, double dt) {
  const Vec3 s = displacement + dt * motion.sliding_velocity;
  return s - dot(s, n) * n;
}

/// Tangential force [nN] on i; `displacement` is shortened where the contact slips.
inline Vec3 friction_force(Vec3 &displacement, const ContactMotion &motion,
                           const ContactResistance &r, double friction, double normal_force) {
  const double spring = r.tangential_stiffness * norm(displacement);
  const double limit = friction * std::fabs(normal_force);
  const bool slips = spring > limit;
  const double ratio = limit / (slips ? spring : 1.0); // used where it slips
  const Vec3 elastic = -(r.tangential_stiffness * displacement);
  const Vec3 sliding = ratio * elastic;
  const Vec3 sticking = elastic - r.tangential_damping * motion.sliding_velocity;
  const double k = slips ? r.tangential_stiffness : 1.0;
  displacement = {slips ? -sliding.x / k : displacement.x, slips ? -sliding.y / k : displacement.y,
                  slips ? -sliding.z / k : displacement.z};
  return {slips ? sliding.x : sticking.x, slips ? sliding.y : sticking.y,
          slips ? sliding.z : sticking.z};
}

} // namespace calendem

#endif
