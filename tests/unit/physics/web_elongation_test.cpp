// SPDX-License-Identifier: GPL-2.0-or-later
// Elongation against the gap; a spring in a growing cell against its energy.
#include "physics/web_elongation.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace calendem;

// Requirement: in proportion to the way down, none above, no more below.
TEST(WebElongation, FollowsTheGap) {
  const WebElongation web = {0.01, 60.0, 40.0};
  EXPECT_EQ(web.at(61.0), 0.0);
  EXPECT_EQ(web.at(60.0), 0.0);
  EXPECT_DOUBLE_EQ(web.at(55.0), 0.0025);
  EXPECT_EQ(web.at(40.0), 0.01);
  EXPECT_EQ(web.at(39.0), 0.01);
}

// Requirement: the velocity that a step has is the chord of its path, with motion of its own too.
TEST(WebElongation, VelocityIsTheChord) {
  const double before = 10.0, after = 10.001, dt = 1e-3, d = 1.3, own = 0.7;
  const ElongationStep step(before, after);
  const double moved = (d + own * dt) * (after / before);
  EXPECT_NEAR(own + step.gradient(dt) * moved, (moved - d) / dt, 1e-12);
  EXPECT_EQ(ElongationStep(before, before).gradient(dt), 0.0);
}

// Requirement: work is the energy of a linear spring along the web, step by step.
TEST(WebElongation, WorkOfASpring) {
  const double k = 3e8, length = 1.28, end = 0.02;
  double side = 10.0, work = 0.0;
  for (int n = 1; n <= 100; ++n) {
    const double next = 10.0 * (1.0 + end * n / 100);
    const ElongationStep step(side, next);
    const auto moment = [&](double s) {
      const double d = length * s / 10.0;
      return -k * (d - length) * d; // f_x d_x on i, pulled back
    };
    work += step.work_before(moment(side)) + step.work_after(moment(next));
    side = next;
  }
  EXPECT_NEAR(work / (0.5 * k * std::pow(end * length, 2)), 1.0, 1e-12);
}
