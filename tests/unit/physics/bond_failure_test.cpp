// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/bond_failure.h"

#include <gtest/gtest.h>

#include "random_vector.h"

using namespace calendem;

namespace {

const BondSection kSection(0.795);
const BondStrength kStrength = {5e5, 3e5};
const FailureCriterion kAll[] = {FailureCriterion::Signed, FailureCriterion::Unsigned,
                                 FailureCriterion::AsPrinted};
const double kTensileForce = kStrength.tensile * kPi * 0.795 * 0.795;

bool pure_force_breaks(double tension, FailureCriterion criterion) {
  return fails(BondLoads{}, tension, kSection, kStrength, criterion);
}

} // namespace

// Requirement: pure tension breaks a bond at F = sigma_c A with `signed` and `unsigned`; with
// `as_printed` (eq. 6 to the letter) no tension does. 1e-12: round-off of three products.
TEST(BondFailure, PureTension) {
  for (const FailureCriterion c : {FailureCriterion::Signed, FailureCriterion::Unsigned}) {
    EXPECT_FALSE(pure_force_breaks(kTensileForce * (1 - 1e-12), c));
    EXPECT_TRUE(pure_force_breaks(kTensileForce * (1 + 1e-12), c));
  }
  for (double factor : {0.5, 1.0, 5.0, 1e6})
    EXPECT_FALSE(pure_force_breaks(factor * kTensileForce, FailureCriterion::AsPrinted));
}

// Requirement: no pure compression breaks a bond with `signed` and `as_printed`; `unsigned` breaks
// it at sigma_c A.
TEST(BondFailure, PureCompression) {
  for (double factor : {0.5, 1.0, 5.0, 1e6})
    for (const FailureCriterion c : {FailureCriterion::Signed, FailureCriterion::AsPrinted})
      EXPECT_FALSE(pure_force_breaks(-factor * kTensileForce, c));
  EXPECT_FALSE(pure_force_breaks(-kTensileForce * (1 - 1e-12), FailureCriterion::Unsigned));
  EXPECT_TRUE(pure_force_breaks(-kTensileForce * (1 + 1e-12), FailureCriterion::Unsigned));
}

// Requirement: bending, shear and torsion alone break the bond at the closed forms
// M = sigma_c pi R^3/4, F = tau_c pi R^2, M = tau_c pi R^3/2, whatever the criterion.
TEST(BondFailure, BendingShearTorsionAlone) {
  const double R3 = 0.795 * 0.795 * 0.795;
  const double bending = kStrength.tensile * kPi * R3 / 4.0;
  const double shear = kStrength.shear * kPi * 0.795 * 0.795;
  const double torsion = kStrength.shear * kPi * R3 / 2.0;
  for (const FailureCriterion c : kAll)
    for (int sign : {-1, 1}) { // just below, just above; 1e-12: round-off
      const double f = 1.0 + sign * 1e-12;
      EXPECT_EQ(fails({{}, {0.0, 0.6 * bending * f, 0.8 * bending * f}, 0.0}, 0.0, kSection,
                      kStrength, c),
                sign > 0);
      EXPECT_EQ(
          fails({{0.0, -0.8 * shear * f, 0.6 * shear * f}, {}, 0.0}, 0.0, kSection, kStrength, c),
          sign > 0);
      for (int way : {-1, 1})
        EXPECT_EQ(fails({{}, {}, way * torsion * f}, 0.0, kSection, kStrength, c), sign > 0);
    }
}

// Requirement: compression relieves bending with `signed` (sigma = F/A + |M|R/I).
TEST(BondFailure, CompressionAddsToBendingStrength) {
  const double bending = kStrength.tensile * kPi * 0.795 * 0.795 * 0.795 / 4.0;
  const BondLoads loads = {{}, {0.0, 1.5 * bending, 0.0}, 0.0};
  EXPECT_TRUE(fails(loads, -0.49 * kTensileForce, kSection, kStrength, FailureCriterion::Signed));
  EXPECT_FALSE(fails(loads, -0.51 * kTensileForce, kSection, kStrength, FailureCriterion::Signed));
}

// Requirement: fails() without its square root decides as the stresses of eqs 6-7 do. Loads nearer
// to the limit than 1e-12 (round-off) are not decided here; 1e5 draws leave none out.
TEST(BondFailure, AgreesWithStresses) {
  RandomVectors random(1);
  int broken = 0;
  for (int n = 0; n < 100000; ++n) {
    const FailureCriterion c = kAll[n % 3];
    const BondSection section(random.number(0.1, 2.0));
    const double force = kStrength.tensile * section.area, moment = force * section.radius / 4.0;
    const BondLoads loads = {random.vector(0.5 * force), random.vector(0.8 * moment),
                             random.number(-moment, moment)};
    const double tension = random.number(-1.5 * force, force);
    const BondStress s = bond_stress(loads, tension, section, c);
    const double near = std::fmin(std::fabs(s.sigma() / kStrength.tensile - 1.0),
                                  std::fabs(s.tau() / kStrength.shear - 1.0));
    const bool expected = s.sigma() >= kStrength.tensile || s.tau() >= kStrength.shear;
    ASSERT_GT(near, 1e-12);
    ASSERT_EQ(fails(loads, tension, section, kStrength, c), expected) << "draw " << n;
    broken += expected;
  }
  EXPECT_GT(broken, 20000); // both answers are exercised
  EXPECT_LT(broken, 90000);
}

// Requirement: the mode of a break is the largest of the four shares.
TEST(BondFailure, ModeIsLargestShare) {
  const BondStrength s = {2.0, 1.0};
  EXPECT_EQ(break_mode({2.0, 0.1, 0.2, 0.2}, s), BreakMode::Tension);
  EXPECT_EQ(break_mode({-9.0, 2.0, 0.9, 0.2}, s), BreakMode::Bending);
  EXPECT_EQ(break_mode({-9.0, 1.0, 0.9, 0.2}, s), BreakMode::Shear);
  EXPECT_EQ(break_mode({0.5, 0.5, 0.2, 1.0}, s), BreakMode::Torsion);
  EXPECT_STREQ(name_of(BreakMode::Torsion), "torsion");
}
