// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/acting_contact.h"
#include <gtest/gtest.h>

using namespace calendem;

// Requirement: a contact acts beyond its reference only, cohesion ends where spheres that are larger
// by the reference would touch, and both are continuous there. Sums of binary fractions: exact.
TEST(ActingContact, CountsFromItsReference) {
  constexpr double kSum = 1.5, kReference = 0.25;
  EXPECT_EQ(acting_overlap(kSum, 1.0, kReference), 0.25);
  EXPECT_EQ(acting_overlap(kSum, 1.25, kReference), 0.0);
  EXPECT_EQ(acting_overlap(kSum, 1.375, kReference), 0.0); // spheres overlap, the contact rests
  EXPECT_EQ(acting_overlap(kSum, 2.0, kReference), 0.0);
  for (const double r : {1.0, 1.125, 1.25}) // up to which overlap and lens agree
    EXPECT_EQ(acting_overlap(kSum, r, kReference), kSum - acting_distance(r, kReference));
}
