// SPDX-License-Identifier: GPL-2.0-or-later
// Requirements, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "spheres.h"

using namespace calendem;

namespace {

/// How many of a system's units make one of `micro`.
struct UnitSystem {
  const char *name;
  double length, time, density, stress;
  double force() const { return stress * length * length; }
};
const UnitSystem kSystems[] = {
    {"micro", 1.0, 1.0, 1.0, 1.0}, {"si", 1e-6, 1e-6, 1e3, 1e3}, {"cgs", 1e-4, 1e-6, 1.0, 1e4}};

constexpr double kModulus = 2e8; // kPa
constexpr double kSide = 6.0;    // of the cell, in radii

// A sphere of radius R [um] under a platen that comes down by a twentieth of it.
CaseRun load(const UnitSystem &u, double R) {
  const double r = R * u.length, speed = 0.02 * r / u.time;
  std::ostringstream data;
  data.precision(17);
  data << "a sphere\n\n1 atoms\n1 atom types\n0 " << kSide * r << " xlo xhi\n0 " << kSide * r
       << " ylo yhi\n0 " << 3 * r << " zlo zhi\n\nAtoms\n\n1 1 " << 2 * r << " "
       << kDensity * u.density << " " << 2 * r << " " << 2 * r << " " << r << "\n";
  return CaseRun("units/in.load",
                 {{"system", u.name},
                  {"Ey", number(kModulus * u.stress)},
                  {"dt", number(0.01 * u.time)},
                  {"R", number(r)},
                  {"top", number(2 * r)},
                  {"speed", number(speed)}},
                 1, {{"atoms.data", data.str()}, {"bodies.map", "1 1\n"}});
}

double hertz_load(double R, double overlap) {
  return hertz_force(effective_modulus(kModulus, 0.3, kModulus, 0.3), R, overlap);
}

std::vector<double> end_of(const CaseRun &run) {
  EXPECT_TRUE(run.finished()) << run.why();
  std::vector<double> all;
  const std::vector<std::vector<Row>> frames = run.frames();
  for (const Row &sphere : frames.back())
    for (const auto &[name, value] : sphere)
      all.push_back(value);
  return all;
}

// Largest difference of a coordinate, velocity or spin of the two loops.
double difference(const Settings &settings) {
  Settings host = settings, fused = settings;
  host["fused"] = "off";
  fused["fused"] = "on";
  const Files map = {{"bodies.map", "# none\n"}};
  const std::vector<double> a = end_of(CaseRun("units/in.insert", host, 1, map)),
                            b = end_of(CaseRun("units/in.insert", fused, 1, map));
  EXPECT_EQ(a.size(), b.size());
  double most = 0.0;
  for (size_t n = 0; n < a.size() && n < b.size(); ++n)
    most = std::fmax(most, std::fabs(a[n] - b[n]));
  return most;
}

} // namespace

TEST(VerificationUnits, LoadOnThePlatenFromNanometresToCentimetres) {
  for (const UnitSystem &u : kSystems)
    for (const double R : {1e-3, 1.0, 100.0, 1e4}) {
      const CaseRun run = load(u, R);
      ASSERT_TRUE(run.finished()) << run.why();
      const std::vector<Row> rows = run.rows("curve.csv");
      ASSERT_EQ(rows.size(), 40u);
      double worst = 0.0;
      for (const Row &r : rows) {
        const double overlap = 2.0 * R - r.at("height") / u.length;
        worst = std::fmax(worst, std::fabs(r.at("load") / r.at("force") - 1.0));
        EXPECT_NEAR(r.at("load") / u.force(), hertz_load(R, overlap),
                    1e-6 * hertz_load(R, 0.08 * R));
      }
      const double mean = rows.back().at("mean") * kSide * kSide * R * R / u.stress;
      EXPECT_NEAR(mean, rows.back().at("load") / u.force(), 0.1 * mean);
      std::printf("%s, R = %g um: load %.4g, of its force to %.1e\n", u.name, R,
                  rows.back().at("load"), worst);
      EXPECT_LT(worst, 1e-8); // nine digits are printed
    }
}

TEST(VerificationUnits, SpheresInsertedIntoAnEmptyBox) {
  const double most = difference({});
  std::printf("empty box: the loops differ by %.1e\n", most);
  EXPECT_LT(most, 1e-9);
}

// Between two builds of the lists, from forces of at most 2 E R^2 = 1.6e5 nN to 7e5 nN; inside the box
// and across a periodic side.
TEST(VerificationUnits, SpheresThatGrowBetweenTwoBuildsOfLists) {
  for (const double x : {0.5, 4.5}) {
    Files files = files_of({{{-x, 0, 0}, 0.02, 0}, {{x, 0, 0}, 0.02, 0}}, {-5, -4, -4}, {5, 4, 4});
    files["start.in"] +=
        "variable d equal 0.04+0.01*(step*(step<100)+100*(step>=100))\nunfix integrate\n"
        "fix grow all adapt 1 atom diameter v_d\n";
    const CaseRun run("in.body",
                      {{"bx", "p"},
                       {"ced", "0"},
                       {"bonded", "0"},
                       {"skin", "1.2"},
                       {"steps", "110"},
                       {"every", "10"}},
                      1, files);
    ASSERT_TRUE(run.finished()) << run.why();
    const double force = hertz_load(0.26, 0.04); // effective radius of two of 0.52 um
    EXPECT_GT(force, 2.0 * kModulus * 0.02 * 0.02);
    const std::vector<Row> end = run.frames().back();
    EXPECT_NEAR(end[0].at("fx") / force, x < 1.0 ? -1.0 : 1.0, 1e-12);
    EXPECT_NEAR(end[1].at("fx") / force, x < 1.0 ? 1.0 : -1.0, 1e-12);
  }
}

TEST(VerificationUnits, SpheresInsertedAmongSmallerOnes) {
  const double most = difference({{"small", "2e-5"}});
  std::printf("among smaller ones: the loops differ by %.1e\n", most);
  EXPECT_LT(most, 1e-9);
}
