// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/run_folder.h"

#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

using calendem::Curve;

namespace {
Curve up_and_down() {
  Curve curve;
  curve.stage = {"compression", "compression", "compression", "dwell", "relaxation", "relaxation"};
  curve.columns["pressure_MPa"] = {0, 10, 8, 40, 20, 0};
  curve.columns["pressure_bottom_MPa"] = {0, 9, 8, 42, 20, 5};
  curve.columns["broken_fraction"] = {0, 0.1, 0.15, 0.3, 0.32, 0.32};
  return curve;
}
} // namespace

// Requirement: the branches meet in the last row before relaxation.
TEST(Branches, ShareTheTurningPoint) {
  const Curve curve = up_and_down();
  EXPECT_EQ(curve.compression(), (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(curve.relaxation(), (std::vector<std::size_t>{3, 4, 5}));
  EXPECT_EQ(curve.row_of_max_pressure(), 3u);
}

// Requirement: values are those of the first crossing in compression, interpolated; NaN if none.
TEST(Branches, FirstCrossingIsInterpolated) {
  const Curve curve = up_and_down();
  using calendem::at_first_crossing;
  EXPECT_DOUBLE_EQ(at_first_crossing(curve, 5, "broken_fraction"), 0.05);
  EXPECT_DOUBLE_EQ(at_first_crossing(curve, 9, "broken_fraction"), 0.09); // not on the way back
  EXPECT_DOUBLE_EQ(at_first_crossing(curve, 24, "broken_fraction"), 0.225);
  EXPECT_TRUE(std::isnan(at_first_crossing(curve, 41, "broken_fraction")));
  EXPECT_TRUE(std::isnan(at_first_crossing(curve, 5, "no_such_column")));
}

// Requirement: the imbalance is relative to the platen's pressure and counts above the threshold
// only.
TEST(Branches, WorstImbalanceAboveThreshold) {
  EXPECT_DOUBLE_EQ(calendem::worst_imbalance(up_and_down(), 5), 0.1);
  EXPECT_DOUBLE_EQ(calendem::worst_imbalance(up_and_down(), 10), 0.05);
  EXPECT_TRUE(std::isnan(calendem::worst_imbalance(up_and_down(), 100)));
}

// Requirement: only rows count that load the film farther than the presses before; not a release,
// nor what follows it up to the largest pressure so far. A fall of the pressure within a press counts.
TEST(Branches, ImbalanceCountsWhereTheFilmIsFirstLoaded) {
  Curve curve = up_and_down();
  for (const auto &[stage, top, bottom] :
       {std::tuple("compression", 7, 70), std::tuple("compression", 40, 20),
        std::tuple("compression", 50, 45), std::tuple("compression", 30, 31),
        std::tuple("compression", 45, 54), std::tuple("relaxation", 44, 0)}) {
    curve.stage.push_back(stage);
    curve.columns["pressure_MPa"].push_back(top);
    curve.columns["pressure_bottom_MPa"].push_back(bottom);
  }
  EXPECT_DOUBLE_EQ(calendem::worst_imbalance(curve, 5), 0.2); // at 45 MPa, beyond the first 40
  EXPECT_DOUBLE_EQ(calendem::worst_imbalance(curve, 46), 0.1);
}
