// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/inertial_number.h"

#include <gtest/gtest.h>

using namespace calendem;

// Requirement: by hand: 2 um/us on 50 um is 0.04 /us; 1.5 um * sqrt(4 pg/um3 / 2.5e5 kPa) is 6e-3
// us.
TEST(InertialNumber, ByHand) {
  EXPECT_DOUBLE_EQ(inertial_number(2.0, 50.0, {1.5, 4.0}, 2.5e5), 2.4e-4);
  EXPECT_DOUBLE_EQ(inertial_number(-2.0, 50.0, {1.5, 4.0}, 2.5e5), 2.4e-4);
  EXPECT_EQ(inertial_number(0.0, 50.0, {1.5, 4.0}, 2.5e5), 0.0);
}

// Requirement: without pressure there is none.
TEST(InertialNumber, NotWithoutPressure) {
  EXPECT_TRUE(std::isnan(inertial_number(1.0, 50.0, {1.5, 4.0}, 0.0)));
  EXPECT_TRUE(std::isnan(inertial_number(1.0, 50.0, {1.5, 4.0}, -3.0)));
}
