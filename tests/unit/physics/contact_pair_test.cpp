// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/contact_pair.h"
#include "random_vector.h"
#include <gtest/gtest.h>

using namespace calendem;

namespace {
const ContactMaterial kMaterial = {1.1e8, 3.2e7, -0.5, 0.3};
constexpr double kLarge = 0.8, kSmall = 0.5, kOverlap = 0.02, kElastic = 5e4, kMass = 1.5;
constexpr double kArea = 0.07; // radius of the contact's area
constexpr double kDistance = kLarge + kSmall - kOverlap;

struct Case {
  PairMotion motion;
  ContactResistance resistance = contact_resistance(kMaterial, kArea, kMass);

  explicit Case(unsigned seed, double speed = 1.0) {
    RandomVectors random(seed);
    const Vec3 n = random.unit();
    motion = pair_motion(kDistance * n, kDistance, random.vector(speed), random.vector(speed),
                         random.vector(speed));
  }
  ContactPair pair(bool rests = false, bool slides = true) const {
    return {motion, kLarge, kSmall, rests, slides};
  }
};
} // namespace

// Requirement: the moments of friction about both centres and its couple cancel: the pair keeps its
// angular momentum, (x_i - x_j) x F + T_i + T_j = 0. 1e-13 of F r, a few ulp.
TEST(ContactPair, KeepsAngularMomentum) {
  for (unsigned seed = 1; seed < 20; ++seed) {
    const Case c(seed);
    Vec3 displacement = {};
    const ContactAction a =
        contact_action(c.pair(), kMaterial, c.resistance, kElastic, true, displacement);
    const Vec3 moment = cross(c.motion.d, a.friction) + a.torque_i + a.torque_j;
    EXPECT_LT(norm(moment), 1e-13 * norm(a.friction) * kDistance) << seed;
    EXPECT_GT(norm(a.friction), 0.0);
  }
}

// Requirement: damping never adds energy, neither along the normal nor, while the contact sticks,
// along the sliding. The elastic force is not part of it.
TEST(ContactPair, DampingTakesEnergy) {
  for (unsigned seed = 1; seed < 20; ++seed) {
    const Case c(seed, 1e-3);
    Vec3 displacement = {};
    const ContactPair pair = c.pair();
    const ContactAction a =
        contact_action(pair, kMaterial, c.resistance, kElastic, true, displacement);
    EXPECT_LE(a.damping * pair.motion.normal_velocity, 0.0);
    EXPECT_LT(dot(a.friction, pair.motion.sliding_velocity), 0.0);
    EXPECT_EQ(a.normal, a.damping + kElastic);
  }
}

// Requirement: a contact slips at the friction times the whole normal force, damping included. 4 ulp.
TEST(ContactPair, SlipsAtTheWholeNormalForce) {
  const Case c(2);
  Vec3 displacement = {0.1, -0.2, 0.3}; // far beyond what friction holds
  const ContactAction a =
      contact_action(c.pair(), kMaterial, c.resistance, kElastic, true, displacement);
  EXPECT_GT(std::fabs(a.damping), 1e-3 * kElastic);
  EXPECT_NEAR(norm(a.friction) / (kMaterial.friction * a.normal), 1.0, 1e-15);
}

// Requirement: a contact at rest has no damping, one that its law has opened does not slide, one
// that does not act has no friction; the others are not touched.
TEST(ContactPair, RestsOpensAndActs) {
  const Case c(3);
  const ContactMotion moves = contact_motion(c.motion, kLarge, kSmall);
  EXPECT_EQ(c.pair(true, true).motion.normal_velocity, 0.0);
  EXPECT_EQ(norm(c.pair(true, true).motion.sliding_velocity - moves.sliding_velocity), 0.0);
  EXPECT_EQ(norm(c.pair(false, false).motion.sliding_velocity), 0.0);
  EXPECT_EQ(c.pair(false, false).motion.normal_velocity, moves.normal_velocity);
  Vec3 displacement = {};
  const ContactAction none =
      contact_action(c.pair(), kMaterial, c.resistance, kElastic, false, displacement);
  EXPECT_EQ(norm(none.friction) + norm(none.torque_i) + norm(none.torque_j), 0.0);
}

// Requirement: the same from the other sphere: exchanged, forces turn round and torques change
// places. 4 ulp of the sums of the arms.
TEST(ContactPair, IsTheSameFromTheOtherSphere) {
  const Case c(5);
  const PairMotion &m = c.motion;
  const PairMotion other = {-m.d, -m.v, m.spin_j, m.spin_i, -m.n, m.r};
  Vec3 here = {}, there = {};
  const ContactAction a = contact_action(c.pair(), kMaterial, c.resistance, kElastic, true, here);
  const ContactAction b = contact_action({other, kSmall, kLarge, false, true}, kMaterial,
                                         c.resistance, kElastic, true, there);
  EXPECT_NEAR(b.normal / a.normal, 1.0, 1e-15);
  EXPECT_LT(norm(a.friction + b.friction), 1e-15 * norm(a.friction));
  EXPECT_LT(norm(a.torque_i - b.torque_j), 1e-15 * norm(a.torque_i));
}

// Requirement: Hertz' area with the effective radius gives Hertz' force.
TEST(ContactPair, HertzAreaGivesHertzForce) {
  const double R = effective_radius(kLarge, kSmall), a = hertz_contact_radius(R, kOverlap);
  EXPECT_NEAR(hertz_mindlin_elastic(kMaterial.modulus, a, kOverlap) /
                  hertz_force(kMaterial.modulus, R, kOverlap),
              1.0, 1e-15);
}

// Requirement: on either side of a wall the contact point lies in the middle of the overlap, and the
// wall pushes away from itself.
TEST(ContactPair, AWallTouchesFromEitherSide) {
  for (const double side : {1.0, -1.0}) {
    const WallContact at(side * 0.7, kLarge);
    EXPECT_EQ(at.side, side);
    EXPECT_NEAR(at.overlap, 0.1, 1e-15);
    EXPECT_NEAR(at.arm.z, -side * 0.75, 1e-15);
  }
  EXPECT_LT(WallContact(1.0, kLarge).overlap, 0.0);
}
