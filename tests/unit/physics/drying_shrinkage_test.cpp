// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/drying_shrinkage.h"
#include "physics/parallel_bond.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {

const BondMaterial kBinder = {1e6, 1e6 / 2.6, 0.5};
const BondSection kSection(0.329);
constexpr double kLength = 1.32;

double tension(double rest, double r) {
  BondMaterial m = kBinder;
  m.rest = rest;
  return bond_tension(m, BondStiffness(m, kSection, kLength), r, kLength);
}

} // namespace

// Requirement: evenly to the strain given, in the time given, whatever the step; no further.
TEST(DryingShrinkage, GrowsEvenlyAndEnds) {
  const DryingShrinkage law = {0.004, 0.5};
  for (const double dt : {1e-4, 3e-2, 0.7}) {
    double s = 0.0;
    for (double t = dt; t < 1.0; t += dt) {
      s = law.later(s, dt);
      EXPECT_NEAR(law.rest(s), 1.0 - 0.004 * std::fmin(1.0, t / 0.5), 1e-12) << dt;
    }
    EXPECT_EQ(law.later(1.0, dt), 1.0);
  }
  EXPECT_EQ(law.rest(1.0), 1.0 - 0.004);
}

TEST(DryingShrinkage, AtOnceInNoTime) {
  const DryingShrinkage law = {0.004, 0.0};
  EXPECT_EQ(law.later(0.0, 0.0), 1.0);
}

// A bond that has not shrunk: the same bits as E A (r - l)/l.
TEST(DryingShrinkage, NoneLeavesABondAsItIs) {
  const double k = BondStiffness(kBinder, kSection, kLength).normal;
  for (const double r : {1.3, 1.32, 1.3217})
    EXPECT_EQ(tension(DryingShrinkage().rest(1.0), r), k * (r - kLength));
}

// Requirement: F = E A eps at the length of creation, none at (1 - eps) of it.
TEST(DryingShrinkage, TensionOfAHeldBridge) {
  const DryingShrinkage law = {0.004, 1.0};
  const double most = kBinder.youngs_modulus * kSection.area * 0.004;
  for (const double s : {0.0, 0.3, 1.0})
    EXPECT_NEAR(tension(law.rest(s), kLength), s * most, 1e-12 * most);
  EXPECT_NEAR(tension(law.rest(1.0), 0.996 * kLength), 0.0, 1e-12 * most);
}

// Requirement: work of moving the ends and of shrinking, with means over a step = change of energy.
TEST(DryingShrinkage, EnergyOfAStepIsExact) {
  const double k = BondStiffness(kBinder, kSection, kLength).normal;
  const double r[] = {1.32, 1.3207}, rest[] = {0.999, 0.9972};
  const double before = tension(rest[0], r[0]), after = tension(rest[1], r[1]);
  const double work = 0.5 * (before + after) * (r[1] - r[0] + kLength * (rest[0] - rest[1]));
  EXPECT_NEAR(work, 0.5 * (after * after - before * before) / k, 1e-12 * work);
}
