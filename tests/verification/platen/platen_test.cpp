// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, nu = 0.3, R = 0.795, kSide = 6.0;
constexpr int kSpheres = 5;
const double E_eff = effective_modulus(E, nu, E, nu), kArea = kSide * kSide;

CaseRun press(Settings settings) {
  std::vector<BodySphere> column;
  for (int n = 0; n < kSpheres; ++n)
    column.push_back({{3, 3, R * (2 * n + 1)}, R, n + 1});
  settings.insert({{"friction", "0"}, {"ced", "0"}, {"dt", "1e-4"}});
  settings["top"] = number(2 * R * kSpheres);
  return CaseRun("platen/in.column", settings, 1, files_of(column, {0, 0, 0}, {kSide, kSide, 9}));
}

// Shortening of the column, and the energy in its contacts, under the force F: four contacts of two
// spheres in series with two of a sphere and a wall. delta = (F / (4/3 E* sqrt(R*)))^(2/3), U = 2/5
// F delta.
double shortening(double F) {
  const auto overlap = [&](double R_eff) {
    return std::pow(F / (4.0 / 3.0 * E_eff * std::sqrt(R_eff)), 2.0 / 3.0);
  };
  return (kSpheres - 1) * overlap(0.5 * R) + 2 * overlap(R);
}
double stored(double F) { return 0.4 * F * shortening(F); }

const Row &turning_point(const std::vector<Row> &rows) {
  size_t lowest = 0;
  for (size_t i = 0; i < rows.size(); ++i)
    if (rows[i].at("height") < rows[lowest].at("height"))
      lowest = i;
  return rows[lowest];
}

} // namespace

TEST(VerificationPlaten, ElasticColumn) {
  const double top = 2 * R * kSpheres, target = top - 0.05;
  const CaseRun run = press({{"motion", "position"}, {"target", number(target)}, {"dwell", "1"}});
  ASSERT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  double worst = 0.0, momentum = 0.0, largest = 0.0;
  for (const Row &r : rows) {
    largest = std::fmax(largest, r.at("load"));
    momentum = std::fmax(momentum, std::fabs(r.at("bottom") - r.at("load") - r.at("force")));
    if (r.at("load") > 1000.0) {
      const double expected = top - shortening(0.5 * (r.at("load") + r.at("bottom")));
      worst = std::fmax(worst, std::fabs(r.at("height") - expected) / 0.05);
    }
  }
  const Row &deepest = turning_point(rows);
  std::printf("column: height within %.1e of the path pressed, collector - platen = force on all "
              "spheres to %.1e of the load, work / energy at rest %.5f\n",
              worst, momentum / largest, deepest.at("work") / stored(deepest.at("load")));
  EXPECT_DOUBLE_EQ(deepest.at("height"), target);
  EXPECT_LT(worst, 5e-3);
  EXPECT_LT(momentum, 1e-12 * largest);
  EXPECT_NEAR(deepest.at("work") / stored(deepest.at("load")), 1.0, 5e-3);
  EXPECT_LT(std::fabs(rows.back().at("work")), 5e-3 * deepest.at("work")); // given back
  EXPECT_EQ(rows.back().at("stage"), 4);
  EXPECT_LT(rows.back().at("load"), 0.02 * largest);
}

TEST(VerificationPlaten, PressureIsMetAndContactLost) {
  const double pressure = 500.0; // kPa
  const CaseRun run = press({{"motion", "pressure"}, {"target", number(pressure)}});
  ASSERT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  double highest = 0.0;
  for (const Row &r : rows)
    highest = std::fmax(highest, r.at("average"));
  const double expected = 2 * R * kSpheres - shortening(pressure * kArea);
  const double height = turning_point(rows).at("height");
  std::printf("pressure: %.4f of the target, turned %.2e um from the column's closed form\n",
              highest / pressure, height - expected);
  EXPECT_GE(highest, pressure);
  EXPECT_LT(highest, 1.01 * pressure);
  // the height belongs to a pressure 1 % above at most: 2/3 of 1 % of the shortening
  EXPECT_NEAR(height, expected, 0.01 * 2.0 / 3.0 * shortening(pressure * kArea));
  EXPECT_EQ(rows.back().at("stage"), 4);
  EXPECT_LT(rows.back().at("average"), 0.011 * pressure);
}
