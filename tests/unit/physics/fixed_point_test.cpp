// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/fixed_point.h"
#include "physics/vector3.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

using calendem::exact_spacing;
using calendem::FixedPoint;
using calendem::nearest_multiple;
using calendem::SumCheck;
using calendem::Vec3;
using calendem::WideSum;

namespace {
long long whole(const FixedPoint &unit, double term) {
  return static_cast<long long>(unit.rounded(term));
}

double sum_of(const std::vector<double> &terms, const FixedPoint &unit) {
  unsigned long long sum = 0;
  for (const double x : terms)
    sum += static_cast<unsigned long long>(whole(unit, x));
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
    EXPECT_EQ(0, whole(unit, x) + whole(unit, -x)) << x;
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

namespace {
/// As the sum of the forces on an atom.
struct CheckedSum {
  unsigned long long whole[4] = {};
  double sum[3] = {};
  bool can_be = true;

  void add(const Vec3 &term, int sign) { // as i or as j
    const double c[4] = {term.x, term.y, term.z, SumCheck::of(term.x, term.y, term.z)};
    can_be = can_be && SumCheck::can_be_added(c[3]);
    for (int k = 0; k < 4; ++k) {
      const bool held = std::fabs(c[k]) < 0x1p63; // else what the processor makes of it
      const long long number = held ? static_cast<long long>(c[k]) : -0x7fffffffffffffffLL - 1;
      whole[k] += static_cast<unsigned long long>(sign) * static_cast<unsigned long long>(number);
    }
    for (int k = 0; k < 3; ++k)
      sum[k] += sign * c[k];
  }
  bool fits() const { return can_be && SumCheck::fits(whole); }
  double largest() const {
    return std::fmax(std::fmax(std::fabs(sum[0]), std::fabs(sum[1])), std::fabs(sum[2]));
  }
};
} // namespace

// Vectors whose sum leaves the range of 64 digits, by however much, are seen; all others are not.
TEST(SumCheck, KnowsWhenTheSumHasLeftItsRange) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto vector = [&] { return Vec3{number(random), number(random), number(random)}; };
  int beyond = 0, within = 0;
  for (int n = 0; n < 20000; ++n) {
    const int terms = 1 + static_cast<int>(random() % 60);
    const double scale = 0x1p63 * std::exp2(10.0 * number(random));
    const Vec3 lean = vector();
    CheckedSum sum;
    for (int k = 0; k < terms; ++k) {
      const int sign = k % 2 ? -1 : 1;
      Vec3 term = (0.2 * scale) * (sign * lean + 0.3 * vector());
      const double over = norm(term) / 0x1.fffffp62; // every other cluster: none too large itself
      sum.add(n % 2 && over > 1.0 ? (1.0 / over) * term : term, sign);
    }
    const double ratio = sum.largest() / 0x1p63;
    beyond += ratio > 1.000001;
    within += ratio < 0.999999;
    if (ratio > 1.000001 || (n % 2 && ratio < 0.999999)) {
      EXPECT_EQ(sum.fits(), ratio < 1.0) << ratio << " after " << terms;
    }
  }
  EXPECT_GT(beyond, 4000);
  EXPECT_GT(within, 4000);
}

TEST(SumCheck, SeesWhatIsNoNumber) {
  for (const double x : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e30, -1e30})
    for (const Vec3 &term : {Vec3{x, 0, 0}, Vec3{0, x, 0}, Vec3{0, 0, x}, Vec3{x, x, x}}) {
      CheckedSum sum;
      sum.add({1e3, -2e18, 3e18}, 1);
      for (int n = 1; n < 200; ++n) {
        sum.add(term, 1);
        EXPECT_FALSE(sum.fits()) << x << " " << n;
      }
    }
}

// A number comes back as it was, whatever its size and sign.
TEST(WideSum, OneTermIsItself) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-43.0, 95.0);
  for (int n = 0; n < 10000; ++n) {
    const double x = std::exp2(exponent(random)) * (n % 2 ? -1.0 : 1.0);
    WideSum sum;
    sum.add(x);
    EXPECT_EQ(sum.value(), x);
    EXPECT_TRUE(sum.holds_all());
  }
}

// Loads of particles from nm to cm, in N, nN or dyn, add up without rounding, in any order and in
// parts: what is large goes, what is small stays.
TEST(WideSum, DoesNotDependOnOrderPartsOrSize) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-40.0, 40.0);
  std::vector<double> terms;
  for (int n = 0; n < 1000; ++n) {
    const double x = normal(random) * std::exp2(exponent(random)), large = 1e28 * normal(random);
    for (const double term : {x, large, -large})
      terms.push_back(term);
  }
  const auto sum_in_parts = [&](size_t parts) {
    std::shuffle(terms.begin(), terms.end(), random);
    std::vector<WideSum> part(parts);
    for (size_t n = 0; n < terms.size(); ++n)
      part[n % parts].add(terms[n]);
    WideSum all;
    for (const WideSum &p : part)
      all.add(p);
    return all.value();
  };
  const double first = sum_in_parts(1);
  for (const size_t parts : {1, 2, 3, 7})
    EXPECT_EQ(sum_in_parts(parts), first);
  WideSum small;
  for (const double x : terms)
    if (std::fabs(x) < 1e20)
      small.add(x);
  EXPECT_EQ(small.value(), first);
}

// The load on the paper's cell at 150 MPa, and on one of 1 cm2, over a block of the averages at the
// paper's 0.01 m/s.
TEST(WideSum, HoldsALoadOverManySteps) {
  for (const double load : {1.365e8, -1.365e8, 1.5e13, 1.365e-1}) {
    WideSum sum;
    for (int step = 0; step < 4096; ++step) {
      WideSum of_step;
      of_step.add(load);
      sum.add(of_step);
    }
    EXPECT_EQ(sum.value(), 4096 * load);
  }
}

TEST(WideSum, CountsWhatItCannotHold) {
  for (const double term : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e30, -1e30}) {
    WideSum sum, all;
    sum.add(term);
    sum.add(1.0);
    all.add(sum);
    EXPECT_FALSE(sum.holds_all()) << term;
    EXPECT_FALSE(all.holds_all()) << term;
  }
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
