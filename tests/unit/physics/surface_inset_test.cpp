// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/surface_inset.h"

#include <gtest/gtest.h>

using calendem::surface_inset;

TEST(SurfaceInset, GoesWithTheBondsUpToSix) {
  EXPECT_EQ(surface_inset(0.09, 1.0, 0), 0.0);
  EXPECT_DOUBLE_EQ(surface_inset(0.09, 1.0, 2), 0.03);
  EXPECT_DOUBLE_EQ(surface_inset(0.09, 0.5, 3), 0.0675);
  EXPECT_EQ(surface_inset(0.09, 1.0, 6), 0.09);
  EXPECT_EQ(surface_inset(0.09, 1.0, 11), 0.09);
}

TEST(SurfaceInset, StaysWithoutFading) {
  for (const int bonds : {0, 3, 6, 11})
    EXPECT_EQ(surface_inset(0.09, 0.0, bonds), 0.09);
}
