// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/moving_average.h"
#include "physics/platen_motion.h"
#include "physics/press_instruments.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {

TEST(PressInstruments, ThatAreRightShowTheTruth) {
  const PressInstruments press;
  EXPECT_EQ(press.pressure_shown(150.3), 150.3);
  EXPECT_EQ(press.displacement_shown(12.7, 150.3), 12.7);
  EXPECT_EQ(press.thickness_shown(51.2), 51.2);
}

TEST(PressInstruments, ShowFactorStretchAndZero) {
  const PressInstruments press = {1.2, 0.02, -1.5};
  EXPECT_DOUBLE_EQ(press.pressure_shown(100.0), 120.0);
  EXPECT_DOUBLE_EQ(press.displacement_shown(10.0, 100.0), 12.0);
  EXPECT_DOUBLE_EQ(press.thickness_shown(50.0), 48.5);
}

// A film of stiffness k [kPa/um] on a machine of compliance C, set to go down by d: the film is
// compressed by x with x + C k x = d.
TEST(PlatenOfASoftMachine, StopsWhereItsDisplacementIsShown) {
  PlatenProgramme p;
  p.control = PlatenControl::Position;
  p.start = 50.0;
  p.target = 40.0;
  p.load_speed = p.touch_speed = p.release_speed = 1.0;
  p.compliance = 2e-4;
  const double k = 5000.0, dt = 1e-4;
  PlatenState s;
  s.position = p.start;
  enter(s, PlatenStage::Compression, 0.0);
  for (int n = 0; n < 200000 && stage_of(s) == PlatenStage::Compression; ++n)
    advance(p, s, k * (p.start - s.position), 0.0, n * dt, dt, false);
  EXPECT_EQ(s.reached, 1.0);
  EXPECT_NEAR(p.start - s.position, 10.0 / (1.0 + p.compliance * k), 2.0 * dt); // two steps' way
}

// Requirement: it does so by the pressure at the platen's position, though the averaged one is of
// half a window ago: the film is compressed as set, within one block of the average.
TEST(PlatenOfASoftMachine, KnowsThatItsPressureLags) {
  PlatenProgramme p;
  p.control = PlatenControl::Position;
  p.start = 50.0;
  p.target = 40.0;
  p.load_speed = p.touch_speed = p.release_speed = 1.0;
  p.compliance = 2e-4;
  const double k = 5000.0, dt = 1e-4, window = 0.32;
  PlatenState s;
  s.position = p.start;
  MovingAverage average;
  average.set_window(window / dt);
  enter(s, PlatenStage::Compression, 0.0);
  for (int n = 0; n < 200000 && stage_of(s) == PlatenStage::Compression; ++n) {
    advance(p, s, average.value(), window, n * dt, dt, false);
    if (average.add(k * (p.start - s.position)))
      update_slope(p, s, average.value(), average.block_length * dt);
  }
  EXPECT_EQ(s.reached, 1.0);
  EXPECT_NEAR(p.start - s.position, 10.0 / (1.0 + p.compliance * k),
              window / MovingAverage::kBlocks * p.load_speed);
}

} // namespace
