// SPDX-License-Identifier: GPL-2.0-or-later
// A contact of two spheres, or of a sphere and a flat wall, at one instant: the only place where
// kinematics, Hertz' area, resistance and friction of hertz_mindlin.h meet, with the arms of their
// moments. The pair loop takes all of it from here; the host's contact models take kinematics,
// elastic force and resistance, the energy ledger the wall's contact.
//   a = sqrt(R* d),  1/R* = 1/R_i + 1/R_j
//   moment on i: -(R_i - d_g/2) n x F_t,  d_g = R_i + R_j - r
// d: overlap that acts, d_g: that of the spheres [um]; the contact point lies in the middle of d_g.
// Signs, energy, range, source: as in hertz_mindlin.h. Verified by
// tests/unit/physics/contact_pair_test.cpp and tests/reliability/same_physics.
#ifndef CALENDEM_PHYSICS_CONTACT_PAIR_H
#define CALENDEM_PHYSICS_CONTACT_PAIR_H

#include "acting_contact.h"
#include "hertz_contact.h"
#include "hertz_mindlin.h"

namespace calendem {

/// Radius [um] of the area in which two spheres touch by Hertz' law.
inline double hertz_contact_radius(double R_eff, double overlap) {
  return std::sqrt(R_eff * overlap);
}

/// Two spheres whose contact acts, rests (no overlap that acts), or has been opened by its law.
struct ContactPair {
  Vec3 n;   ///< from j to i
  double r; ///< distance of the centres [um]
  ContactMotion motion;

  /// At rest it does not move, open it does not slide: friction must not wind up meanwhile.
  ContactPair(const PairMotion &m, double radius_i, double radius_j, bool rests, bool slides)
      : n(m.n), r(m.r), motion(contact_motion(m, radius_i, radius_j)) {
    motion.normal_velocity = rests ? 0.0 : motion.normal_velocity;
    motion.sliding_velocity = select(slides, motion.sliding_velocity);
  }
};

/// What a contact exerts: force and torque on i; the opposite force and torque_j on j.
struct ContactAction {
  double normal;  ///< F_n, damping included [nN]
  double damping; ///< its part of it
  Vec3 friction;  ///< F_t [nN]
  Vec3 torque_i, torque_j;
};

/// @param elastic F_n without damping [nN] @param displacement tangential [um]; shortened where the
/// contact slips @param acts false: no friction
inline ContactAction contact_action(const ContactPair &pair, const ContactMaterial &m,
                                    const ContactResistance &r, double elastic, bool acts,
                                    Vec3 &displacement) {
  const double damping = -r.normal_damping * pair.motion.normal_velocity;
  const double normal = damping + elastic;
  ContactAction a = {normal,
                     damping,
                     select(acts, friction_force(displacement, pair.motion, r, m.friction, normal)),
                     {},
                     {}};
  const Vec3 moment = cross(pair.n, a.friction);
  a.torque_i = -pair.motion.arm_i * moment;
  a.torque_j = -pair.motion.arm_j * moment;
  return a;
}

/// A sphere at a flat wall at right angles to z.
struct WallContact {
  double distance; ///< from the centre to the wall [um]
  double overlap;  ///< [um], < 0 without contact
  double side;     ///< 1 above the wall, -1 below: where the wall pushes the sphere
  Vec3 arm;        ///< from the centre to the contact point [um]

  /// @param height of the centre above the wall [um], < 0 below it
  WallContact(double height, double radius)
      : distance(std::fabs(height)), overlap(radius - distance),
        side(height > 0.0 ? 1.0 : -1.0), arm{0.0, 0.0, -side * (radius - 0.5 * overlap)} {}
};

} // namespace calendem

#endif
