// SPDX-License-Identifier: GPL-2.0-or-later
// Hertz contact: what the host's `model hertz` computes, for estimates and checks outside the host.
//   F = 4/3 E* sqrt(R*) delta^(3/2),  1/R* = 1/R_i + 1/R_j,  1/E* = (1-nu_i^2)/E_i + (1-nu_j^2)/E_j
// delta >= 0 is the overlap [um]; F in nN. Conservative. Source: Johnson, Contact Mechanics, ch. 4.
// Deviations: none. Verified by tests/unit/physics/hertz_contact_test.cpp,
// tests/verification/contact.
#ifndef CALENDEM_PHYSICS_HERTZ_CONTACT_H
#define CALENDEM_PHYSICS_HERTZ_CONTACT_H

#include "pi.h"
#include <cmath>

namespace calendem {

inline double effective_modulus(double E_i, double nu_i, double E_j, double nu_j) {
  return 1.0 / ((1.0 - nu_i * nu_i) / E_i + (1.0 - nu_j * nu_j) / E_j);
}

inline double effective_radius(double R_i, double R_j) { return R_i * R_j / (R_i + R_j); }

inline double hertz_force(double E_eff, double R_eff, double overlap) {
  return overlap > 0.0 ? 4.0 / 3.0 * E_eff * std::sqrt(R_eff * overlap) * overlap : 0.0;
}

/// Overlap [um] at which the force is `force` [nN] >= 0.
inline double hertz_overlap(double E_eff, double R_eff, double force) {
  return std::pow(0.75 * force / (E_eff * std::sqrt(R_eff)), 2.0 / 3.0);
}

/// Tangent stiffness dF/d(delta) [nN/um].
inline double hertz_stiffness(double E_eff, double R_eff, double overlap) {
  return overlap > 0.0 ? 2.0 * E_eff * std::sqrt(R_eff * overlap) : 0.0;
}

/// Energy [fJ] stored in the contact: the integral of the force, 8/15 E* sqrt(R*) delta^(5/2).
inline double hertz_energy(double E_eff, double R_eff, double overlap) {
  return 0.4 * overlap * hertz_force(E_eff, R_eff, overlap);
}

/// Overlap at which Hertz repulsion balances SJKR attraction (lens area ~ 2 pi R* delta):
/// delta = R* (3 pi CED / (2 E*))^2, so it grows with (CED/E)^2.
inline double sjkr_equilibrium_overlap(double cohesion_energy_density, double E_eff, double R_eff) {
  const double q = 1.5 * kPi * cohesion_energy_density / E_eff;
  return R_eff * q * q;
}

} // namespace calendem

#endif
