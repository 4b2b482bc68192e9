// SPDX-License-Identifier: GPL-2.0-or-later
// The nip's geometry against circles, and the programme of a roll's passage against its parabola.
#include "physics/platen_motion.h"

#include <vector>

#include <gtest/gtest.h>

using namespace calendem;

namespace {

const RollNip kRolls = {2e5, 1e5, 0.01}; // um: rolls of 200 and 100 mm
constexpr double kStart = 60.0, kGap = 40.0, kSpeed = 1.0, kDt = 2e-4;

PlatenProgramme programme(double passes = 1.0, double first_gap = 0.0) {
  PlatenProgramme p;
  p.control = PlatenControl::Roll;
  p.roll = kRolls;
  p.start = kStart;
  p.target = kGap;
  p.load_speed = p.touch_speed = p.release_speed = kSpeed;
  p.lowest = 30.0;
  p.passes = passes;
  p.first_target = first_gap;
  return p;
}

struct Passage {
  PlatenProgramme p;
  PlatenState s;
  double time = 0.0;

  explicit Passage(const PlatenProgramme &programme) : p(programme) {
    s.position = p.start;
    enter(s, PlatenStage::Compression, 0.0);
  }
  /// `lost_at`: height of the platen at which the film lets go.
  void step(double lost_at = 1e9, bool may_release = true) {
    time += kDt;
    const double pressure = s.position < lost_at ? 1e4 : 0.0;
    advance(p, s, pressure, 0.25, time, kDt, may_release);
  }
};

} // namespace

// Requirement: the gap is that of two circles within its stated error.
TEST(RollNip, ParabolaOfTwoCircles) {
  for (const double s : {100.0, 1000.0, 3000.0}) {
    const double a = kRolls.radius - std::sqrt(kRolls.radius * kRolls.radius - s * s),
                 b = kRolls.counter - std::sqrt(kRolls.counter * kRolls.counter - s * s);
    const double bound = std::pow(s / kRolls.counter, 2) / 4.0;
    EXPECT_NEAR(kRolls.above(s) / (a + b), 1.0, 1.01 * bound);
    EXPECT_NEAR(kRolls.distance(kRolls.above(s)), s, 1e-12 * s);
  }
  EXPECT_EQ(RollNip({2e5, 0.0, 0.0}).curvature(), 1.0 / 2e5);
}

// Requirement: the gap closes as fast as asked for, by the derivative of the gap.
TEST(RollNip, WebSpeedGivesTheClosingSpeed) {
  const double above = 20.0, u = kRolls.web_speed(1.5, above), s = -kRolls.distance(above);
  const double dt = 1e-6;
  const double closing = (kRolls.above(s - u * dt) - kRolls.above(s + u * dt)) / (2.0 * dt);
  EXPECT_NEAR(closing, 1.5, 1e-6);
  const RollNip slips = {2e5, 1e5, 0.1}; // faster than the gap closes
  EXPECT_DOUBLE_EQ(slips.slip_speed(slips.web_speed(1.5, above), s), 1.5);
}

// Requirement: equal rolls without slip do not shear; on a flat table the roll is behind by its
// cosine, and slip is that share of the web's speed in the nip.
TEST(RollNip, SlipOfTheSurface) {
  EXPECT_EQ(RollNip({2e5, 2e5, 0.0}).slip_speed(40.0, 2000.0), 0.0);
  const double angle = std::asin(2000.0 / 2e5);
  EXPECT_NEAR(RollNip({2e5, 0.0, 0.0}).slip_speed(40.0, 2000.0), 40.0 * (std::cos(angle) - 1.0),
              40.0 * std::pow(angle, 4) / 8.0);
  EXPECT_DOUBLE_EQ(kRolls.slip_speed(40.0, 0.0), 0.4);
}

