// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/chart.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

using namespace calendem::report;

// Requirement: ticks are 1, 2 or 5 times a power of ten and enclose the data.
TEST(ChartAxis, RoundTicks) {
  const Axis axis = axis_for(0, 152.3, 6);
  EXPECT_DOUBLE_EQ(axis.step, 50);
  EXPECT_DOUBLE_EQ(axis.low, 0);
  EXPECT_DOUBLE_EQ(axis.high, 200);
  EXPECT_EQ(axis.ticks().size(), 5u);
  EXPECT_EQ(axis.label(50), "50");
  EXPECT_EQ(axis_for(0, 0.83, 6).label(0.2), "0.2");
  EXPECT_EQ(axis_for(-3, 3, 6).label(-1e-12), "0");
}

// Requirement: data of no width still give an axis (a run without any broken bond).
TEST(ChartAxis, FlatDataGetsAWidth) {
  const Axis axis = axis_for(0, 0, 6);
  EXPECT_GT(axis.high, axis.low);
  EXPECT_TRUE(std::isfinite(axis.place(0, 0, 100)));
}

// Requirement: values that are not finite leave a gap and never reach the drawing.
TEST(Chart, GapsForMissingValues) {
  Chart chart;
  chart.id = "c";
  Series series;
  series.name = "a < b";
  series.x = {0, 1, 2, 3};
  series.y = {1, std::numeric_limits<double>::quiet_NaN(), 2, 3};
  chart.series.push_back(series);
  const std::string svg = to_svg(chart);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  EXPECT_TRUE(to_json(chart)["series"][0]["y"].is_array());
}

// Requirement: curves that differ little can be drawn so that it shows.
TEST(Chart, AnAxisNeedNotBeginAtZero) {
  Chart chart;
  chart.series.push_back({});
  chart.series[0].x = {1, 2};
  chart.series[0].y = {7.1, 7.4};
  const std::string label = ">7.20</text>";
  EXPECT_EQ(to_svg(chart).find(label), std::string::npos);
  chart.from_zero = false;
  EXPECT_NE(to_svg(chart).find(label), std::string::npos);
}

// Requirement: an empty chart is drawn, not a crash.
TEST(Chart, EmptyIsDrawn) {
  Chart chart;
  chart.id = "e";
  EXPECT_NE(to_svg(chart).find("</svg>"), std::string::npos);
}
