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
  return CaseRun("cluster/in.cluster",
                 {{"friction", "0"},
                  {"ced", "0"},
                  {"damping", "0.1"},
                  {"dt", number(step)},
                  {"steps", std::to_string(steps)},
                  {"every", std::to_string(steps / 40)}},
                 1, files_of(all, {-20, -20, -20}, {20, 20, 20}));
}

// Strain energy of a turn's end in the second and in the last turn.
void settled(const CaseRun &run, double &early, double &late) {
  const std::vector<Row> rows = run.rows("curve.csv");
  ASSERT_GT(rows.size(), 38u) << run.why();
  early = rows[6].at("strain");
  late = rows.back().at("strain");
}

} // namespace

TEST(VerificationRotation, UnequalPair) {
  for (const Vec3 &axis : {Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
    const std::vector<BodySphere> pair = {{{0, 0, 0}, 0.795, 1}, {{1.0, 0, 0}, 0.5, 1}};
    double early = 0.0, late = 0.0;
    settled(spin(pair, axis, 8e-5), early, late);
    std::printf("pair: strain energy %.6g fJ in turn 2, %.6g fJ in turn 10\n", early, late);
    EXPECT_NEAR(late, early, 1e-3 * early + 1e-12);
  }
}

TEST(VerificationRotation, BodyAboutAnyAxis) {
  for (const Vec3 &axis : {Vec3{0, 0, 1}, Vec3{1, 1, 1}, Vec3{1, 2, 3}}) {
    double early = 0.0, late = 0.0;
    settled(spin(cube(2, 1.28, {}, 1), axis, 8e-5), early, late);
    std::printf("cube: strain energy %.6g fJ in turn 2, %.6g fJ in turn 10\n", early, late);
    EXPECT_NEAR(late, early, 1e-2 * early);
  }
}
