// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

// Energy at the end over energy at the start; infinite when the run stopped on a torn bond, or on a
// force beyond all measure.
double growth(double of_bound, double damping) {
  std::vector<BodySphere> all = cube(3, 1.28, {-1.28, -1.28, -1.28}, 1);
  all[0].v = {1e-3, -2e-3, 3e-3}; // small: the body stays linear
  all[0].omega = {2e-3, 1e-3, -1e-3};
  const CaseRun run("in.body",
                    {{"Ey", "1e3"},
                     {"friction", "0"},
                     {"restitution", "1"},
                     {"ced", "0"},
                     {"of_bound", number(of_bound)},
                     {"damping", number(damping)},
                     {"steps", "5000"},
                     {"every", "50"}},
                    1, files_of(all, {-20, -20, -20}, {20, 20, 20}));
  if (!run.finished()) {
    const std::string why = run.why(); // in one step or in several
    EXPECT_TRUE(why.find("an intact bond is stretched") != std::string::npos ||
                why.find("a bond was stretched within one step") != std::string::npos ||
                why.find("more than the units of its sum hold") != std::string::npos)
        << why;
    return HUGE_VAL;
  }
  const std::vector<Row> rows = run.rows("curve.csv");
  const auto energy = [](const Row &r) {
    return r.at("kinetic") + r.at("rotational") + r.at("strain");
  };
  const double ratio = rows.size() < 2 ? HUGE_VAL : energy(rows.back()) / energy(rows.front());
  std::printf("damping %g, %.2f of the bound (%.4g us): energy x %.3g\n", damping, of_bound,
              rows.empty() ? 0.0 : rows[0].at("bound"), ratio);
  return std::isfinite(ratio) ? ratio : HUGE_VAL;
}

} // namespace

TEST(VerificationTimestep, StableAtTheBound) {
  EXPECT_LT(growth(1.0, 0.0), 2.0);
  EXPECT_LT(growth(1.0, 0.1), 1.0);
}

// Soft bonds: the contacts that the platen makes bear the load and set the step.
TEST(VerificationTimestep, ContactsOfSoftBondsUnderThePlaten) {
  const double side = 4.2, pressure = 1e5, speed = 0.5; // um, kPa, um/us
  const double top = 2.0 * 1.28 + 2.0 * 0.795 + 2e-4;
  for (const char *modulus : {"2e6", "2e7", "6e7"}) {
    Files files = files_of(cube(3, 1.28, {0.8, 0.8, 0.795 + 1e-4}, 1), {0, 0, 0}, {side, side, 6});
    std::ostringstream start;
    for (const auto &[name, value] : Settings{{"motion", "pressure"},
                                              {"aim", number(pressure)},
                                              {"top", number(top)},
                                              {"speed", number(speed)},
                                              {"window", "0.01"},
                                              {"dwell", "2"},
                                              {"ramp", "0.5"},
                                              {"lost_at", "0.01"}})
      start << "variable " << name << " index " << value << "\n";
    files["start.in"] += start.str() + "include ${cases}/platen/in.platen\n";
    const CaseRun run("in.body",
                      {{"Eb", modulus},
                       {"ced", "0"},
                       {"of_bound", "0.8"},
                       {"pressure", number(pressure)},
                       {"damping", "0.02"},
                       {"bx", "p"},
                       {"by", "p"},
                       {"skin", "0.15"},
                       {"steps", "40000"},
                       {"every", "100"}},
                      1, files);
    ASSERT_TRUE(run.finished()) << "bonds of " << modulus << " kPa: " << run.why();
    double kinetic = 0.0, largest = 0.0;
    for (const Row &r : run.rows("platen.csv"))
      largest = std::fmax(largest, r.at("largest"));
    for (const Row &r : run.rows("curve.csv"))
      kinetic = std::fmax(kinetic, r.at("kinetic") + r.at("rotational"));
    std::printf("bonds of %s kPa: step %.3g us, pressure %.4g kPa, kinetic energy %.3g fJ\n",
                modulus, 0.8 * run.rows("curve.csv")[0].at("bound"), largest, kinetic);
    EXPECT_GE(largest, pressure);
    // no more than if all spheres moved as the platen does
    EXPECT_LT(kinetic, 0.5 * 27 * kDensity * 4.0 / 3.0 * kPi * std::pow(0.795, 3) * speed * speed);
  }
}

namespace {
// Energy at the end over that at the start of a pair along [111] with thin bonds.
double growth_of_pair(double of_bound, double radius_ratio, std::string *why = nullptr) {
  const double along = 1.55 / std::sqrt(3.0);
  const Vec3 v = {1e-3, -2e-3, 3e-3}, spin = {2e-3, 1e-3, -1e-3};
  const CaseRun run("in.body",
                    {{"Ey", "1e3"},
                     {"friction", "0"},
                     {"restitution", "1"},
                     {"ced", "0"},
                     {"lambda", number(radius_ratio)},
                     {"of_bound", number(of_bound)},
                     {"steps", "100000"},
                     {"every", "1000"}},
                    1,
                    files_of({{{0, 0, 0}, 0.795, 1, v, spin}, {{along, along, along}, 0.795, 1}},
                             {-20, -20, -20}, {20, 20, 20}));
  if (why)
    *why = run.why();
  if (!run.finished())
    return HUGE_VAL;
  const auto energy = [](const Row &r) {
    return r.at("kinetic") + r.at("rotational") + r.at("strain");
  };
  const std::vector<Row> rows = run.rows("curve.csv");
  double largest = 0.0;
  for (const Row &r : rows)
    largest = std::fmax(largest, energy(r));
  std::printf("pair, lambda %g, %.2f of the bound (%.4g us): energy x %.3g\n", radius_ratio,
              of_bound, rows[0].at("bound"), largest / energy(rows[0]));
  return largest / energy(rows[0]);
}
} // namespace

// Thin bonds resist along their line, which no axis shows by itself. Energy swings with the shadow
// energy's difference from it, which grows towards the limit, and does not drift.
TEST(VerificationTimestep, PairAlongTheDiagonal) {
  for (const double radius_ratio : {1.0, 0.5, 0.3})
    EXPECT_LT(growth_of_pair(0.99, radius_ratio), 2.0);
  std::string why;
  EXPECT_GT(growth_of_pair(1.2, 0.3, &why), 1e6);
  EXPECT_NE(why.find("exceeds 1 of the smaller of the bonds' bound"), std::string::npos) << why;
}

TEST(VerificationTimestep, UnstableNotFarAboveIt) {
  EXPECT_GT(growth(1.4, 0.0), 1e6);
  EXPECT_GT(growth(1.5, 0.1), 1e6);
}
