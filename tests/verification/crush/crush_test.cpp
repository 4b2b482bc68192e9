// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, nu = 0.3, R = 0.795, kSpacing = 1.28, kSide = 16.0, sc = 2e5, tc = 2e5;
const double E_eff = effective_modulus(E, nu, E, nu), A = kPi * R * R;

// Lattice spheres whose centres lie within `radius` of the middle of a lattice cell, lowest at z =
// R.
std::vector<BodySphere> ball(double radius) {
  std::vector<BodySphere> all;
  double lowest = HUGE_VAL;
  const Vec3 u = (1.0 / std::sqrt(14.0)) * Vec3{1, 2, 3};
  for (BodySphere s : cube(10, kSpacing, -4.5 * kSpacing * Vec3{1, 1, 1}, 1))
    if (norm(s.x) < radius) {
      s.x = std::cos(0.6) * s.x + std::sin(0.6) * cross(u, s.x) +
            ((1.0 - std::cos(0.6)) * dot(u, s.x)) * u;
      lowest = std::fmin(lowest, s.x.z);
      all.push_back(s);
    }
  for (BodySphere &s : all)
    s.x = s.x + Vec3{0.5 * kSide, 0.5 * kSide, R + 1e-4 - lowest};
  return all;
}

double height(const std::vector<BodySphere> &all) {
  double top = 0.0;
  for (const BodySphere &s : all)
    top = std::fmax(top, s.x.z + s.radius);
  return top;
}

// Presses the body to `depth` between collector and platen.
CaseRun crush(const std::vector<BodySphere> &all, double depth, double speed, Settings settings,
              double ramp = 0.5) {
  Files files = files_of(all, {0, 0, 0}, {kSide, kSide, 20});
  const double top = height(all) + 1e-4;
  std::ostringstream start;
  start.precision(17);
  start << "variable motion index position\nvariable aim index " << top - depth
        << "\nvariable top index " << top << "\nvariable speed index " << speed
        << "\nvariable window index 0.25\nvariable dwell index 1\nvariable ramp index " << ramp
        << "\nvariable lost_at index 0.001\ninclude ${cases}/platen/in.platen\n";
  files["start.in"] += start.str();
  settings.insert({{"bx", "p"},
                   {"by", "p"},
                   {"ced", "0"},
                   {"breakable", "yes"},
                   {"damping", "0.05"},
                   {"sc", number(sc)},
                   {"tc", number(tc)},
                   {"skin", "0.15"},
                   {"frames", "1000000"}}); // not read
  return CaseRun("in.body", settings, 1, files);
}

} // namespace

// Every column of a cube carries the same load, so all upright bonds meet an unsigned limit
// together.
TEST(VerificationCrush, CubeByHand) {
  std::vector<BodySphere> all = cube(3, kSpacing, {7, 7, R + 1e-4}, 1);
  const double d = sc * kSpacing / E; // shortening of a bond at its strength
  const double column = sc * A + hertz_force(E_eff, 0.5 * R, d);
  const CaseRun run = crush(all, 0.06, 0.02,
                            {{"criterion", "unsigned"},
                             {"friction", "0"},
                             {"dt", "6e-5"},
                             {"steps", "55000"},
                             {"every", "20"}});
  const std::vector<Row> platen = run.rows("platen.csv"), curve = run.rows("curve.csv");
  ASSERT_EQ(platen.size(), curve.size()) << run.why();
  ASSERT_FALSE(run.rows("breaks.csv").empty());
  double before = 0.0;
  for (size_t n = 0; n < curve.size() && curve[n].at("intact") == curve[n].at("made"); ++n)
    before = platen[n].at("load");
  std::printf("cube: load at the first break %.6g nN, nine columns %.6g nN, ratio %.5f\n", before,
              9 * column, before / (9 * column));
  EXPECT_NEAR(before / (9 * column), 1.0, 0.005);
  const CaseRun signed_run = crush(all, 0.06, 0.04,
                                   {{"criterion", "signed"},
                                    {"friction", "0"},
                                    {"dt", "6e-5"},
                                    {"steps", "30000"},
                                    {"every", "200"}});
  ASSERT_TRUE(signed_run.finished()) << signed_run.why();
  EXPECT_TRUE(signed_run.rows("breaks.csv").empty()); // plain compression does not break it
}

namespace {

struct Crushed {
  double first = 0.0;  // load at the last row with all bonds
  double peak = 0.0;   // largest load
  double trough = 0.0; // least load after it
  double least = 0.0;  // least of the work beyond the energy held
  double work = 0.0;
};

Crushed crushed(const CaseRun &run) {
  const std::vector<Row> platen = run.rows("platen.csv"), curve = run.rows("curve.csv");
  EXPECT_EQ(platen.size(), curve.size()) << run.why();
  Crushed c;
  for (size_t n = 0; n < curve.size(); ++n) {
    const Row &r = curve[n];
    const double load = platen[n].at("load");
    c.work = platen[n].at("work");
    c.least = std::fmin(
        c.least, c.work - (r.at("kinetic") + r.at("rotational") + r.at("strain") + r.at("lost")));
    if (r.at("intact") == r.at("made"))
      c.first = load;
    c.trough = load > c.peak ? load : std::fmin(c.trough, load);
    c.peak = std::fmax(c.peak, load);
  }
  const size_t broken = run.rows("breaks.csv").size();
  EXPECT_EQ(curve.back().at("made") - curve.back().at("intact"), double(broken));
  EXPECT_GT(broken, 0u);
  return c;
}

} // namespace

