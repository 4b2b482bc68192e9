// SPDX-License-Identifier: GPL-2.0-or-later
// The nip of a calender as a cell of the web sees it, at s along the web from the nip.
//   gap                 h(s) = h_min + s^2 / (2 R),  1/R = 1/R_roll + 1/R_counter
//   closing speed       -dh/dt = -s u / R            at the web's speed u = ds/dt
//   slip of the rolls   v = u [(1 + slip) (1 - s^2 / 2 R_roll^2) - (1 - s^2 / 2 R_counter^2)]
//   line load           q = int P ds
// Range: circles as parabolas, |s| << R; the gap is wrong by s^2 / (4 R^2) of s^2 / (2 R), 1e-4 for
// a film that loses 40 um under rolls of 200 mm. The film keeps the web's speed, also where it is
// thinner; its elongation is in web_elongation.h. Signs: s < 0 on the way in, u > 0, v > 0 along x where the roll
// runs ahead of what the collector lies on. A counter radius of 0 is a flat table, which does not
// slip. Energy: none; the roll's work is force times its motion. Source: the parabolic gap of two
// cylinders, Johnson, Contact Mechanics (1985), section 4.1; cosines by their first terms.
// Deviations: none. Verified by tests/unit/physics/roll_nip_test.cpp and tests/verification/roll.
#ifndef CALENDEM_PHYSICS_ROLL_NIP_H
#define CALENDEM_PHYSICS_ROLL_NIP_H

#include <cmath>

namespace calendem {

struct RollNip {
  double radius = 0.0;  ///< of the roll on the film [um], > 0
  double counter = 0.0; ///< of the roll behind the collector [um]; 0: flat
  double slip = 0.0;    ///< surface speed of the roll over that of the web, less 1 [-]

  double curvature() const { return 1.0 / radius + (counter > 0.0 ? 1.0 / counter : 0.0); }

  /// How far the gap is above the smallest one at s.
  double above(double s) const { return 0.5 * s * s * curvature(); }

  /// |s| at which the gap is `above` its smallest.
  double distance(double above) const {
    return above > 0.0 ? std::sqrt(2.0 * above / curvature()) : 0.0;
  }

  /// Speed of the roll's surface along the web, as seen from the roll behind the collector.
  double slip_speed(double web_speed, double s) const {
    const double turn = 0.5 * s * s / (radius * radius);
    const double counter_turn = counter > 0.0 ? 0.5 * s * s / (counter * counter) : 0.0;
    return web_speed * (slip - (1.0 + slip) * turn + counter_turn);
  }

  /// Web's speed at which neither closing nor slip is faster than `most` from where the gap is
  /// `above` its smallest on; slip is fastest there or in the nip.
  double web_speed(double most, double above) const {
    const double s = distance(above), closing = s * curvature();
    const double slipping = std::fmax(std::fabs(slip_speed(1.0, s)), std::fabs(slip));
    return most / std::fmax(closing, slipping);
  }
};

} // namespace calendem

#endif
