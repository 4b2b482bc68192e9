// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

constexpr double kSide = 12.0, kSpacing = 1.28;

double wrapped(double x) { return x - kSide * std::floor(x / kSide); }

// Four cubes of 3^3 spheres: across a corner of the cell, across its x face, across its y face, and
// inside; all rest 0.125 um above the fixed lower face.
std::vector<BodySphere> bodies() {
  std::vector<BodySphere> all;
  const Vec3 centres[] = {{0, 0, 2.2}, {0, 6, 2.2}, {6, 0, 2.2}, {6, 6, 2.2}};
  for (int b = 0; b < 4; ++b)
    for (BodySphere s : cube(3, kSpacing, centres[b] - Vec3{kSpacing, kSpacing, kSpacing}, b + 1)) {
      s.x.x = wrapped(s.x.x);
      s.x.y = wrapped(s.x.y);
      all.push_back(s);
    }
  return all;
}

} // namespace

TEST(VerificationRest, FreshBodiesStayWhereTheyAreOnOneAndTwoRanks) {
  const double strength_force = 2e5 * kPi * 0.795 * 0.795;
  for (int ranks : {1, 2}) {
    const CaseRun run("rest/in.rest", {{"dt", "7e-5"}}, ranks,
                      files_of(bodies(), {0, 0, 0}, {kSide, kSide, 9}));
    ASSERT_TRUE(run.finished()) << run.why();
    const std::vector<Row> rows = run.rows("curve.csv");
    ASSERT_EQ(rows.size(), 10u);
    double force = 0.0;
    for (const Row &r : rows) {
      EXPECT_EQ(r.at("made"), 4 * 54); // 3 x 3 x 2 in each of three directions
      EXPECT_EQ(r.at("intact"), 4 * 54);
      force = std::fmax(force, std::sqrt(r.at("force2")) / strength_force);
    }
    std::printf("%d ranks: largest force %.1e of the bond's strength, kinetic energy %.1e fJ\n",
                ranks, force, rows.back().at("kinetic"));
    EXPECT_LT(force, 1e-6);
    EXPECT_LT(rows.back().at("kinetic"), 1e-6 * strength_force * 1.28e-9);
    EXPECT_TRUE(run.rows("breaks.csv").empty());
  }
}
