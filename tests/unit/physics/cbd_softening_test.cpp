// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/cbd_softening.h"

#include <gtest/gtest.h>

using calendem::CbdSoftening;

// Requirement: at 25 C not a bit of a result changes.
TEST(CbdSoftening, IsOneAtRoomTemperature) { EXPECT_EQ(CbdSoftening::factor(25.0), 1.0); }

// Requirement: one factor for both measurements at 80 C, each within 3 %, half their difference of
// 4 % and the reading of an indent's depth (1 %).
TEST(CbdSoftening, MeetsModulusAndIndentsAtEightyDegrees) {
  EXPECT_NEAR(CbdSoftening::factor(80.0) / 0.59, 1.0, 0.03);
  EXPECT_NEAR(CbdSoftening::factor(80.0) / (1193.0 / 1948.0), 1.0, 0.03);
}

TEST(CbdSoftening, FallsByTheSamePartPerDegree) {
  for (double t = CbdSoftening::kColdest; t < CbdSoftening::kHottest; t += 10.0)
    EXPECT_NEAR(CbdSoftening::factor(t + 10.0) / CbdSoftening::factor(t),
                std::exp(-10.0 / CbdSoftening::kScale), 1e-12)
        << t;
}
