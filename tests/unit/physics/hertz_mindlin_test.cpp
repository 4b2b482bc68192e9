// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/hertz_contact.h"
#include "physics/hertz_mindlin.h"
#include <cmath>
#include <gtest/gtest.h>

using namespace calendem;

namespace {
const ContactMaterial kMaterial = {1.1e8, 3.2e7, -0.5, 0.3};
const double kRadius = 0.795, kOverlap = 0.01, kMass = 2.4;
const double kContactRadius = std::sqrt(0.5 * kRadius * kOverlap);

ContactMotion moving(const Vec3 &v, const Vec3 &spin_i = {}, const Vec3 &spin_j = {}) {
  const double r = 2.0 * kRadius - kOverlap;
  return contact_motion({{r, 0, 0}, v, spin_i, spin_j, {1, 0, 0}, r}, kRadius, kRadius);
}
} // namespace

TEST(HertzMindlin, ElasticForceIsHertz) {
  const double force = hertz_mindlin_elastic(kMaterial.modulus, kContactRadius, kOverlap);
  EXPECT_NEAR(force, hertz_force(kMaterial.modulus, 0.5 * kRadius, kOverlap), 1e-13 * force);
}

// gamma = 2 zeta sqrt(k m) with k the contact's tangent stiffness and zeta = sqrt(5/6) |beta|.
TEST(HertzMindlin, DampingIsThatOfTheTangentStiffness) {
  const ContactResistance r = contact_resistance(kMaterial, kContactRadius, kMass);
  const double stiffness = hertz_stiffness(kMaterial.modulus, 0.5 * kRadius, kOverlap);
  const double damping = 2.0 * std::sqrt(5.0 / 6.0) * 0.5 * std::sqrt(stiffness * kMass);
  EXPECT_NEAR(r.normal_damping, damping, 1e-13 * damping);
  EXPECT_DOUBLE_EQ(r.tangential_stiffness, 8.0 * kMaterial.shear_modulus * kContactRadius);
}

TEST(HertzMindlin, RollingDoesNotSlideSpinningDoes) {
  const ContactMotion rolling = moving({0, 0, 0}, {0, 0, 1}, {0, 0, -1});
  EXPECT_EQ(0.0, norm(rolling.sliding_velocity));
  const ContactMotion spinning = moving({0, 0, 0}, {0, 0, 1}, {0, 0, 1});
  EXPECT_NEAR(spinning.sliding_velocity.y, -(2.0 * kRadius - kOverlap), 1e-14);
  EXPECT_EQ(-2.0, moving({-2, 0, 0}).normal_velocity);
}

TEST(HertzMindlin, SticksBelowTheLimitAndSlidesAtIt) {
  const ContactResistance r = contact_resistance(kMaterial, kContactRadius, kMass);
  const ContactMotion still = moving({});
  const double normal = 1000.0, limit = 0.3 * normal;
  Vec3 small = {0, 0.5 * limit / r.tangential_stiffness, 0};
  EXPECT_NEAR(friction_force(small, still, r, 0.3, normal).y, -0.5 * limit, 1e-12 * limit);
  EXPECT_DOUBLE_EQ(small.y, 0.5 * limit / r.tangential_stiffness);
  Vec3 large = {0, 3.0 * limit / r.tangential_stiffness, 0};
  EXPECT_NEAR(friction_force(large, still, r, 0.3, normal).y, -limit, 1e-12 * limit);
  EXPECT_NEAR(large.y, limit / r.tangential_stiffness, 1e-12 * large.y);
}

TEST(HertzMindlin, OnlyAStickingContactIsDampedAlongIt) {
  const ContactResistance r = contact_resistance(kMaterial, kContactRadius, kMass);
  const ContactMotion sliding = moving({0, 0.1, 0});
  Vec3 none = {};
  EXPECT_DOUBLE_EQ(friction_force(none, sliding, r, 0.3, 1e9).y, -r.tangential_damping * 0.1);
  Vec3 large = {0, 1.0, 0};
  EXPECT_NEAR(friction_force(large, sliding, r, 0.3, 1000.0).y, -300.0, 1e-10);
}

TEST(HertzMindlin, DisplacementStaysInTheContactPlane) {
  const Vec3 n = {0.6, 0.8, 0.0};
  const Vec3 s = slide({1.0, 0.0, 2.0}, moving({0.3, 0.1, 0.2}), n, 0.01);
  EXPECT_NEAR(dot(s, n), 0.0, 1e-15);
}

// Both copies of a pair follow the same bits.
TEST(HertzMindlin, ExchangingTheSpheresChangesSignsOnly) {
  const Vec3 d = {0.9, -0.7, 1.05}, v = {0.3, 0.2, -0.1}, w = {1.0, 2.0, 3.0}, u = {-0.5, 0.1, 4.0};
  const double r = norm(d);
  const ContactMotion a = contact_motion(pair_motion(d, r, v, w, u), kRadius, kRadius + 0.1);
  const ContactMotion b = contact_motion(pair_motion(-d, r, -v, u, w), kRadius + 0.1, kRadius);
  EXPECT_EQ(a.normal_velocity, b.normal_velocity);
  EXPECT_EQ(a.sliding_velocity.x, -b.sliding_velocity.x);
  EXPECT_EQ(a.sliding_velocity.y, -b.sliding_velocity.y);
  EXPECT_EQ(a.sliding_velocity.z, -b.sliding_velocity.z);
}
