// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/contact_range.h"

#include <gtest/gtest.h>

using namespace calendem;

// Requirement: five contacts by hand, one at a limit, which is not beyond it.
TEST(ContactRange, CountsByHand) {
  ContactRange r;
  EXPECT_EQ(r.mean(), 0.0); // no contact yet
  r.add(0.05, 1.0, 1.0);
  r.add(0.2, 1.0, 2.0);    // at the second limit, beyond the first
  r.add(0.11, 0.5, 4.0);   // 0.22 of the smaller radius
  r.add(0.0625, 0.125, 8); // 0.5: beyond all three
  r.add(0.25, 1.0, 16.0);
  EXPECT_EQ(r.of[ContactRange::kContacts], 5.0);
  EXPECT_EQ(r.of[ContactRange::kForce], 31.0);
  EXPECT_DOUBLE_EQ(r.mean(), (0.05 + 0.2 + 0.22 + 0.5 + 0.25) / 5.0);
  EXPECT_EQ(r.largest, 0.5);
  const double contacts[] = {4.0, 3.0, 1.0}, forces[] = {30.0, 28.0, 8.0};
  for (int k = 0; k < kRangeLimits; ++k) {
    EXPECT_EQ(r.of[ContactRange::kBeyond + k], contacts[k]) << kRangeLimit[k];
    EXPECT_EQ(r.of[ContactRange::kForceBeyond + k], forces[k]) << kRangeLimit[k];
  }
}
