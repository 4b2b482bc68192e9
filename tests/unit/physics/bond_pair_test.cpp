// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/bond_pair.h"
#include "random_vector.h"
#include <gtest/gtest.h>

using namespace calendem;

namespace {
const BondMaterial kMaterial = {2e8, 8e7, 0.6, 0.1, 0.99};
constexpr double kLarge = 0.8, kSmall = 0.5, kLength = 1.2;

BondPair stretched(double by, double radius_i = kLarge, double radius_j = kSmall) {
  return {kMaterial, radius_i, radius_j, kLength, pair_at_rest({0.0, 0.0, (1.0 + by) * kLength})};
}
} // namespace

// Requirement: the section is lambda times that of the smaller sphere, stiffness that of the length
// at creation, tension from the rest length: F_n = k_n (r - rest l), with k_n = E pi R^2/l. 4 ulp.
TEST(BondPair, SectionStiffnessAndTensionAreThoseOfTheSmallerSphere) {
  for (const BondPair &pair : {stretched(0.01), stretched(0.01, kSmall, kLarge)}) {
    const double R = kMaterial.radius_ratio * kSmall;
    const double k = kMaterial.youngs_modulus * kPi * R * R / kLength;
    EXPECT_DOUBLE_EQ(pair.section.radius, R);
    EXPECT_NEAR(pair.stiffness.normal / k, 1.0, 1e-15);
    EXPECT_NEAR(pair.tension / (k * 0.02 * kLength), 1.0, 1e-13); // 1.01 - 0.99 loses two digits
  }
}

// Requirement: the pair's functions are those of the two laws with its own section, stiffness and
// tension, to the bit.
TEST(BondPair, AsksTheLaws) {
  RandomVectors random(7);
  const PairMotion motion = pair_motion({0.1, -0.2, 1.19}, norm({0.1, -0.2, 1.19}),
                                        random.vector(1.0), random.vector(1.0), random.vector(1.0));
  const BondPair pair(kMaterial, kLarge, kSmall, kLength, motion);
  BondLoads loads = {random.vector(1.0), random.vector(1.0), 3.0}, by_law = loads;
  pair.advance(loads, 1e-4);
  advance(by_law, motion, pair.stiffness, 1e-4);
  EXPECT_EQ(norm(loads.shear - by_law.shear), 0.0);
  const BondDamping damping = pair.damping(kMaterial, kLarge, kSmall, 2.0);
  const BondDamping of_law(kMaterial, pair.section, pair.stiffness, 2.0, kSmall);
  EXPECT_EQ(damping.normal, of_law.normal);
  EXPECT_EQ(damping.twist, of_law.twist);
  EXPECT_EQ(norm(pair.action(loads, damping).torque_j -
                 action(loads, pair.tension, motion, damping).torque_j),
            0.0);
  EXPECT_EQ(norm(pair.action(loads).force - action(loads, pair.tension, motion, {}).force), 0.0);
  EXPECT_EQ(norm(pair.damping_action(damping).torque_i - damping_action(motion, damping).torque_i),
            0.0);
  EXPECT_EQ(pair.strain_energy(loads), strain_energy(loads, pair.tension, pair.stiffness));
}

// Requirement: pure tension breaks a bond at sigma_c A, by the same tension that its stress and its
// action show.
TEST(BondPair, FailsWhereItsStressReachesItsStrength) {
  const double sigma = stretched(0.01).stress({}, FailureCriterion::Signed).sigma();
  EXPECT_NEAR(stretched(0.01).action({}).force.z, -sigma * stretched(0.01).section.area,
              1e-15 * sigma);
  for (const double times : {0.999, 1.001})
    EXPECT_EQ(stretched(0.01).fails({}, {sigma / times, HUGE_VAL}, FailureCriterion::Signed),
              times > 1.0);
}

// Requirement: the force is the slope of the strain energy, for bonds whose rest length has changed
// too. The energy is a parabola: central differences are exact but for round-off, 1e-16/1e-5.
TEST(BondPair, ForceIsSlopeOfEnergy) {
  constexpr double h = 1e-5;
  const double slope =
      (stretched(0.01 + h).strain_energy({}) - stretched(0.01 - h).strain_energy({})) /
      (2.0 * h * kLength);
  EXPECT_NEAR(slope / stretched(0.01).tension, 1.0, 1e-10);
}

// Requirement: two spheres that move against each other have the mass m_i m_j/(m_i + m_j).
TEST(PairMotion, EffectiveMassIsThatOfTwoBodies) {
  EXPECT_DOUBLE_EQ(effective_mass(3.0, 6.0), 2.0);
  const PairMotion at_rest = pair_at_rest({0.0, -2.0, 0.0});
  EXPECT_EQ(at_rest.r, 2.0);
  EXPECT_EQ(at_rest.n.y, -1.0);
}

TEST(PairMotion, KeepsTheOrderOfItsSpheres) {
  const PairMotion m = pair_motion({0.0, 0.0, 2.0}, 2.0, {1.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, {});
  EXPECT_EQ(m.v.x, 1.0);
  EXPECT_EQ(m.spin_i.y, 3.0);
  EXPECT_EQ(norm(m.spin_j), 0.0);
}
