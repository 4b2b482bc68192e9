// SPDX-License-Identifier: GPL-2.0-or-later
// Normal contact at large overlap: Hertz, and beside it the bulk stiffness of a sphere that its
// contacts enclose.
//   F = 4/3 E sqrt(R) d^(3/2) + B
//   B = 3 pi/4 z K R_s^2 x^2 (x - x_b)  for x > x_b, otherwise 0
//   x = R d/R_s^2                       area of the contact over the section of the smaller sphere
//   x_b = 4 (1 - psi)/z                 where the bulk begins to answer
// d: overlap [um]; the contact's area is Hertz', pi R d;
// E, R: effective modulus [kPa], radius [um]; R_s: radius of the smaller sphere [um]; K > 0: bulk
// modulus [kPa]; psi: share of the sphere's surface that is free when the bulk begins to answer,
// 0 < psi < 1; z = 12 contacts enclose a sphere. F in nN, > 0 repulsive.
//
// Below x_b exactly Hertz (x_b = 1/6 with psi = 0.5); at x_b the slope rises by
// 3 pi/4 z K R x_b^2. B is the pressure K z A d_b/V of a sphere of volume V whose z areas
// A = pi R_s^2 x move in by d_b = R_s (x - x_b), times A.
// Range: x up to 4/z, where z such areas cover the sphere; beyond, extrapolated.
// Energy: conservative, elastic_energy is the integral of F.
// Source: Zunker and Kamrin, J. Mech. Phys. Solids 183 (2024) 105493, part II of the mechanically
// derived model (MDR): bulk elastic response, there F_BULK = kappa A_c A_con d_BULK/V below a free
// share psi_b = 0.5, as LAMMPS' `normal mdr` has it. Deviations: theirs knows area and mean
// displacement of all contacts of a sphere, here all z are like this one; Hertz for their
// elastic-plastic part; the smaller sphere for the mean of both sides; radii do not grow; damping
// and tangential stiffness stay those of Hertz' area. Verified by
// tests/unit/physics/confined_contact_test.cpp, tests/verification/confined_contact.
#ifndef CALENDEM_PHYSICS_CONFINED_CONTACT_H
#define CALENDEM_PHYSICS_CONFINED_CONTACT_H

#include "hertz_contact.h"
#include "law_interface.h"
#include "pi.h"

namespace calendem {

class ConfinedContact {
public:
  static constexpr double kContacts = 12.0; ///< z
  struct Params {
    double bulk_modulus = 0.0; ///< K [kPa], > 0
    double free_surface = 0.0; ///< psi [-], above 0 and below 1
  };
  struct State {};
  static constexpr const char *kName = "confined", *kHeader = "confined_contact.h";
  static constexpr LawProperty<Params> kProperties[] = {
      {&Params::bulk_modulus, {"contactBulkModulus", "kPa"}},
      {&Params::free_surface, ContactProperty{"contactFreeSurface"}.less_than(1.0)}};
  static constexpr bool kStiffens = true;
  static constexpr WorkTaken kTakes = WorkTaken::Nothing;
  static constexpr double kDeepest = std::numeric_limits<double>::infinity();
  static constexpr bool kGrows = false;
  static double range(const ContactSurfaces &s) { return strain_at(4.0 / kContacts, s); }

  ConfinedContact(const ContactSurfaces &s, const Params &p)
      : E_(s.E_eff), R_(s.R_eff), per_overlap_(s.R_eff / (s.radius * s.radius)),
        begin_(4.0 * (1.0 - p.free_surface) / kContacts),
        bulk_(0.75 * kPi * kContacts * p.bulk_modulus * s.radius * s.radius) {}

  /// Any bulk modulus: contacts only become stiffer.
  static ContactLimits limits(const PhasePair &, const Params &) { return {}; }

  /// Overlap [um] from which on it is stiffer than Hertz.
  double begin() const { return begin_ / per_overlap_; }

  double force(double overlap, State = {}) const {
    const double x = per_overlap_ * overlap, beyond = std::fmax(x - begin_, 0.0);
    return hertz_force(E_, R_, overlap) + bulk_ * x * x * beyond;
  }

  double elastic_energy(double overlap, State = {}) const {
    const double x = per_overlap_ * overlap, y = std::fmax(x - begin_, 0.0), b = begin_;
    const double integral = y * y * (0.25 * y * y + 2.0 / 3.0 * b * y + 0.5 * b * b);
    return hertz_energy(E_, R_, overlap) + bulk_ * integral / per_overlap_;
  }

  double contact_radius(double overlap, State = {}) const {
    return std::sqrt(R_ * std::fmax(overlap, 0.0));
  }

  double stiffness(double overlap) const { ///< tangent, dF/dd [nN/um]
    const double x = per_overlap_ * overlap;
    const double of_bulk = x > begin_ ? bulk_ * per_overlap_ * x * (3.0 * x - 2.0 * begin_) : 0.0;
    return hertz_stiffness(E_, R_, overlap) + of_bulk;
  }

  double stiffness_radius(double overlap, State = {}) const {
    return stiffness(overlap) / (2.0 * E_);
  }

  /// The force is convex: Newton comes down to the overlap from that of Hertz.
  double radius_under(double force_) const {
    double d = hertz_overlap(E_, R_, force_);
    for (int k = 0; k < 60 && d > 0.0; ++k)
      d -= std::fmax(0.0, force(d) - force_) / stiffness(d);
    return stiffness_radius(d);
  }

  double advance(double, double, double, State) const { return 0.0; }

private:
  double E_, R_, per_overlap_, begin_, bulk_; // x = per_overlap d; x_b
};

} // namespace calendem

#endif
