// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/fixed_point.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

using calendem::exact_spacing;
using calendem::FixedPoint;
using calendem::nearest_multiple;

namespace {
double sum_of(const std::vector<double> &terms, const FixedPoint &unit) {
  unsigned long long sum = 0;
  for (const double x : terms)
    sum += unit.of(x);
  return unit.value(static_cast<long long>(sum));
}
} // namespace

TEST(FixedPointSum, DoesNotDependOnTheOrder) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1e5);
  std::vector<double> terms(1000);
  for (double &x : terms)
    x = normal(random);
  const FixedPoint unit(1e9);
  const double first = sum_of(terms, unit);
  double as_doubles = 0.0;
  bool differs = false;
  for (int n = 0; n < 20; ++n) {
    std::shuffle(terms.begin(), terms.end(), random);
    EXPECT_EQ(first, sum_of(terms, unit));
    double sum = 0.0;
    for (const double x : terms)
      sum += x;
    differs = differs || (n > 0 && sum != as_doubles);
    as_doubles = sum;
  }
  EXPECT_TRUE(differs) << "sums of doubles do, or this test shows nothing";
  EXPECT_NEAR(first, as_doubles, 1000 * unit.unit + 1000 * 1e8 * 2.3e-16);
}

TEST(FixedPointSum, ForceAndCounterforceCancel) {
  const FixedPoint unit(1e9);
  for (const double x : {1.0 / 3.0, 1e-12, 123456.789, 8e8})
    EXPECT_EQ(0, unit.of(x) + unit.of(-x)) << x;
}

TEST(FixedPointSum, TooLargeOnTheWayIsNoHarm) {
  const FixedPoint unit(1e9);
  const std::vector<double> terms = {9e8, 9e8, 9e8, -9e8, -9e8, 1.0};
  EXPECT_NEAR(sum_of(terms, unit), 9e8 + 1.0, 6 * unit.unit);
}

TEST(FixedPointSum, UnitIsAPowerOfTwo) {
  for (const double largest : {1.0, 1e9, 3e-4}) {
    const FixedPoint unit(largest);
    int exponent = 0;
    EXPECT_EQ(0.5, std::frexp(unit.unit, &exponent));
    EXPECT_GE(unit.unit * 4.611686018427388e18, largest);
  }
}

// The load on the paper's cell at 150 MPa over a block of the averages at the paper's 0.01 m/s.
TEST(LongSum, HoldsALoadOverManySteps) {
  const FixedPoint unit(8e9);
  calendem::LongSum sum, opposite;
  const double load = 1.365e8;
  for (int step = 0; step < 4000; ++step) {
    sum.add(unit.of(load));
    opposite.add(unit.of(-load));
  }
  EXPECT_EQ(sum.value() * unit.unit, 4000 * load);
  EXPECT_EQ(opposite.value() * unit.unit, -4000 * load);
}

// On the grid a shift by a side and back is exact; off it, it is not.
TEST(GridOfPositions, ShiftsByASideAreExact) {
  const double side = nearest_multiple(14.87, exact_spacing(64.0)), spacing = exact_spacing(64.0);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(0.0, side);
  int rounded = 0;
  for (int n = 0; n < 1000; ++n) {
    const double a = place(random), b = place(random);
    const double x = nearest_multiple(a, spacing), y = nearest_multiple(b, spacing);
    EXPECT_EQ(x - (y + side), (x - side) - y);
    EXPECT_LE(std::fabs(x - a), 0.5 * spacing);
    rounded += a - (b + 14.87) != (a - 14.87) - b;
  }
  EXPECT_GT(rounded, 100);
}
