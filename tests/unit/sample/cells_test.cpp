// SPDX-License-Identifier: GPL-2.0-or-later
// Springs of different height beside each other, under one plate and under one pressure.
#include "simulate/sample.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace calendem;

/// Bears `stiff` (height - gap), pressed to `lowest` and released; seen from the first row after
/// the start to the last before the end. Every third row's gap is repeated, as of a platen that
/// waits.
PressedCell spring(double height, double stiff, double lowest, int rows) {
  PressPath down, up;
  for (int k = 1; k <= rows; ++k) {
    const double gap = k == rows ? lowest : height - (height - lowest) * k / rows;
    for (int n = 0; n <= (k % 3 == 0); ++n) {
      down.gap.push_back(gap);
      down.pressure.push_back(stiff * (height - gap));
    }
  }
  up.gap.assign(down.gap.rbegin(), down.gap.rend());
  up.pressure.assign(down.pressure.rbegin(), down.pressure.rend());
  return {height, monotone(down, false), monotone(up, true)};
}

/// What it bears where it is seen, else nothing.
double force(const PressedCell &c, double stiff, double gap) {
  return gap <= c.down.gap.front() ? stiff * (c.thickness - gap) : 0.0;
}

const double kHeights[] = {20.0, 21.5, 18.0, 20.5}, kStiff[] = {3.0, 5.0, 4.0, 2.0};

std::vector<PressedCell> springs(bool to_gap) {
  std::vector<PressedCell> out;
  for (int k = 0; k < 4; ++k)
    out.push_back(
        spring(kHeights[k], kStiff[k], to_gap ? 15.0 : kHeights[k] - 12.0 / kStiff[k], 37 + 4 * k));
  return out;
}

TEST(Sample, SpringsUnderOnePlateBearTheMeanOfTheirForces) {
  const std::vector<PressedCell> cells = springs(true);
  const std::vector<SampleRow> rows = under_one_gap(cells);
  double end = 0.0;
  for (const PressedCell &c : cells)
    end = std::max(end, c.up.gap.back());
  for (const SampleRow &r : rows) {
    double due = 0.0;
    for (int k = 0; k < 4; ++k)
      due += 0.25 * force(cells[k], kStiff[k], r.gap);
    EXPECT_NEAR(r.pressure, due, 1e-12) << r.gap;
  }
  EXPECT_EQ(rows.front().gap, 21.5);
  EXPECT_EQ(rows.back().gap, end);
  // a row for each of 37 + 41 + 45 + 49 points, down and up, and for each height; 15 um counts once
  EXPECT_EQ(rows.size(), 2u * (172 - 3) + 4);
}

TEST(Sample, SpringsUnderOnePressureAreAsHighAsTheirMean) {
  const std::vector<SampleRow> rows = under_one_pressure(springs(false));
  for (const SampleRow &r : rows) {
    double due = 0.0;
    for (int k = 0; k < 4; ++k)
      due += 0.25 * (kHeights[k] - r.pressure / kStiff[k]);
    if (r.pressure >= 12.0 / 37.0) { // the highest of the first points
      EXPECT_NEAR(r.gap, due, 1e-12) << r.pressure;
    }
  }
  EXPECT_NEAR(std::max_element(
                  rows.begin(), rows.end(),
                  [](const SampleRow &a, const SampleRow &b) { return a.pressure < b.pressure; })
                  ->pressure,
              12.0, 1e-12);
  EXPECT_NEAR(rows.back().pressure, 12.0 / 37.0, 1e-12);
}

// Stiffer and more uneven springs: at one gap a plate needs more pressure for the mean height.
TEST(Sample, OneGapIsStifferThanOnePressure) {
  const std::vector<SampleRow> gap = under_one_gap(springs(true)),
                               pressure = under_one_pressure(springs(false));
  const SampleRow &at = pressure[80];
  for (std::size_t k = 1; k < gap.size() && !gap[k].released; ++k)
    if (gap[k].gap <= at.gap) {
      EXPECT_GT(gap[k - 1].pressure, at.pressure);
      return;
    }
  FAIL() << "no gap of " << at.gap;
}

// A cell that yields in steps has a pressure where it first meets it; released, where it last does.
TEST(Sample, AJaggedCellHasAPressureWhereItFirstMeetsIt) {
  const PressedCell cell = {
      10.0, {{10.0, 9.0, 8.0, 7.0}, {0.0, 4.0, 2.0, 6.0}}, {{7.5, 8.0, 8.5}, {3.0, 5.0, 0.0}}};
  for (const SampleRow &r : under_one_pressure({cell}))
    EXPECT_NEAR(r.gap,
                r.released          ? 8.5 - 0.1 * std::min(r.pressure, 5.0)
                : r.pressure <= 4.0 ? 10.0 - r.pressure / 4.0
                                    : 13.0 - r.pressure,
                1e-12)
        << r.pressure;
}

} // namespace
