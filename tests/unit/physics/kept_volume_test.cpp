// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/kept_volume.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {

constexpr double R = 0.658;

/// A sphere between `flats` equal flats that have come in to `distance`, updated to its end.
KeptVolume settled(int flats, double distance, int updates = 400) {
  KeptVolume sphere;
  for (int n = 0; n < updates; ++n) {
    const Cap cap(R + sphere.growth, distance);
    sphere.update(R, flats * cap.volume, flats * cap.area);
  }
  return sphere;
}

/// r/R at which z flats leave no surface free.
double full_at(int z) {
  const double t = 2.0 / z;
  return std::cbrt((1.0 - t) * (1.0 - t) / (1.0 - 0.5 * t));
}

} // namespace

// Requirement: between two flats the body is a barrel of the sphere's volume,
// 2 pi (R'^2 r - r^3/3) = 4/3 pi R^3. Newton ends at round-off: 8 ulp.
TEST(KeptVolume, BetweenTwoFlats) {
  for (double part : {1.0, 0.95, 0.8, 0.6, 0.4}) {
    const double r = part * R, R3 = R * R * R;
    const double grown = std::sqrt((2.0 / 3.0 * R3 + r * r * r / 3.0) / r);
    EXPECT_NEAR((R + settled(2, r).growth) / grown, 1.0, 2e-15) << part;
    EXPECT_FALSE(settled(2, r).full);
  }
}

// Requirement: the closed form of the depth at which a sphere is full, and its parts of the cells.
TEST(KeptVolume, FullInItsCell) {
  const double volume = 4.0 / 3.0 * kPi;
  EXPECT_NEAR(volume / (8.0 * std::pow(full_at(6), 3)), 0.982, 5e-4);
  EXPECT_NEAR(volume / (4.0 * std::sqrt(2.0) * std::pow(full_at(12), 3)), 0.977, 5e-4);
  for (int z : {4, 6, 8, 12}) {
    const double t = 2.0 / z, grown = full_at(z) / (1.0 - t); // R'/R there: h = R' t
    const Cap cap(grown, full_at(z));
    EXPECT_NEAR(z * cap.area / (4.0 * kPi * grown * grown), 1.0, 1e-14);
    EXPECT_NEAR((volume * grown * grown * grown - z * cap.volume) / volume, 1.0, 1e-14);
    EXPECT_FALSE(settled(z, 1.02 * full_at(z) * R).full) << z;
    EXPECT_TRUE(settled(z, full_at(z) * R).full) << z;
  }
}

// Requirement: what comes back leaves: a sphere whose flats have gone has its radius again.
TEST(KeptVolume, ShrinksWhenItsContactsOpen) {
  KeptVolume sphere = settled(6, 0.8 * R);
  EXPECT_TRUE(sphere.full);
  for (int n = 0; n < 400; ++n)
    sphere.update(R, 0.0, 0.0);
  EXPECT_FALSE(sphere.full);
  EXPECT_NEAR(sphere.growth / R, 0.0, 1e-15);
}

// Requirement: depths of flats displace what the lens of the overlap holds, pi R_eff d^2 over n
// spheres; to the next order of d/R, here 1e-3.
TEST(KeptVolume, FlatsDisplaceTheLens) {
  const double other = 0.795, R_eff = R * other / (R + other), d = 1e-3 * R;
  EXPECT_NEAR(Cap(R, R - flat_depth(d, R_eff, R, 1)).volume / (kPi * R_eff * d * d), 1.0, 1e-3);
  EXPECT_EQ(flat_depth(d, R, R, 1), d);
  EXPECT_NEAR(flat_depth(d, 0.5 * R, R, 2) / (0.5 * d), 1.0, 1e-15);
}
