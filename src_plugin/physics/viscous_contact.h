// SPDX-License-Identifier: GPL-2.0-or-later
// Viscoelastic normal contact: a Hertz spring beside one Maxwell branch (Prony series of one term).
//   F = (1 - g) H(d) + g H(e)
//   H(x) = 4/3 E sqrt(R) |x|^(1/2) x
//   e = d - w
//   dw/dt = 2 e/(3 tau)
// d: overlap [um], e, w: its parts in the branch's spring and dashpot [um]; g: relaxed fraction;
// tau: relaxation time [us]; E, R: effective modulus [kPa], radius [um]; F in nN, > 0 repulsive.
// At a fixed overlap the branch's force falls as exp(-t/tau). The dashpot is linear in e: advance
// is exact over a step at constant speed. Fast contacts are Hertz, slow ones (1 - g) Hertz. On the
// way out the branch pulls (e < 0) and comes back later: the springback is delayed. It pulls no
// more than the other spring pushes,
//   e >= -c d
//   c = ((1 - g)/g)^(2/3),
// where the contact is open and its surfaces come back freely; F is never negative. w is the
// contact's memory; w >= 0, so e <= d.
// Range: 0 < g < 1, tau > 0. Stiffness: at most Hertz' at the largest overlap so far.
// Energy: elastic_energy is stored, advance returns what the dashpot takes, >= 0.
// Source: linear Maxwell branch in parallel (Christensen, Theory of Viscoelasticity, ch. 1) on
// Hertz springs. Deviations: exact viscoelastic Hertz contact (Lee and Radok, J. Appl. Mech. 27
// (1960) 438) has one creep function for force and area; here each branch is a contact of its own,
// so that energies are defined. Both agree at fast, slow and fixed overlaps, and in the tau of
// relaxation. Verified by tests/unit/physics/viscous_contact_test.cpp,
// tests/verification/viscous_contact.
#ifndef CALENDEM_PHYSICS_VISCOUS_CONTACT_H
#define CALENDEM_PHYSICS_VISCOUS_CONTACT_H

#include "contact_range.h"
#include "hertz_contact.h"
#include "law_interface.h"

namespace calendem {

class ViscousContact {
public:
  struct Params {
    double relaxed_fraction = 0.0; ///< g [-], above 0 and below 1
    double time = 0.0;             ///< tau [us], > 0
  };
  struct State {
    double dashpot = 0.0; ///< its part of the overlap, w [um]
  };
  static constexpr const char *kName = "viscoelastic", *kHeader = "viscous_contact.h";
  static constexpr LawProperty<Params> kProperties[] = {
      {&Params::relaxed_fraction, ContactProperty{"contactRelaxedFraction"}.less_than(1.0)},
      {&Params::time, {"contactRelaxationTime", "us"}}};
  static constexpr bool kStiffens = false;
  static constexpr WorkTaken kTakes = WorkTaken::Dashpots;
  static constexpr double kDeepest = std::numeric_limits<double>::infinity();
  static constexpr bool kGrows = false;
  static double range(const ContactSurfaces &) { return kHertzRange; }

  ViscousContact(const ContactSurfaces &s, const Params &p)
      : E_(s.E_eff), R_(s.R_eff), g_(p.relaxed_fraction), rate_(2.0 / (3.0 * p.time)) {}

  /// Relaxed, a contact leaves cohesion a softer one, whose overlap grows by 1/(1 - g)^2: at most
  /// 0.3 of the radius of equal spheres.
  static ContactLimits limits(const PhasePair &phases, const Params &) {
    const double overlap = sjkr_equilibrium_overlap(phases.cohesion, phases.modulus, 0.5);
    ContactLimits limits;
    limits.most = std::fmax(0.0, 1.0 - std::sqrt(overlap / 0.3));
    limits.why = "once relaxed, cohesion would pull equal spheres into each other by more than "
                 "0.3 of their radius, and the packing collapses";
    return limits;
  }

  /// Force [nN] at an overlap with the dashpot's part of it.
  double force(double overlap, const State &s) const {
    if (overlap <= 0.0)
      return 0.0;
    return std::fmax(0.0, (1.0 - g_) * hertz_force(E_, R_, overlap) +
                              g_ * spring(branch(overlap, s.dashpot)));
  }

  /// Energy [fJ] in both springs.
  double elastic_energy(double overlap, const State &s) const {
    if (overlap <= 0.0)
      return 0.0;
    return (1.0 - g_) * hertz_energy(E_, R_, overlap) + stored(branch(overlap, s.dashpot));
  }

  /// Radius [um] of the contact's area: Hertz', 0 when open.
  double contact_radius(double overlap, const State &s) const {
    const bool open = force(overlap, s) <= 0.0;
    return open ? 0.0 : std::sqrt(R_ * overlap);
  }

  double stiffness_radius(double overlap, const State &) const { return std::sqrt(R_ * overlap); }
  double radius_under(double force) const { return std::sqrt(R_ * hertz_overlap(E_, R_, force)); }

  /// Moves the dashpot while the overlap goes from `before` to `now` in `time` [us]; returns the
  /// work [fJ] that it takes.
  double advance(double before, double now, double time, State &s) const {
    const double start = branch(std::fmax(before, 0.0), s.dashpot), a = rate_ * time;
    const double moved = now - std::fmax(before, 0.0);
    const double end = start * std::exp(-a) - moved * std::expm1(-a) / a;
    const double held = std::fmax(end, lowest(now));
    double taken = 0.5 * a * g_ * (spring(start) * start + spring(end) * end);
    if (held > end) // opened: what the springs lose and do not give as work
      taken = elastic_energy(before, s) + 0.5 * force(before, s) * moved -
              elastic_energy(now, {now - held});
    s.dashpot = now - held;
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

} // namespace calendem

#endif
