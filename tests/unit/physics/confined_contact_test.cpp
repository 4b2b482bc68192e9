// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/confined_contact.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {

constexpr double E = 1.3e6, R_s = 0.658, K = 2e6, psi = 0.5; // CBD-like; kPa, um
const ContactSurfaces equal = {E, 0.5 * R_s, R_s}, wall = {E, R_s, R_s};

} // namespace

// Requirement: below x_b = 4 (1 - psi)/z of the section nothing but Hertz, to the bit; beyond,
// more.
TEST(ConfinedContact, HertzUntilTheSurfaceIsUsedUp) {
  for (const ContactSurfaces &s : {equal, wall}) {
    const ConfinedContact contact(s, {K, psi});
    const double x_b = s.R_eff * contact.begin() / (R_s * R_s);
    EXPECT_NEAR(1.0 - ConfinedContact::kContacts * x_b / 4.0, psi, 1e-15);
    for (double part : {-1.0, 0.0, 0.3, 0.999}) {
      const double d = part * contact.begin();
      EXPECT_EQ(contact.force(d), hertz_force(E, s.R_eff, d));
      EXPECT_EQ(contact.elastic_energy(d), hertz_energy(E, s.R_eff, d));
    }
    EXPECT_GT(contact.force(1.1 * contact.begin()), hertz_force(E, s.R_eff, 1.1 * contact.begin()));
  }
}

// Requirement: beyond it, the pressure of the source on the source's area, written as it is there:
// kappa A_con d_BULK/V times A_c, against a flat wall; two equal spheres are two such walls. 8 ulp.
TEST(ConfinedContact, TheBulkAnswersAsInTheSource) {
  const ConfinedContact on_wall(wall, {K, psi}), pair(equal, {K, psi});
  for (double times : {1.2, 2.0, 3.0}) {
    const double d = times * on_wall.begin(), area = kPi * R_s * d;
    const double volume = 4.0 / 3.0 * kPi * R_s * R_s * R_s;
    const double pressure = K * ConfinedContact::kContacts * area * (d - on_wall.begin()) / volume;
    const double bulk = on_wall.force(d) - hertz_force(E, R_s, d);
    EXPECT_NEAR(bulk / (pressure * area), 1.0, 1e-14);
    EXPECT_NEAR((pair.force(2 * d) - hertz_force(E, 0.5 * R_s, 2 * d)) / bulk, 1.0, 1e-14);
  }
}

// Requirement: the force is the slope of the stored energy, and `stiffness` that of the force.
// Central differences of step h = 1e-4 d: 1e-8 times at most 4, the force being d^4 at most.
TEST(ConfinedContact, ForceIsSlopeOfEnergy) {
  for (const ContactSurfaces &s : {equal, wall}) {
    const ConfinedContact contact(s, {K, psi});
    for (double times : {0.5, 1.1, 1.5, 3.0}) {
      const double d = times * contact.begin(), h = 1e-4 * d;
      const double slope =
          (contact.elastic_energy(d + h) - contact.elastic_energy(d - h)) / (2 * h);
      EXPECT_NEAR(slope / contact.force(d), 1.0, 4e-8);
      EXPECT_NEAR((contact.force(d + h) - contact.force(d - h)) / (2 * h) / contact.stiffness(d),
                  1.0, 4e-8);
    }
  }
}

// Requirement: the radius for the time step is that of the stiffness at the overlap under a force.
// The last step of Newton's method is below round-off.
TEST(ConfinedContact, StiffnessUnderAForce) {
  const ConfinedContact contact(equal, {K, psi});
  for (double times : {0.5, 1.5, 4.0}) {
    const double d = times * contact.begin();
    EXPECT_NEAR(2.0 * E * contact.radius_under(contact.force(d)) / contact.stiffness(d), 1.0,
                1e-12);
    EXPECT_GE(contact.stiffness_radius(d), contact.contact_radius(d));
  }
}
