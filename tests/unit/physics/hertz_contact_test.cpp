// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/hertz_contact.h"

#include <gtest/gtest.h>

#include "physics/sjkr_cohesion.h"

using namespace calendem;

// Requirement: effective modulus and radius. Equal materials halve E/(1-nu^2), a rigid flat partner
// leaves it; equal radii halve R.
TEST(HertzContact, EffectiveValues) {
  EXPECT_DOUBLE_EQ(effective_modulus(2e8, 0.3, 2e8, 0.3), 1e8 / 0.91);
  EXPECT_NEAR(effective_modulus(2e8, 0.3, 1e300, 0.3), 2e8 / 0.91, 1e-6); // 4 ulp
  EXPECT_DOUBLE_EQ(effective_radius(0.8, 0.8), 0.4);
  EXPECT_DOUBLE_EQ(effective_radius(1.0, 0.25), 0.2);
}

// Requirement: F = 4/3 E* sqrt(R*) delta^(3/2); hand value 4/3 * 3 * 2 * 8 for E* = 3, R* = 4,
// delta = 4. No force without overlap.
TEST(HertzContact, Force) {
  EXPECT_DOUBLE_EQ(hertz_force(3.0, 4.0, 4.0), 64.0);
  EXPECT_DOUBLE_EQ(hertz_overlap(3.0, 4.0, 64.0), 4.0);
  EXPECT_DOUBLE_EQ(hertz_stiffness(3.0, 4.0, 4.0), 24.0);
  EXPECT_EQ(hertz_force(3.0, 4.0, 0.0), 0.0);
  EXPECT_EQ(hertz_force(3.0, 4.0, -1.0), 0.0);
  EXPECT_EQ(hertz_stiffness(3.0, 4.0, -1.0), 0.0);
}

// Requirement: the stiffness is the force's slope. Central difference of step h: error h^2 F'''/6 =
// h^2 F' / (24 delta^2), so 1e-8/24 at h = 1e-4 delta, and round-off 1e-16/1e-4.
TEST(HertzContact, StiffnessIsSlope) {
  for (double delta : {1e-4, 1e-2, 0.3}) {
    const double h = 1e-4 * delta;
    const double slope =
        (hertz_force(1e8, 0.4, delta + h) - hertz_force(1e8, 0.4, delta - h)) / (2.0 * h);
    EXPECT_NEAR(slope / hertz_stiffness(1e8, 0.4, delta), 1.0, 1e-8 / 24 + 1e-11);
  }
}

// Requirement: the force is the energy's slope. Central difference of step h: error h^2 F''/6 =
// h^2 F / (8 delta^2), so 1e-8/8 at h = 1e-4 delta, and round-off 1e-16/1e-4.
TEST(HertzContact, ForceIsSlopeOfEnergy) {
  for (double delta : {1e-4, 1e-2, 0.3}) {
    const double h = 1e-4 * delta;
    const double slope =
        (hertz_energy(1e8, 0.4, delta + h) - hertz_energy(1e8, 0.4, delta - h)) / (2.0 * h);
    EXPECT_NEAR(slope / hertz_force(1e8, 0.4, delta), 1.0, 1e-8 / 8 + 1e-11);
  }
  EXPECT_EQ(hertz_energy(1e8, 0.4, 0.0), 0.0);
  EXPECT_EQ(hertz_energy(1e8, 0.4, -1.0), 0.0);
}

// Requirement: at the equilibrium overlap Hertz balances SJKR. The formula takes the lens area to
// first order in delta; the next order shifts the root by -delta/S (1 + D^2/(R_i R_j)), S and D sum
// and difference of the radii. The root of the full forces must show this shift to 1 % (terms of
// order delta^2, delta/S < 1e-3).
TEST(HertzContact, EquilibriumWithCohesion) {
  const double E = effective_modulus(2e8, 0.3, 2e8, 0.3);
  for (double Rj : {0.795, 0.4, 0.2}) {
    const double Ri = 0.795, S = Ri + Rj, D = Ri - Rj, R = effective_radius(Ri, Rj), ced = 6e5;
    double low = 1e-9, high = 0.1 * Rj;
    for (int n = 0; n < 200; ++n) {
      const double delta = 0.5 * (low + high);
      (hertz_force(E, R, delta) < sjkr_force(ced, S - delta, Ri, Rj) ? low : high) = delta;
    }
    const double formula = sjkr_equilibrium_overlap(ced, E, R);
    const double shift = -formula / S * (1.0 + D * D / (Ri * Rj));
    EXPECT_LT(formula / S, 1e-3);
    EXPECT_NEAR((low - formula) / formula, shift, 0.01 * std::fabs(shift));
  }
}
