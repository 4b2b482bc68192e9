// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

// Mass [pg] of a sphere.
double mass_of(double radius) { return kDensity * 4.0 / 3.0 * kPi * std::pow(radius, 3); }

// Strain energy after one turn and after ten.
void settled(const CaseRun &run, double &early, double &late) {
  const std::vector<Row> rows = run.rows("curve.csv");
  ASSERT_GT(rows.size(), 38u) << run.why();
  early = rows[4].at("strain");
  late = rows.back().at("strain");
}

constexpr double kSpeed = 10.0, kModulus = 2e8, kStrength = 2e5; // rad/us, kPa, kPa
constexpr double kStep = 8e-5;                                   // us

// Ten turns of a body set in rigid rotation about `axis` through its centre of mass.
CaseRun spin(std::vector<BodySphere> all, const Vec3 &axis, double damping,
             const std::string &more = "") {
  Vec3 centre;
  double mass = 0.0;
  for (const BodySphere &s : all) {
    const double m = mass_of(s.radius);
    centre = centre + m * s.x;
    mass += m;
  }
  for (BodySphere &s : all) {
    s.omega = (kSpeed / norm(axis)) * axis;
    s.v = cross(s.omega, s.x - (1.0 / mass) * centre);
  }
  Files files = files_of(all, {-20, -20, -20}, {20, 20, 20});
  files["start.in"] += more;
  const int steps = static_cast<int>(20.0 * kPi / kSpeed / kStep);
  return CaseRun("in.body",
                 {{"friction", "0"},
                  {"ced", "0"},
                  {"damping", number(damping)},
                  {"dt", number(kStep)},
                  {"steps", std::to_string(steps)},
                  {"every", std::to_string(steps / 40)}},
                 1, files);
}

// A pair along x and what holds it together on a circular path.
struct Pair {
  double R_i, R_j, length;
  BondSection section() const { return BondSection(std::fmin(R_i, R_j)); }
  double stiffness() const { return kModulus * section().area / length; }
  double mass() const { return mass_of(R_i) * mass_of(R_j) / (mass_of(R_i) + mass_of(R_j)); }
  double stretched(double sine2) const { // length at which the tension keeps the circle
    return length / (1.0 - mass() * kSpeed * kSpeed * sine2 / stiffness());
  }
};

const Pair kPairs[] = {{0.795, 0.795, 1.28}, {0.795, 0.5, 1.0}, {0.795, 0.795, 1.5899}};

double length(const Row &r, const char *x, const char *y, const char *z) {
  return norm(Vec3{r.at(x), r.at(y), r.at(z)});
}

// Largest force on sphere 1 beyond the centripetal one, and largest torque over the bond's radius,
// both as parts of the bond's strength, during ten turns from the stretched length.
double spurious(const Pair &p, const Vec3 &axis) {
  const double sine2 = 1.0 - axis.x * axis.x, r = p.stretched(sine2);
  std::vector<BodySphere> pair = {{{0, 0, 0}, p.R_i, 1}, {{p.length, 0, 0}, p.R_j, 1}};
  const double share = p.mass() / mass_of(p.R_i); // m_j / (m_i + m_j): lever of sphere 1
  std::ostringstream stretch;
  stretch.precision(17);
  stretch << "set atom 1 x " << -(r - p.length) * share << "\nset atom 2 x "
          << p.length + (r - p.length) * (1.0 - share) << "\n";
  const CaseRun run = spin(pair, axis, 0.0, stretch.str());
  const double most = kStrength * p.section().area;
  double worst = 0.0;
  const auto frames = run.frames();
  EXPECT_GT(frames.size(), 38u) << run.why();
  for (size_t n = 1; n < frames.size(); ++n) { // forces exist from the first step on
    const Row &s = frames[n][0];
    const double extra = length(s, "fx", "fy", "fz") - p.mass() * kSpeed * kSpeed * sine2 * r;
    worst = std::fmax(worst, std::fabs(extra) / most);
    worst = std::fmax(worst, length(s, "tqx", "tqy", "tqz") / (most * p.section().radius));
  }
  return worst;
}

} // namespace

TEST(VerificationRotation, RigidSpinOfAPair) {
  for (const Pair &p : kPairs)
    for (const Vec3 &axis : {Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
      const double e = spurious(p, axis);
      std::printf("pair %g %g at %g: spurious force %.1e of the strength\n", p.R_i, p.R_j, p.length,
                  e);
      EXPECT_LT(e, 1e-6);
    }
}

TEST(VerificationRotation, DampingLagsByHalfAStep) {
  for (const Pair &p : kPairs) {
    const std::vector<BodySphere> pair = {{{0, 0, 0}, p.R_i, 1}, {{p.length, 0, 0}, p.R_j, 1}};
    const std::vector<Row> rows = spin(pair, {0, 0, 1}, 0.1).rows("curve.csv");
    ASSERT_GT(rows.size(), 38u);
    const double c = 2.0 * 0.1 * std::sqrt(p.stiffness() * p.mass()), r = p.stretched(1.0);
    const double centripetal = p.mass() * kSpeed * kSpeed * r;
    const double lag = centripetal - std::sqrt(2.0 * p.stiffness() * rows.back().at("strain"));
    const double expected = 0.5 * c * kSpeed * kSpeed * r * kStep;
    std::printf("damped pair: elastic tension below the centripetal %.4g nN, by the lag %.4g nN\n",
                lag, expected);
    EXPECT_NEAR(lag / expected, 1.0, 1e-3);
  }
}

TEST(VerificationRotation, BodyAboutAnyAxis) {
  for (const Vec3 &axis : {Vec3{0, 0, 1}, Vec3{1, 1, 1}, Vec3{1, 2, 3}}) {
    double early = 0.0, late = 0.0;
    settled(spin(cube(2, 1.28, {}, 1), axis, 0.1), early, late);
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
