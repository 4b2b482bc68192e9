// SPDX-License-Identifier: GPL-2.0-or-later
// Elongation of the web in a nip: the collector yields along the web, and the film with it.
//   elongation   e = e_end (h_0 - h_low) / (h_0 - h_end), h_low the smallest gap so far
//   motion       x -> x + (x - x_0) dL / L for all particles, when the cell's side grows by dL
//   velocities   are beside that motion; two particles at d = x_i - x_j approach by v + g d_x,
//                g = (dL / L_end) / dt, so that a step's velocity is the chord of its path
//   work         W = -sum over pairs of f_x d_x dL / L, f the force on i, half at the beginning and
//                half at the end of the step: kinetic and stored energy grow by it, less what is
//                dissipated at the relative velocity
// Nothing changes across the periodic side, and both walls stretch as the cell does.
// Range: e up to 5 %. Signs: e > 0 longer. The foil does not spring back, and keeps its width.
// Energy: exact for a step without other motion; beside it the error is second order in dt.
// Source: Mayer et al. 2021, doi:10.3390/pr9112009: the elongation of NMC electrodes depends on how
// far they are compacted, along the web clearly and across it hardly. Their measure is the end;
// that e follows the gap in proportion is an assumption.
// Contacts that see the mean velocity gradient of a periodic cell: Radjai & Voivret, in Discrete-
// element Modeling of Granular Materials (2011), ch. 7.
// Deviations: the inertia of the mean motion is left out, rho (de/dt L)^2 of pressure, 1e-3 MPa
// for 1 % in 1 us over 50 um; so is the slip that an elongating web has against the roll.
// Verified by tests/unit/physics/web_elongation_test.cpp and tests/verification/elongation.
#ifndef CALENDEM_PHYSICS_WEB_ELONGATION_H
#define CALENDEM_PHYSICS_WEB_ELONGATION_H

namespace calendem {

struct WebElongation {
  double at_end = 0.0; ///< when the gap has been `gap` [-]
  double start = 0.0;  ///< height at which it begins [um]
  double gap = 0.0;    ///< of the last nip [um], below `start`

  /// Elongation [-] at the height h [um] on the first way down.
  double at(double h) const {
    const double part = (start - h) / (start - gap);
    return at_end * (part < 0.0 ? 0.0 : (part > 1.0 ? 1.0 : part));
  }
};

/// One step of a cell whose side grows from `before` to `after` [um].
struct ElongationStep {
  double of_before = 0.0; ///< growth over the side before
  double of_after = 0.0;  ///< growth over the side after

  ElongationStep() = default;
  ElongationStep(double before, double after)
      : of_before((after - before) / before), of_after((after - before) / after) {}

  /// Velocity gradient g [1/us] at the end of a step of dt [us].
  double gradient(double dt) const { return of_after / dt; }
  /// Work [fJ] of the halves of the step; `moment`: sum over pairs of f_x d_x [fJ] there.
  double work_before(double moment) const { return -0.5 * of_before * moment; }
  double work_after(double moment) const { return -0.5 * of_after * moment; }
};

} // namespace calendem

#endif
