// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/time_count.h"

#include <gtest/gtest.h>

using namespace calendem;

TEST(TimeCount, IsTheNumberOfTheStepTimesItsLengthToTheLastBit) {
  const TimeCount count = {0.0, 0.0, 1e-4};
  for (const int n : {0, 1, 7, 333333})
    EXPECT_EQ(count.at(n), n * 1e-4);
}

TEST(TimeCount, GoesOnWhenStepsGetAnotherLength) {
  TimeCount count = {0.0, 0.0, 2e-5};
  count.set_length(1000, 2e-5);
  EXPECT_EQ(count.first, 0.0);
  count.set_length(1000, 1e-5);
  EXPECT_EQ(count.at(1000), 1000 * 2e-5);
  EXPECT_NEAR(count.at(3000), 0.04, 1e-15);
}

TEST(TimeCount, GoesOnWhenTheStepGetsAnotherNumber) {
  TimeCount count = {0.0, 0.0, 1e-4};
  count.renumber(500, 0);
  EXPECT_NEAR(count.at(0), 0.05, 1e-15);
  EXPECT_NEAR(count.at(100), 0.06, 1e-15);
  count.renumber(100, 90000);
  EXPECT_NEAR(count.at(90001), 0.0601, 1e-15);
}
