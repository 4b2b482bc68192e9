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
  return CaseRun("in.body",
                 {{"Ey", "1e3"},
                  {"friction", "0"},
                  {"restitution", "1"},
                  {"ced", "0"},
                  {"dt", number(step)},
                  {"steps", std::to_string(steps)},
                  {"every", std::to_string(steps / 200)}},
                 1, shaken_cube());
}

struct Drift {
  double largest, rms;
};

// Energy relative to its first value, over 200 samples.
Drift drift(const CaseRun &run) {
  const std::vector<Row> rows = run.rows("curve.csv");
  EXPECT_GT(rows.size(), 190u) << run.why();
  double start = 0.0, squares = 0.0;
  Drift d = {0.0, 0.0};
  for (const Row &r : rows) {
    const double energy = r.at("kinetic") + r.at("rotational") + r.at("strain");
    start = start == 0.0 ? energy : start;
    d.largest = std::fmax(d.largest, std::fabs(energy / start - 1.0));
    squares += std::pow(energy / start - 1.0, 2);
  }
  d.rms = std::sqrt(squares / rows.size());
  return d;
}

} // namespace

TEST(VerificationCluster, EnergyErrorFallsWithTheSquareOfTheStep) {
  const double coarse = drift(shake(1e-5, 1600)).rms, fine = drift(shake(5e-6, 3200)).rms,
               finest = drift(shake(2.5e-6, 6400)).rms;
  std::printf("energy error (rms) at 1e-5, 5e-6, 2.5e-6 us: %.2e %.2e %.2e, ratios %.3f %.3f\n",
              coarse, fine, finest, coarse / fine, fine / finest);
  EXPECT_NEAR(coarse / fine, 4.0, 0.12);
  EXPECT_NEAR(fine / finest, 4.0, 0.06);
}

TEST(VerificationCluster, EnergyDoesNotDrift) {
  const Drift d = drift(shake(1e-5, 16000));
  std::printf("energy over 16000 steps: largest error %.2e\n", d.largest);
  EXPECT_LT(d.largest, 2.4e-3); // (omega dt / 2)^2 / 4, omega of the time-step bound
}

namespace {

// Spheres at the ends of arms from the first, spinning at 10 rad/us about an oblique axis, with
// inner motion; a million steps at 0.8 of the bound.
CaseRun long_spin(const std::vector<Vec3> &arms) {
  std::vector<BodySphere> all = {{{0, 0, 0}, 0.795, 1}};
  for (const Vec3 &a : arms)
    all.push_back({1.28 * a, 0.795, 1});
  Vec3 centre;
  for (const BodySphere &s : all)
    centre = centre + (1.0 / all.size()) * s.x;
  const Vec3 spin = {6.0, 4.8, 6.4};
  for (BodySphere &s : all) {
    s.v = cross(spin, s.x - centre);
    s.omega = spin;
  }
  const Vec3 part = {0.3, 0.2, -0.1}; // of the first two, in opposition: the centre stays
  all[0].v = all[0].v + part;
  all[1].v = all[1].v - part;
  all[0].omega = all[0].omega + part;
  return CaseRun("in.body",
                 {{"Ey", "1e3"},
                  {"friction", "0"},
                  {"restitution", "1"},
                  {"ced", "0"},
                  {"of_bound", "0.8"},
                  {"steps", "1000000"},
                  {"every", "1000"}},
                 1, files_of(all, {-4, -4, -4}, {4, 4, 4}));
}

} // namespace

TEST(VerificationCluster, SpinForAMillionSteps) {
  for (const std::vector<Vec3> &arms :
       {std::vector<Vec3>{{1, 0, 0}}, std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}}}) {
    const std::vector<Row> rows = long_spin(arms).rows("curve.csv");
    ASSERT_GT(rows.size(), 990u);
    const auto energy = [&](size_t n) {
      return (rows[n].at("kinetic") + rows[n].at("rotational") + rows[n].at("strain")) /
             (rows[0].at("kinetic") + rows[0].at("rotational") + rows[0].at("strain"));
    };
    double least = 1.0, most = 1.0, first = 0.0, last = 0.0;
    for (size_t n = 0; n < rows.size(); ++n) {
      least = std::fmin(least, energy(n));
      most = std::fmax(most, energy(n));
      first += n < 200 ? energy(n) / 200 : 0.0;
      last += n >= rows.size() - 200 ? energy(n) / 200 : 0.0;
    }
    std::printf("%zu spheres, %.0f us: E/E0 %.6f to %.6f, mean moves by %.1e\n", arms.size() + 1,
                rows.back().at("t"), least, most, last - first);
    EXPECT_LT(most - least, 0.05); // inner motion 3 % of the energy, swing s/(1 - s), s = 0.64
    EXPECT_LT(std::fabs(last - first), 4.0 * 0.5 * (most - least) / std::sqrt(200.0));
  }
}

TEST(VerificationCluster, MomentumIsConserved) {
  const int steps = 8000;
  const std::vector<Row> rows = shake(2e-5, steps).rows("curve.csv");
  ASSERT_GT(rows.size(), 190u);
  const double mass = 27 * kDensity * 4.0 / 3.0 * kPi * std::pow(0.795, 3);
  double worst = 0.0;
  for (const char *c : {"px", "py", "pz", "lx", "ly", "lz"}) // speeds 1 um/us, arms 1 um
    for (const Row &r : rows)
      worst = std::fmax(worst, std::fabs(r.at(c) - rows[0].at(c)) / mass);
  std::printf("momentum changes by %.1e of mass x speed\n", worst);
  EXPECT_LT(worst, steps * 2.2e-16); // one rounding per step
}
