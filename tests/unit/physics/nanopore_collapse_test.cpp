// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/nanopore_collapse.h"
#include "physics/pi.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {
const NanoporeCollapse law = {0.5, 0.27, 2e4, 5e4, 0.1};

} // namespace

// Requirement: nothing below yield; above, one hardening pressure takes the excess to 1/e; the
// floor is the limit.
TEST(NanoporeCollapse, Target) {
  EXPECT_EQ(law.target(-1e9), 0.5);
  EXPECT_EQ(law.target(2e4), 0.5);
  EXPECT_DOUBLE_EQ(law.target(7e4), 0.27 + 0.23 * std::exp(-1.0));
  EXPECT_DOUBLE_EQ(law.target(1e9), 0.27);
}

// Requirement: after one relaxation time 1/e of the way is left, and two half steps are one step.
TEST(NanoporeCollapse, FollowsItsTarget) {
  const double to = law.target(7e4);
  EXPECT_DOUBLE_EQ(law.advance(0.5, 7e4, 0.1), to + (0.5 - to) * std::exp(-1.0));
  EXPECT_DOUBLE_EQ(law.advance(law.advance(0.5, 7e4, 0.03), 7e4, 0.07), law.advance(0.5, 7e4, 0.1));
  EXPECT_DOUBLE_EQ(law.advance(0.5, 7e4, 1e9), to);
}

// Requirement: irreversible. A lower target than the state's is the only one that acts.
TEST(NanoporeCollapse, NeverComesBack) {
  EXPECT_EQ(law.advance(0.4, 0.0, 1.0), 0.4);
  EXPECT_EQ(law.advance(0.4, 2.5e4, 1.0), 0.4); // its target is above 0.4
  double phi = 0.5;
  for (double p = 0.0; p < 4e5; p += 1e4) {
    const double next = law.advance(phi, p, 0.05);
    EXPECT_LE(next, phi);
    EXPECT_GE(next, 0.27);
    phi = next;
  }
}

// Requirement: an imposed fall is linear in the platen's pressure and ends at the floor; without
// pressure, or under pull, nothing falls.
TEST(NanoporeCollapse, Imposed) {
  EXPECT_EQ(law.imposed(-1.0, 1e5), 0.5);
  EXPECT_EQ(law.imposed(0.0, 1e5), 0.5);
  EXPECT_DOUBLE_EQ(law.imposed(4e4, 1e5), 0.5 - 0.4 * 0.23);
  EXPECT_DOUBLE_EQ(law.imposed(1e5, 1e5), 0.27);
  EXPECT_DOUBLE_EQ(law.imposed(3e5, 1e5), 0.27);
}

// Requirement: the solid in the sphere is kept; the paper's spheres: 1.316 um at 50 % become 1.16
// um at 27 % (its three digits).
TEST(NanoporeCollapse, SolidIsKept) {
  for (double phi : {0.5, 0.4, 0.27}) {
    const double r = law.radius(0.658, phi);
    EXPECT_NEAR((1.0 - phi) * r * r * r, 0.5 * 0.658 * 0.658 * 0.658, 1e-15);
  }
  EXPECT_NEAR(2.0 * law.radius(0.658, 0.27), 1.16, 5e-4);
}

// Requirement: a sphere between two plates under F has p = 2 F r/(3 V) = F/(2 pi r^2).
TEST(NanoporeCollapse, MeanPressure) {
  EXPECT_DOUBLE_EQ(mean_pressure(2.0 * 3.0, 0.5),
                   2.0 * 3.0 * 0.5 / (3.0 * 4.0 / 3.0 * kPi * 0.125));
}