// A round body: load at the first break in proportion to strength, then a fall; bonds add up and no
// energy comes from nowhere.
TEST(VerificationCrush, BallBetweenPlates) {
  const std::vector<BodySphere> all = ball(2.6 * kSpacing);
  double first[2] = {};
  for (const int strong : {0, 1}) {
    const CaseRun run = crush(all, 0.3, 0.5,
                              {{"sc", number((1 + strong) * sc)},
                               {"tc", number((1 + strong) * tc)},
                               {"dt", "6e-5"},
                               {"steps", "13000"},
                               {"every", "10"}});
    ASSERT_TRUE(run.finished()) << run.why();
    const Crushed c = crushed(run);
    std::printf(
        "ball of %zu spheres: first break at %.5g nN, peak %.5g, then down to %.2g nN; work "
        "%.4g fJ, least beyond the energy held %.2g fJ\n",
        all.size(), c.first, c.peak, c.trough, c.work, c.least);
    EXPECT_NEAR(c.peak / c.first, 1.0, 0.01); // brittle: the first break is the crush
    EXPECT_LT(c.trough, 0.5 * c.peak);
    EXPECT_GT(c.least, -1e-4 * c.work);
    first[strong] = c.first;
  }
  std::printf("twice the strength: %.4f times the load\n", first[1] / first[0]);
  EXPECT_NEAR(first[1] / first[0], 2.0, 0.04);
}

namespace {

constexpr int kLayers = 7;
constexpr double kModulus = 5.0; // of the Weibull scatter

// Upright cylinder of a face-centred lattice: bonds lie flat or slope by 45 degrees, ends are even.
std::vector<BodySphere> cylinder() {
  std::vector<BodySphere> all;
  const double a = kSpacing * std::sqrt(0.5); // half a cubic cell
  for (int z = 0; z < kLayers; ++z)
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        if ((x + y + z) % 2 == 0 && std::hypot(a * x, a * y) < 2.3)
          all.push_back({{0.5 * kSide + a * x, 0.5 * kSide + a * y, R + 1e-4 + a * z}, R, 1});
  return all;
}

struct Strength {
  double first, peak; // nN
  Row bond;           // the one that broke first
};

// Strength and speed grow alike. Contacts are soft, or their share in the load would grow with it.
Strength strength_of_cylinder(int seed, double times) {
  const double speed = 0.7 * times;
  const CaseRun run = crush(cylinder(), 0.54 * times, speed,
                            {{"sc", number(times * sc)},
                             {"tc", number(times * tc)},
                             {"Ey", "5e7"},
                             {"weibull", number(kModulus)},
                             {"seed", number(seed)},
                             {"dt", "5e-5"},
                             {"steps", "9600"},
                             {"every", "20"}},
                            0.2);
  EXPECT_TRUE(run.finished()) << run.why();
  const Crushed c = crushed(run);
  EXPECT_LT(c.trough, 0.5 * c.peak); // brittle
  return {c.first, c.peak, run.rows("breaks.csv").front()};
}

double mean(const std::vector<double> &all) {
  double sum = 0.0;
  for (const double x : all)
    sum += x;
  return sum / all.size();
}

double coefficient_of_variation(const std::vector<double> &all) {
  double sum = 0.0;
  for (const double x : all)
    sum += std::pow(x - mean(all), 2);
  return std::sqrt(sum / (all.size() - 1)) / mean(all);
}

} // namespace

// Weakest link: the load at the first break follows the law of one bond, whatever the stress in the
// others.
TEST(VerificationCrush, ScatterOfACylinder) {
  std::vector<double> first, peak;
  for (int seed = 1; seed <= 8; ++seed) {
    const Strength s = strength_of_cylinder(seed, 1.0);
    first.push_back(s.first);
    peak.push_back(s.peak);
  }
  const double area = cylinder().size() / double(kLayers) * kSpacing * kSpacing;
  const double g = std::tgamma(1.0 + 1.0 / kModulus);
  const double bond = std::sqrt(std::tgamma(1.0 + 2.0 / kModulus) / (g * g) - 1.0);
  const double found = coefficient_of_variation(first), of_peak = coefficient_of_variation(peak);
  std::printf("cylinder, 8 seeds: peak stress %.4g MPa = %.3f strengths of a bond, coefficient of "
              "variation %.3f; first break %.4g MPa, %.3f; one bond %.3f\n",
              1e-3 * mean(peak) / area, mean(peak) / area / sc, of_peak, 1e-3 * mean(first) / area,
              found, bond);
  EXPECT_NEAR(found / bond, 1.0, 3.0 * 0.29); // 0.29: standard error with 8
  EXPECT_GT(of_peak, 0.0);
  EXPECT_LT(of_peak, found); // other bonds take over
}

TEST(VerificationCrush, CylinderInProportionToTheBonds) {
  for (const int seed : {1, 2, 3}) {
    const Strength one = strength_of_cylinder(seed, 1.0), two = strength_of_cylinder(seed, 2.0);
    std::printf(
        "cylinder, seed %d: twice the strength of bonds, %.4f times the first load, %.4f times "
        "the peak\n",
        seed, two.first / one.first, two.peak / one.peak);
    EXPECT_NEAR(two.first / one.first, 2.0, 0.06);
    EXPECT_NEAR(two.peak / one.peak, 2.0, 0.06);
    for (const char *tag : {"tag_i", "tag_j"})
      EXPECT_EQ(one.bond.at(tag), two.bond.at(tag)); // the same bond breaks first
  }
}
