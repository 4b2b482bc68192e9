// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/contact_range.h"

#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"

using namespace calendem;

// Requirement: five contacts by hand, one at a limit, which is not beyond it.
TEST(ContactRange, CountsByHand) {
  ContactRange r;
  EXPECT_EQ(r.mean(), 0.0); // no contact yet
  r.add(0.05, 1.0, 1.0);
  r.add(0.2, 1.0, 2.0);         // at the second limit, beyond the first
  r.add(0.11, 0.5, 4.0);        // 0.22 of the smaller radius
  r.add(0.0625, 0.125, 8);      // 0.5: beyond all three
  r.add(0.25, 1.0, 16.0, 0.25); // at the limit of its law
  EXPECT_EQ(r.of[ContactRange::kContacts], 5.0);
  EXPECT_EQ(r.of[ContactRange::kForce], 31.0);
  EXPECT_DOUBLE_EQ(r.mean(), (0.05 + 0.2 + 0.22 + 0.5 + 0.25) / 5.0);
  EXPECT_EQ(r.largest, 0.5);
  const double contacts[] = {4.0, 3.0, 1.0, 2.0}, forces[] = {30.0, 28.0, 8.0, 12.0};
  for (int k = 0; k < kRangeLimits; ++k) {
    EXPECT_EQ(r.of[ContactRange::kBeyond + k], contacts[k]) << k;
    EXPECT_EQ(r.of[ContactRange::kForceBeyond + k], forces[k]) << k;
  }
}

// Requirement: what the header says of a rigid sphere on a half-space. Sneddon, with contact radius
// a and L = ln((R + a)/(R - a)): delta = a L/2, F = E* ((a^2 + R^2) L/2 - a R).
TEST(ContactRange, ParabolaBesideSphere) {
  const double percent[] = {1.0, 2.0, 3.0};
  for (int k = 0; k < kRangeLimits - 1; ++k) {
    double low = 0.0, high = 1.0; // of a, R = 1
    for (int n = 0; n < 60; ++n) {
      const double a = 0.5 * (low + high);
      (0.5 * a * std::log((1.0 + a) / (1.0 - a)) < kRangeLimit[k] ? low : high) = a;
    }
    const double force = 0.5 * (low * low + 1.0) * std::log((1.0 + low) / (1.0 - low)) - low;
    EXPECT_NEAR(100.0 * (hertz_force(1.0, 1.0, kRangeLimit[k]) / force - 1.0), percent[k], 0.5);
  }
}
