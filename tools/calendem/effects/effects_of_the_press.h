// SPDX-License-Identifier: GPL-2.0-or-later
// What the press's instruments show that is not so: a function returns a row.
#ifndef CALENDEM_EFFECTS_EFFECTS_OF_THE_PRESS_H
#define CALENDEM_EFFECTS_EFFECTS_OF_THE_PRESS_H

#include "effects/effect.h"

namespace calendem {

inline Effect machine_compliance() {
  Effect e = effect("machine_compliance", "boundary",
                    "frame and rolls deflect in proportion to the pressure");
  e.settings = {number("effects.machine_compliance.um_per_MPa", "compliance_um_MPa", "0", 0, 1,
                       "um/MPa",
                       "deflection of frame and rolls, included in the displacement shown")};
  e.parameter = strength(e.settings[0]).log_uniform(0.005, 0.2);
  e.shown = &PressInstruments::compliance;
  e.instrument = true;
  e.moves = "the displacement shown grows with pressure, in compression and release; the thickness "
            "after relaxation does not change";
  e.source = "Oliver & Pharr 1992: frame and sample as springs in series; an unsourced prior";
  e.law = "press_instruments.h";
  e.verification = "platen";
  return e;
}

inline Effect pressure_calibration() {
  Effect e = effect("pressure_calibration", "measurement",
                    "the pressure shown is the true pressure times a factor");
  e.settings = {number("effects.pressure_calibration.factor", "pressure_factor", "1", 0.2, 5, "",
                       "pressure shown divided by true pressure")};
  e.parameter = strength(e.settings[0]).log_uniform(0.6, 1.6).in_logarithm();
  e.shown = &PressInstruments::pressure_factor;
  e.moves = "scales the pressure axis of every curve, and nothing else";
  e.source = "pressures converted from a roll gap: 10-25 % systematic is plausible; unsourced, "
             "widened here";
  e.law = "press_instruments.h";
  e.verification = "unit/physics";
  return e;
}

inline Effect thickness_zero() {
  Effect e = effect("thickness_zero", "measurement", "the thickness shown has a constant error");
  e.settings = {number("effects.thickness_zero.offset_um", "", "0", -50, 50, "um",
                       "added to the thickness shown")};
  e.parameter = strength(e.settings[0]).uniform(-6, 6);
  e.shown = &PressInstruments::thickness_zero;
  e.instrument = true;
  e.moves = "shifts every thickness, and the porosity derived from it, by the same amount at any "
            "pressure";
  e.source = "micrometre zero, foil thickness; table 1 states 0.8 um between samples";
  e.law = "press_instruments.h";
  e.verification = "unit/physics";
  return e;
}

inline std::vector<Effect> effects_of_the_press() {
  return {machine_compliance(), pressure_calibration(), thickness_zero()};
}

} // namespace calendem

#endif
