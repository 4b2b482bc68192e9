// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/moving_average.h"

#include <gtest/gtest.h>

using calendem::MovingAverage;

// Requirement: the block is a whole number of samples, at least one.
TEST(MovingAverage, BlockLength) {
  MovingAverage a;
  a.set_window(3200.0);
  EXPECT_EQ(a.block_length, 100.0);
  a.set_window(5.0);
  EXPECT_EQ(a.block_length, 1.0);
  a.set_window(32.0 * 2.6);
  EXPECT_EQ(a.block_length, 3.0);
}

// Requirement: before the window is full the average runs over what there is.
TEST(MovingAverage, BeforeItIsFull) {
  MovingAverage a;
  a.set_window(64.0);
  EXPECT_EQ(a.value(), 0.0);
  EXPECT_FALSE(a.add(4.0));
  EXPECT_EQ(a.value(), 4.0);
  EXPECT_TRUE(a.add(6.0));
  EXPECT_EQ(a.value(), 5.0);
  a.add(8.0);
  EXPECT_TRUE(a.add(10.0));
  EXPECT_EQ(a.value(), 7.0);
}

// Requirement: over a ramp of unit slope the average of the last window of N samples at sample n is
// n - (N-1)/2; it is exact when a block ends and at most one block late in between.
TEST(MovingAverage, RampAndForgetting) {
  MovingAverage a;
  a.set_window(320.0);
  for (int n = 0; n < 3200; ++n) {
    const bool ended = a.add(n);
    if (n < 320)
      continue;
    const double expected = n - 0.5 * 319.0;
    if (ended)
      ASSERT_DOUBLE_EQ(a.value(), expected);
    else
      ASSERT_NEAR(a.value(), expected, 10.0);
  }
}

// Requirement: no drift: after a large signal has left the window nothing of it remains, not even a
// round-off (a running sum would keep 1e20 * 1e-16).
TEST(MovingAverage, NothingRemains) {
  MovingAverage a;
  a.set_window(64.0);
  for (int n = 0; n < 64; ++n)
    a.add(1e20);
  for (int n = 0; n < 64; ++n)
    a.add(1.5);
  EXPECT_EQ(a.value(), 1.5);
}

// Requirement: the state is complete: a copy goes on bit for bit.
TEST(MovingAverage, CopyContinues) {
  MovingAverage a;
  a.set_window(96.0);
  double x = 0.3;
  const auto next = [&x] { return x = 3.9 * x * (1.0 - x); };
  for (int n = 0; n < 1001; ++n)
    a.add(next());
  MovingAverage b = a;
  for (int n = 0; n < 500; ++n) {
    const double sample = next();
    ASSERT_EQ(a.add(sample), b.add(sample));
    ASSERT_EQ(a.value(), b.value());
  }
}
