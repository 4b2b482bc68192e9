// SPDX-License-Identifier: GPL-2.0-or-later
// Viscoelastic normal contact: a Hertz spring beside one Maxwell branch (Prony series of one term).
//   F = (1 - g) H(d) + g H(e),  H(x) = 4/3 E sqrt(R) |x|^(1/2) x,  e = d - w
// d: overlap [um], e, w: its parts in the branch's spring and dashpot [um]; g: relaxed fraction; E,
// R: effective modulus [kPa], radius [um]; F in nN, > 0 repulsive. The dashpot follows
//   dw/dt = 2 e/(3 tau),  so that at a fixed overlap the branch's force falls as exp(-t/tau),
// which is linear in e: advance is exact over a step at constant speed. Fast contacts are Hertz,
// slow ones (1 - g) Hertz. On the way out the branch pulls (e < 0) and comes back later: the
// springback is delayed. It pulls no more than the other spring pushes: e >= -c d, c = ((1 -
// g)/g)^(2/3), where the contact is open and its surfaces come back freely; F is never negative. w
// is the contact's memory; w >= 0, so e <= d. Range: 0 < g < 1, tau > 0. Stiffness: at most Hertz'
// at the largest overlap so far. Energy: elastic_energy is stored, advance returns what the dashpot
// takes, >= 0. Source: linear Maxwell branch in parallel (Christensen, Theory of Viscoelasticity,
// ch. 1) on Hertz springs. Deviations: exact viscoelastic Hertz contact (Lee and Radok, J. Appl.
// Mech. 27 (1960) 438) has one creep function for force and area; here each branch is a contact of
// its own, so that energies are defined. Both agree at fast, slow and fixed overlaps, and in the
// tau of relaxation. Verified by tests/unit/physics/viscous_contact_test.cpp,
// tests/verification/viscous_contact.
#ifndef CALENDEM_PHYSICS_VISCOUS_CONTACT_H
#define CALENDEM_PHYSICS_VISCOUS_CONTACT_H

#include "hertz_contact.h"
#include "law_interface.h"
#include "law_limits.h"

namespace calendem {

class ViscousContact {
public:
  static constexpr int kMemory = 1; ///< dashpot's part of the overlap [um]

  /// Effective modulus [kPa], effective radius [um], relaxed fraction, relaxation time [us].
  ViscousContact(double E_eff, double R_eff, double relaxed_fraction, double time)
      : E_(E_eff), R_(R_eff), g_(relaxed_fraction), rate_(2.0 / (3.0 * time)) {}
  ViscousContact(const ContactSurfaces &s, const double *values)
      : ViscousContact(s.E_eff, s.R_eff, values[0], values[1]) {}

  /// Force [nN] at an overlap with the dashpot's part of it.
  double force(double overlap, double dashpot) const {
    if (overlap <= 0.0)
      return 0.0;
    return std::fmax(0.0, (1.0 - g_) * hertz_force(E_, R_, overlap) +
                              g_ * spring(branch(overlap, dashpot)));
  }

  /// Energy [fJ] in both springs.
  double elastic_energy(double overlap, double dashpot) const {
    if (overlap <= 0.0)
      return 0.0;
    return (1.0 - g_) * hertz_energy(E_, R_, overlap) + stored(branch(overlap, dashpot));
  }

  /// Radius [um] of the contact's area: Hertz', 0 when open.
  double contact_radius(double overlap, double dashpot) const {
    const bool open = force(overlap, dashpot) <= 0.0;
    return open ? 0.0 : std::sqrt(R_ * overlap);
  }

  double stiffness_radius(double overlap, double) const { return std::sqrt(R_ * overlap); }
  double radius_under(double force) const { return std::sqrt(R_ * hertz_overlap(E_, R_, force)); }

  /// Moves the dashpot while the overlap goes from `before` to `now` in `time` [us]; returns the
  /// work [fJ] that it takes.
  double advance(double before, double now, double time, double &dashpot) const {
    const double start = branch(std::fmax(before, 0.0), dashpot), a = rate_ * time;
    const double moved = now - std::fmax(before, 0.0);
    const double end = start * std::exp(-a) - moved * std::expm1(-a) / a;
    const double held = std::fmax(end, lowest(now));
    double taken = 0.5 * a * g_ * (spring(start) * start + spring(end) * end);
    if (held > end) // opened: what the springs lose and do not give as work
      taken = elastic_energy(before, dashpot) + 0.5 * force(before, dashpot) * moved -
              elastic_energy(now, now - held);
    dashpot = now - held;
    return taken;
  }

private:
  double E_, R_, g_, rate_;

  double spring(double x) const {
    return x < 0.0 ? -hertz_force(E_, R_, -x) : hertz_force(E_, R_, x);
  }
  double stored(double x) const { return g_ * hertz_energy(E_, R_, std::fabs(x)); }
  double lowest(double overlap) const { // -c d of the head comment
    return -std::pow((1.0 - g_) / g_, 2.0 / 3.0) * std::fmax(overlap, 0.0);
  }
  double branch(double overlap, double dashpot) const {
    return std::fmax(overlap - dashpot, lowest(overlap));
  }
};

/// Of the relaxed fraction: it leaves cohesion a softer contact, whose overlap grows by 1/(1 -
/// g)^2; at most 0.3 of the radius of equal spheres.
inline ContactLimits viscous_contact_limits(const PhasePair &phases, const double *) {
  const double overlap = sjkr_equilibrium_overlap(phases.cohesion, phases.modulus, 0.5);
  ContactLimits limits;
  limits.most = std::fmax(0.0, 1.0 - std::sqrt(overlap / 0.3));
  limits.why =
      "once relaxed, cohesion would pull equal spheres into each other by more than 0.3 of "
      "their radius, and the packing collapses";
  return limits;
}

} // namespace calendem

#endif
