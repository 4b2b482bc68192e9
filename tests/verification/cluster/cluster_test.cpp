// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

// Reproducible numbers in (-1, 1).
double noise(int n) {
  const double x = std::sin(12.9898 * n + 4.1) * 43758.5453;
  return 2.0 * (x - std::floor(x)) - 1.0;
}

Files shaken_cube() {
  std::vector<BodySphere> all = cube(3, 1.28, {-1.28, -1.28, -1.28}, 1);
  int n = 0;
  for (BodySphere &s : all) {
    s.v = {noise(++n), noise(++n), noise(++n)};
    s.omega = {noise(++n), noise(++n), noise(++n)};
  }
  return files_of(all, {-20, -20, -20}, {20, 20, 20});
}

CaseRun shake(double step, int steps) {
  // contacts nearly without stiffness: their energy is not in the ledger
  return CaseRun("cluster/in.cluster",
                 {{"Ey", "1e3"},
                  {"friction", "0"},
                  {"restitution", "1"},
                  {"ced", "0"},
                  {"dt", number(step)},
                  {"steps", std::to_string(steps)},
                  {"every", std::to_string(steps / 200)}},
                 1, shaken_cube());
}

double drift(const CaseRun &run) {
  const std::vector<Row> rows = run.rows("curve.csv");
  double start = 0.0, worst = 0.0;
  for (const Row &r : rows) {
    const double energy = r.at("kinetic") + r.at("rotational") + r.at("strain");
    if (start == 0.0)
      start = energy;
    worst = std::fmax(worst, std::fabs(energy / start - 1.0));
  }
  EXPECT_GT(rows.size(), 190u) << run.why();
  return worst;
}

} // namespace

TEST(VerificationCluster, EnergyIsConserved) {
  const double coarse = drift(shake(1e-5, 16000)), fine = drift(shake(5e-6, 32000)),
               finest = drift(shake(2.5e-6, 64000));
  std::printf("largest energy error at 1e-5, 5e-6, 2.5e-6 us: %.2e %.2e %.2e, ratios %.2f %.2f\n",
              coarse, fine, finest, coarse / fine, fine / finest);
  EXPECT_LT(coarse, 1e-2);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
  EXPECT_NEAR(fine / finest, 4.0, 0.4);
}

TEST(VerificationCluster, MomentumIsConserved) {
  const std::vector<Row> rows = shake(2e-5, 8000).rows("curve.csv");
  ASSERT_GT(rows.size(), 190u);
  const double mass = 27 * kDensity * 4.0 / 3.0 * kPi * std::pow(0.795, 3);
  double worst = 0.0;
  for (const char *c : {"px", "py", "pz", "lx", "ly", "lz"}) // speeds 1 um/us, arms 1 um
    for (const Row &r : rows)
      worst = std::fmax(worst, std::fabs(r.at(c) - rows[0].at(c)) / mass);
  std::printf("momentum changes by %.1e of mass x speed\n", worst);
  EXPECT_LT(worst, 1e-9);
}