// Requirement: h(t) = h_min + (u t)^2 / 2R on both ways, the largest closing speed at the start, in
// the nip exactly the gap.
TEST(RollPassage, FollowsTheParabola) {
  Passage cell(programme());
  const double way = kRolls.distance(kStart - kGap), u = kRolls.web_speed(kSpeed, kStart - kGap);
  double lowest = kStart, fastest = 0.0;
  while (stage_of(cell.s) == PlatenStage::Compression) {
    cell.step();
    const double expected = kGap + kRolls.above(std::fmin(u * cell.time - way, 0.0));
    ASSERT_NEAR(cell.s.position, expected, 1e-9);
    lowest = std::fmin(lowest, cell.s.position);
    fastest = std::fmax(fastest, cell.s.speed);
  }
  EXPECT_EQ(lowest, kGap);
  EXPECT_EQ(cell.s.reached, 1.0);
  EXPECT_LE(fastest, kSpeed);
  EXPECT_GT(fastest, kSpeed * (1.0 - u * kDt / way));
  cell.step(); // over the dwell
  const double nip = cell.time;
  while (stage_of(cell.s) == PlatenStage::Relaxation) {
    cell.step();
    const double expected = kGap + kRolls.above(u * (cell.time - nip));
    ASSERT_NEAR(cell.s.position, expected, 1e-9);
  }
  EXPECT_EQ(stage_of(cell.s), PlatenStage::Done);
  EXPECT_NEAR(cell.s.position, kStart, kSpeed * kDt * 1.01);
}

// Requirement: from rest the web takes the ramp, and stays on the parabola: the slope of the path
// is that of where the cell is.
TEST(RollPassage, StartsSmoothly) {
  PlatenProgramme p = programme();
  p.ramp_time = 0.5;
  Passage cell(p);
  const double u = kRolls.web_speed(kSpeed, kStart - kGap);
  double before = 0.0;
  while (stage_of(cell.s) == PlatenStage::Compression) {
    cell.step();
    ASSERT_LE(cell.s.web_speed - before, 1.5 * u / 0.5 * kDt * (1.0 + 1e-12));
    before = cell.s.web_speed;
  }
  EXPECT_EQ(before, u);
}

// Requirement: several passes, their gaps in equal steps; the next one begins where contact was
// lost; a script that ends after compression stops the roll in the last nip only.
TEST(RollPassage, SeveralPasses) {
  Passage cell(programme(3.0, 50.0));
  const double lost_at = 55.0;
  std::vector<double> gaps, begins;
  PlatenStage before = PlatenStage::Hold;
  for (int n = 0; n < 2000000 && stage_of(cell.s) != PlatenStage::Done; ++n) {
    const bool held = stage_of(cell.s) == PlatenStage::Dwell && last_pass(cell.p, cell.s);
    cell.step(lost_at, held && gaps.size() == 3);
    const PlatenStage now = stage_of(cell.s);
    if (now == PlatenStage::Dwell && before != now)
      gaps.push_back(cell.s.position);
    if (now == PlatenStage::Compression && before == PlatenStage::Relaxation)
      begins.push_back(cell.s.position);
    before = now;
  }
  EXPECT_EQ(gaps, (std::vector<double>{50.0, 45.0, 40.0}));
  ASSERT_EQ(begins.size(), 2u);
  for (const double begin : begins)
    EXPECT_NEAR(begin, lost_at, 2.0 * kSpeed * kDt);
  EXPECT_EQ(stage_of(cell.s), PlatenStage::Done);
}

// Requirement: while the roll is held in the nip it does not slip.
TEST(RollPassage, HeldRollDoesNotSlip) {
  Passage cell(programme());
  cell.step();
  EXPECT_GT(slip_speed(cell.p, cell.s), 0.0);
  while (stage_of(cell.s) == PlatenStage::Compression)
    cell.step();
  for (int n = 0; n < 100; ++n)
    cell.step(1e9, false);
  EXPECT_EQ(stage_of(cell.s), PlatenStage::Dwell);
  EXPECT_EQ(slip_speed(cell.p, cell.s), 0.0);
  EXPECT_EQ(cell.s.position, kGap);
}

// Requirement: a gap below the lowest position ends there and says so.
TEST(RollPassage, LowestPositionStops) {
  PlatenProgramme p = programme();
  p.lowest = 45.0;
  Passage cell(p);
  while (stage_of(cell.s) == PlatenStage::Compression)
    cell.step();
  EXPECT_EQ(cell.s.reached, 0.0);
  EXPECT_NEAR(cell.s.position, 45.0, kSpeed * kDt);
}
