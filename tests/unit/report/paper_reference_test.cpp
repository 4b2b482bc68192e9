// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/tables.h"

#include <gtest/gtest.h>

// Requirement: the embedded reference is the paper's Table 1 and its three broken fractions.
TEST(PaperReference, IsWhatThePaperPrints) {
  const auto porosity = calendem::report::paper_porosity();
  ASSERT_EQ(porosity.size(), 3u);
  EXPECT_DOUBLE_EQ(porosity[0].porosity_percent, 47.97);
  EXPECT_DOUBLE_EQ(porosity[1].porosity_percent, 27.75);
  EXPECT_DOUBLE_EQ(porosity[2].pressure_MPa, 150);
  EXPECT_DOUBLE_EQ(porosity[2].porosity_percent, 25.17);
  EXPECT_DOUBLE_EQ(porosity[2].sd_percent, 1.2);
  const auto breaks = calendem::report::paper_breaks();
  ASSERT_EQ(breaks.size(), 3u);
  EXPECT_DOUBLE_EQ(breaks[0].pressure_MPa, 20);
  EXPECT_DOUBLE_EQ(breaks[2].broken_percent, 20.3);
}
