// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/pi.h"
#include "physics/sjkr_cohesion.h"

#include <cmath>

#include <gtest/gtest.h>

using calendem::kPi;
using calendem::lens_area;
using calendem::sjkr_force;
using calendem::sjkr_potential;
using calendem::sjkr_wall_force;
using calendem::sjkr_wall_potential;

namespace {

// Area of the circle in which two spheres meet, without the closed form: bisection for the plane at
// distance x from centre i in which both sections have the same radius.
double area_by_bisection(double r, double radius_i, double radius_j) {
  const auto section2 = [](double R, double x) { return R * R - x * x; };
  double low = -radius_i, high = radius_i; // section i - section j falls with x
  for (int n = 0; n < 200; ++n) {
    const double x = 0.5 * (low + high);
    (section2(radius_i, x) > section2(radius_j, r - x) ? low : high) = x;
  }
  return kPi * section2(radius_i, 0.5 * (low + high));
}

} // namespace

// Requirement: known values. Unit spheres at distance 1 meet in a circle of radius sqrt(3)/2; a
// 3-4-5 triangle of radii 3, 4 at distance 5 gives a circle of radius 12/5. 4 ulp: five products.
TEST(SjkrCohesion, KnownAreas) {
  EXPECT_DOUBLE_EQ(lens_area(1.0, 1.0, 1.0), 0.75 * kPi);
  EXPECT_DOUBLE_EQ(lens_area(5.0, 3.0, 4.0), 5.76 * kPi);
}

// Requirement: the closed form is the circle of intersection, for all ratios of radii and overlaps.
// 1e-12 of the smaller great circle: bisection to 1 ulp of x, cancellation in R^2 - x^2.
TEST(SjkrCohesion, AreaAgainstBisection) {
  for (double ratio : {1.0, 0.7, 0.5, 0.1})
    for (double share : {1e-3, 0.01, 0.1, 0.5, 0.99}) {
      const double Ri = 0.795, Rj = ratio * Ri, r = Ri + Rj - share * 2.0 * Rj;
      EXPECT_NEAR(lens_area(r, Ri, Rj), area_by_bisection(r, Ri, Rj), 1e-12 * kPi * Ri * Ri);
    }
}

// Requirement: no attraction without overlap or when one sphere holds the other; both sides of a
// pair compute the same.
TEST(SjkrCohesion, EndsAndSymmetry) {
  EXPECT_EQ(lens_area(2.0, 1.0, 1.0), 0.0);
  EXPECT_EQ(lens_area(2.5, 1.0, 1.0), 0.0);
  EXPECT_EQ(lens_area(0.4, 1.0, 0.5), 0.0);
  EXPECT_EQ(sjkr_force(6e5, 1.3, 0.795, 0.795), 6e5 * lens_area(1.3, 0.795, 0.795));
  for (double r = 0.55; r < 1.5; r += 0.01) // 4 ulp: the order of two factors differs
    EXPECT_DOUBLE_EQ(lens_area(r, 1.0, 0.5), lens_area(r, 0.5, 1.0));
}

// Requirement: known values. Unit spheres at distance 1: the integral of pi/4 (4 - x^2) from 1 to 2
// is 5 pi/12. Zero without overlap; where no force acts any more, constant.
TEST(SjkrCohesion, KnownPotentials) {
  EXPECT_DOUBLE_EQ(sjkr_potential(3.0, 1.0, 1.0, 1.0), -3.0 * 5.0 * kPi / 12.0);
  EXPECT_DOUBLE_EQ(sjkr_potential(1.0, 0.0, 1.0, 1.0), -kPi / 4.0 * 16.0 / 3.0);
  EXPECT_EQ(sjkr_potential(3.0, 2.0, 1.0, 1.0), 0.0);
  EXPECT_EQ(sjkr_potential(3.0, 2.5, 1.0, 1.0), 0.0);
  EXPECT_EQ(sjkr_potential(3.0, 0.1, 1.0, 0.5), sjkr_potential(3.0, 0.5, 1.0, 0.5));
}

// Requirement: at a flat wall force and potential are the limit of a sphere that grows: the area
// differs by R/R_j at most, and the sum of radii rounds to 2e-12 of overlaps from 1e-4 on. Zero
// without overlap.
TEST(SjkrCohesion, WallIsTheLimitOfALargeSphere) {
  const double R = 0.795, large = 1e4, most = R / large + 2.0 * 2e-12 / 1e-4;
  for (double r : {0.7949, 0.7, 0.4}) {
    const double from_large = large + r;
    EXPECT_NEAR(sjkr_wall_force(6e5, r, R) / sjkr_force(6e5, from_large, R, large), 1.0, most);
    EXPECT_NEAR(sjkr_wall_potential(6e5, r, R) / sjkr_potential(6e5, from_large, R, large), 1.0,
                most);
  }
  EXPECT_EQ(sjkr_wall_force(6e5, R, R), 0.0);
  EXPECT_EQ(sjkr_wall_potential(6e5, R + 0.1, R), 0.0);
}

// Requirement: the attraction is the potential's slope, for all ratios of radii and overlaps.
// Central difference of step h = 1e-4 delta: its relative error h^2 |A''|/(6 A) = 1e-8 delta
// [2 r^2 + 6 S^2 D^2/r^2] / [6 (S + r)(r^2 - D^2)] is below 1e-8 here; round-off 1e-16/1e-4.
TEST(SjkrCohesion, ForceIsSlopeOfPotential) {
  for (double ratio : {1.0, 0.7, 0.5, 0.1})
    for (double share : {1e-3, 0.01, 0.1, 0.5}) {
      const double Ri = 0.795, Rj = ratio * Ri, delta = share * 2.0 * Rj, r = Ri + Rj - delta;
      const double h = 1e-4 * delta;
      const double slope =
          (sjkr_potential(6e5, r + h, Ri, Rj) - sjkr_potential(6e5, r - h, Ri, Rj)) / (2.0 * h);
      // S - r itself is known to 1 ulp of S only: 1e-16 S / h
      const double round_off = 2.2e-16 * (Ri + Rj) / h;
      EXPECT_NEAR(slope / sjkr_force(6e5, r, Ri, Rj), 1.0, 1e-8 + 2.0 * round_off);
      EXPECT_DOUBLE_EQ(sjkr_potential(6e5, r, Ri, Rj), sjkr_potential(6e5, r, Rj, Ri));
    }
}
