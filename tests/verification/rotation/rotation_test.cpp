// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

// Ten turns at 10 rad/us of a body set in rigid rotation about `axis` through its centre of mass.
CaseRun spin(std::vector<BodySphere> all, const Vec3 &axis, double step) {
  Vec3 centre;
  double mass = 0.0;
  for (const BodySphere &s : all) {
    const double m = s.radius * s.radius * s.radius;
    centre = centre + m * s.x;
    mass += m;
  }
  for (BodySphere &s : all) {
    s.omega = (10.0 / norm(axis)) * axis;
    s.v = cross(s.omega, s.x - (1.0 / mass) * centre);
  }
  const int steps = static_cast<int>(2.0 * kPi / step);
  return CaseRun("in.body",
                 {{"friction", "0"},
                  {"ced", "0"},
                  {"damping", "0.1"},
                  {"dt", number(step)},
                  {"steps", std::to_string(steps)},
                  {"every", std::to_string(steps / 40)}},
                 1, files_of(all, {-20, -20, -20}, {20, 20, 20}));
}

constexpr double kSpeed = 10.0, kModulus = 2e8, kStrength = 2e5; // rad/us, kPa, kPa

// Strain energy after one turn and after ten.
void settled(const CaseRun &run, double &early, double &late) {
  const std::vector<Row> rows = run.rows("curve.csv");
  ASSERT_GT(rows.size(), 38u) << run.why();
  early = rows[4].at("strain");
  late = rows.back().at("strain");
}

double mass_of(double radius) { return kDensity * 4.0 / 3.0 * kPi * std::pow(radius, 3); }

// Force that the bond carries after ten turns beyond the centripetal one, as a part of its
// strength.
double spurious(double R_i, double R_j, double length, const Vec3 &axis) {
  const std::vector<BodySphere> pair = {{{0, 0, 0}, R_i, 1}, {{length, 0, 0}, R_j, 1}};
  double early = 0.0, late = 0.0;
  settled(spin(pair, axis, 8e-5), early, late);
  const BondSection section(std::fmin(R_i, R_j));
  const double k = kModulus * section.area / length;
  const double m = mass_of(R_i) * mass_of(R_j) / (mass_of(R_i) + mass_of(R_j));
  const double across = 1.0 - axis.x * axis.x / norm_squared(axis); // sin^2 to the axis
  const double centripetal = m * length * kSpeed * kSpeed * across;
  return std::fabs(std::sqrt(2.0 * k * late) - centripetal) / (kStrength * section.area);
}

} // namespace

TEST(VerificationRotation, PairAboutAxesAlongAndAcrossIt) {
  const double radii[][3] = {{0.795, 0.795, 1.28}, {0.795, 0.5, 1.0}, {0.795, 0.795, 1.59 * 1.0}};
  for (const auto &p : radii)
    for (const Vec3 &axis : {Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
      const double e = spurious(p[0], p[1], p[2], axis);
      std::printf("pair %g %g at %g: force beyond the centripetal %.1e of the strength\n", p[0],
                  p[1], p[2], e);
      EXPECT_LT(e, 1e-6);
    }
}

TEST(VerificationRotation, BodyAboutAnyAxis) {
  for (const Vec3 &axis : {Vec3{0, 0, 1}, Vec3{1, 1, 1}, Vec3{1, 2, 3}}) {
    double early = 0.0, late = 0.0;
    settled(spin(cube(2, 1.28, {}, 1), axis, 8e-5), early, late);
    const BondSection section(0.795);
    const double k = kModulus * section.area / 1.28;
    const double change =
        (std::sqrt(2.0 * k * late) - std::sqrt(2.0 * k * early)) / (kStrength * section.area);
    std::printf(
        "cube: strain energy %.6g fJ after 1 turn, %.6g fJ after 10: %.1e of the strength\n", early,
        late, change);
    EXPECT_LT(std::fabs(change), 1e-6);
  }
}
