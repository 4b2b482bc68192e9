// SPDX-License-Identifier: GPL-2.0-or-later
// What a press shows of what its platen does to the film.
//   pressure shown     = factor * P              (a gauge, or a roll gap turned into pressure)
//   displacement shown = d + C P                 (frame and rolls give way by C per pressure)
//   thickness shown    = h + zero                (micrometre's zero, foil thickness subtracted)
// Signs: displacement grows downwards, P > 0 in compression. Range: factor > 0, C >= 0, any zero.
// factor 1, C 0, zero 0 show the truth exactly. A machine that stops at a set position stops by
// the displacement it shows. Energy: the frame's is elastic, C A P^2 / 2, and outside the film's
// ledger. Source: linear machine compliance, as in indentation (Oliver & Pharr 1992). Deviations:
// the frame's stretch does not change the platen's speed (irrelevant in a quasi-static run) and
// does not grow in a dwell. Verified by tests/unit/physics/press_instruments_test.cpp and
// tests/verification/platen.
#ifndef CALENDEM_PHYSICS_PRESS_INSTRUMENTS_H
#define CALENDEM_PHYSICS_PRESS_INSTRUMENTS_H

namespace calendem {

/// Lengths and pressures in any one unit each, compliance in their ratio.
struct PressInstruments {
  double pressure_factor = 1.0;
  double compliance = 0.0; ///< length per pressure
  double thickness_zero = 0.0;

  double pressure_shown(double pressure) const { return pressure_factor * pressure; }
  double displacement_shown(double displacement, double pressure) const {
    return displacement + compliance * pressure;
  }
  double thickness_shown(double thickness) const { return thickness + thickness_zero; }
};

} // namespace calendem

#endif
