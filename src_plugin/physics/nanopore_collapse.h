// SPDX-License-Identifier: GPL-2.0-or-later
// Collapse of the nanopores inside a carbon-binder sphere under its mean pressure p. The solid
// stays, the envelope shrinks: (1 - phi) r^3 and the mass are constant. The nanoporosity phi_t that
// p leads to in the end:
//   phi_t = phi_0                                              for p <= p_y
//   phi_t = phi_f + (phi_0 - phi_f) exp(-(p - p_y)/H)          above
// with phi_0 the initial, phi_f the floor nanoporosity, p_y the yield pressure, H the hardening
// (the pressure scale of the fall). Where phi > phi_t it follows by dphi/dt = -(phi - phi_t)/t_r,
// exact over a step at constant p; elsewhere it stays: phi is the memory of the largest pressure
// borne, and nothing comes back. t_r smooths the collapse over some transits of a pressure wave; at
// once, it would make waves of its own, and a short wave would do the work of a lasting pressure.
// p of a sphere of radius r from its contacts (Love-Weber stress, trace/3): p = sum F_n r/(3 V),
// F_n > 0 pressing; cohesion counts as tension, so a sphere in its cohesive equilibrium has p = 0.
// Imposed instead: phi_t = phi_0 - (phi_0 - phi_f) min(1, P/P_e) for every sphere alike, P the
// largest pressure that the platen has had. That is no material law: Xu et al. report the
// values before and after and that the drop occurs under pressure.
// Range: 0 <= phi_f <= phi_0 < 1, p_y >= 0, H > 0, t_r > 0, P_e > 0. Not conservative: fix
// energy/bpm books the elastic and cohesive energy of the contacts that shrink. Source: exponential
// compaction after Heckel, Trans. Metall. Soc. AIME 221 (1961) 671, made rate dependent as Duvaut
// and Lions, Les inequations en mecanique et en physique (1972) do; from 50 % to 27 % as Xu et al.
// have it between 0 and 150 MPa. Deviations: Heckel has no floor and no yield; his K is 1/H.
// Verified by tests/unit/physics/nanopore_collapse_test.cpp, tests/verification/nanopore_collapse.
#ifndef CALENDEM_PHYSICS_NANOPORE_COLLAPSE_H
#define CALENDEM_PHYSICS_NANOPORE_COLLAPSE_H

#include "pi.h"
#include <cmath>

namespace calendem {

struct NanoporeCollapse {
  double initial = 0.5;        ///< nanoporosity phi_0, a fraction
  double floor = 0.27;         ///< phi_f
  double yield_pressure = 0.0; ///< p_y [kPa]
  double hardening = 1.0;      ///< H [kPa]
  double relaxation = 1.0;     ///< t_r [us]

  /// Nanoporosity that a pressure [kPa] leads to in the end.
  double target(double pressure) const {
    return pressure <= yield_pressure
               ? initial
               : floor + (initial - floor) * std::exp(-(pressure - yield_pressure) / hardening);
  }

  /// Imposed nanoporosity at the platen's largest pressure, which ends its fall at `until` [kPa].
  double imposed(double platen_pressure, double until) const {
    return initial - (initial - floor) * std::fmin(std::fmax(platen_pressure / until, 0.0), 1.0);
  }

  /// Nanoporosity after `time` [us] on the way to another; never above what it was.
  double follow(double nanoporosity, double leads_to, double time) const {
    const double to = std::fmin(leads_to, nanoporosity);
    return to + (nanoporosity - to) * std::exp(-time / relaxation);
  }

  /// Nanoporosity after `time` [us] at a pressure [kPa] of the sphere.
  double advance(double nanoporosity, double pressure, double time) const {
    return follow(nanoporosity, target(pressure), time);
  }

  /// Radius [um] at a nanoporosity of a sphere that had initial_radius at phi_0.
  double radius(double initial_radius, double nanoporosity) const {
    return initial_radius * std::cbrt((1.0 - initial) / (1.0 - nanoporosity));
  }
};

/// Mean pressure [kPa] of a sphere from the sum of its normal contact forces [nN].
inline double mean_pressure(double sum_of_forces, double radius) {
  return sum_of_forces / (4.0 * kPi * radius * radius);
}

} // namespace calendem

#endif
