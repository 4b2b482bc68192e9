// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "physics/parallel_bond.h"
#include "physics/sjkr_cohesion.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, nu = 0.3, R = 0.795, ced = 6e5, density = 4.65;
const double E_eff = effective_modulus(E, nu, E, nu), mass = density * 4.0 / 3.0 * kPi * R * R * R;

// Largest error of the force on sphere 2, relative to the largest force, while it is pressed in to
// an overlap of 0.02 um and pulled out again at 0.1 um/us without damping.
double worst_error(Settings settings, double touch, double (*law)(double)) {
  double worst = 0.0, largest = 0.0;
  for (const double speed : {-0.1, 0.1}) {
    settings["vz"] = number(speed);
    settings["z0"] = number(speed < 0.0 ? touch : touch - 0.02);
    const CaseRun run("contact/in.contact", settings);
    EXPECT_TRUE(run.finished()) << run.why();
    for (const Row &row : run.rows("curve.csv")) {
      const double expected = law(row.at("z"));
      largest = std::fmax(largest, std::fabs(expected));
      worst = std::fmax(worst, std::fabs(row.at("f") - expected));
    }
  }
  return worst / largest;
}

double hertz_only(double z) {
  return z < 2 * R ? hertz_force(E_eff, effective_radius(R, R), 2 * R - z) : 0.0;
}
double hertz_and_sjkr(double z) {
  return hertz_only(z) - (z < 2 * R ? sjkr_force(ced, z, R, R) : 0.0);
}
double hertz_wall(double z) { return z < R ? hertz_force(E_eff, R, R - z) : 0.0; }

} // namespace

TEST(VerificationContact, HertzBetweenSpheres) {
  const double e =
      worst_error({{"restitution", "1"}, {"friction", "0"}, {"ced", "0"}}, 2 * R, hertz_only);
  std::printf("Hertz, spheres: error %.1e of the largest force\n", e);
  EXPECT_LT(e, 1e-9);
}

TEST(VerificationContact, SjkrBetweenSpheres) {
  const double e = worst_error({{"restitution", "1"}, {"friction", "0"}, {"ced", number(ced)}},
                               2 * R, hertz_and_sjkr);
  std::printf("Hertz and SJKR, spheres: error %.1e of the largest force\n", e);
  EXPECT_LT(e, 1e-9);
}

TEST(VerificationContact, HertzAgainstAWall) {
  const double e = worst_error(
      {{"restitution", "1"}, {"friction", "0"}, {"ced", "0"}, {"wall", "1"}}, R, hertz_wall);
  std::printf("Hertz, wall: error %.1e of the largest force\n", e);
  EXPECT_LT(e, 1e-9);
}

TEST(VerificationContact, PullOffForceAndWorkOfSjkr) {
  const CaseRun run("contact/in.contact", {{"restitution", "1"},
                                           {"friction", "0"},
                                           {"ced", number(ced)},
                                           {"vz", "0.001"},
                                           {"z0", number(2 * R - 1e-3)},
                                           {"every", "1"},
                                           {"steps", "10010"},
                                           {"dt", "1e-4"}});
  ASSERT_TRUE(run.finished()) << run.why();
  double least = 0.0, work = 0.0, before = 0.0;
  const double step = 0.001 * 1e-4;
  for (const Row &row : run.rows("curve.csv")) { // work of the attraction, from equilibrium on
    const double pull = std::fmax(-row.at("f"), 0.0);
    least = std::fmin(least, row.at("f"));
    work += 0.5 * (before + pull) * step;
    before = pull;
  }
  const double R_eff = effective_radius(R, R), q = kPi * ced / E_eff;
  const double force = 2.0 / 3.0 * kPi * R_eff * R_eff * q * q * ced;
  const double overlap = sjkr_equilibrium_overlap(ced, E_eff, R_eff);
  const double energy = kPi * R_eff * ced * overlap * overlap / 5.0;
  std::printf("SJKR pull-off: force %.6g nN, formula %.6g nN; work %.6g fJ, formula %.6g fJ\n",
              -least, force, work, energy);
  EXPECT_NEAR(-least / force, 1.0, 2e-4);
  EXPECT_NEAR(work / energy, 1.0, 4e-4);
}

TEST(VerificationContact, CollisionTimeAndSpeed) {
  const double speed = 0.5, m_eff = 0.5 * mass, R_eff = 0.5 * R;
  const double depth =
      std::pow(15.0 * m_eff * speed * speed / (16.0 * std::sqrt(R_eff) * E_eff), 0.4);
  const double time = 2.9432751 * depth / speed;
  const double dt = time / 4000.0;
  const CaseRun run("contact/in.contact", {{"restitution", "1"},
                                           {"friction", "0"},
                                           {"ced", "0"},
                                           {"free", "1"},
                                           {"vz", "-0.5"},
                                           {"z0", number(2 * R + 1e-9)},
                                           {"every", "1"},
                                           {"steps", "5000"},
                                           {"dt", number(dt)}});
  ASSERT_TRUE(run.finished()) << run.why();
  int steps = 0;
  double deepest = 0.0;
  for (const Row &row : run.rows("curve.csv")) {
    const double overlap = 2 * R - (row.at("z") - row.at("z_low"));
    steps += overlap > 0.0;
    deepest = std::fmax(deepest, overlap);
  }
  const Row last = run.rows("curve.csv").back();
  const double restitution = (last.at("v") - last.at("v_low")) / speed;
  std::printf("collision: time %.6f of Hertz', depth %.8f of it, restitution %.8f\n",
              steps * dt / time, deepest / depth, restitution);
  EXPECT_NEAR(steps * dt / time, 1.0, 1.0 / 2000); // first and last step in contact
  EXPECT_NEAR(deepest / depth, 1.0, 1e-5);
  EXPECT_NEAR(restitution, 1.0, 1e-5);
}

namespace {

// Speed after over speed before of m x'' = -k x^1.5 - c x^0.25 x', by small steps of Runge and
// Kutta.
double restitution_of_the_equation(double input, double speed) {
  const double m = 0.5 * mass, R_eff = 0.5 * R, k = 4.0 / 3.0 * E_eff * std::sqrt(R_eff);
  const double l = std::log(input), beta = l / std::sqrt(l * l + kPi * kPi);
  const auto pull = [&](double x, double v) {
    if (x <= 0.0)
      return 0.0;
    const double c =
        -2.0 * std::sqrt(5.0 / 6.0) * beta * std::sqrt(2.0 * E_eff * std::sqrt(R_eff * x) * m);
    return (-k * std::pow(x, 1.5) - c * v) / m;
  };
  double x = 1e-12, v = speed;
  const double h = 2e-8;
  while (x > 0.0) {
    const double a1 = pull(x, v), v2 = v + 0.5 * h * a1, a2 = pull(x + 0.5 * h * v, v2);
    const double v3 = v + 0.5 * h * a2, a3 = pull(x + 0.5 * h * v2, v3), v4 = v + h * a3;
    const double a4 = pull(x + h * v3, v4);
    x += h / 6.0 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6.0 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return -v / speed;
}

} // namespace

TEST(VerificationContact, RestitutionOfTheDampedContact) {
  for (const double input : {0.15, 0.5, 0.78}) {
    const CaseRun run("contact/in.contact", {{"restitution", number(input)},
                                             {"friction", "0"},
                                             {"ced", "0"},
                                             {"free", "1"},
                                             {"vz", "-0.5"},
                                             {"z0", number(2 * R + 1e-9)},
                                             {"every", "100"},
                                             {"steps", "40000"},
                                             {"dt", "1e-6"}});
    ASSERT_TRUE(run.finished()) << run.why();
    const Row last = run.rows("curve.csv").back();
    const double measured = (last.at("v") - last.at("v_low")) / 0.5;
    const double expected = restitution_of_the_equation(input, 0.5);
    std::printf("restitution %.2f asked: %.5f, equation of motion %.5f\n", input, measured,
                expected);
    EXPECT_NEAR(measured, expected, 2e-3 * expected);
  }
}

namespace {

// A free bonded pair, thrown apart or together along its axis fast enough to break its bond.
CaseRun thrown(double speed, const std::string &criterion, double dt) {
  const std::vector<BodySphere> pair = {{{0, 0, 0}, R, 1, {-0.5 * speed, 0, 0}},
                                        {{1.28, 0, 0}, R, 1, {0.5 * speed, 0, 0}}};
  return CaseRun("in.body",
                 {{"restitution", "1"},
                  {"friction", "0"},
                  {"ced", "0"},
                  {"breakable", "yes"},
                  {"criterion", criterion},
                  {"dt", number(dt)},
                  {"steps", number(std::round(6e-4 / dt))},
                  {"every", "1"}},
                 1, files_of(pair, {-20, -20, -20}, {20, 20, 20}));
}

struct Ledger {
  double most, least; // change of kinetic + strain + lost + Hertz energy, in parts of the start
  bool broken;
};

// Hertz beyond the reference, as the broken pair feels it.
Ledger ledger(const CaseRun &run, double speed) {
  const double start = 0.5 * (0.5 * mass) * speed * speed;
  const auto frames = run.frames();
  const std::vector<Row> rows = run.rows("curve.csv");
  Ledger l = {0.0, 0.0, false};
  EXPECT_EQ(frames.size(), rows.size() + 1) << run.why(); // the dump has the start as well
  for (size_t n = 0; n < rows.size(); ++n) {
    const double d = 1.28 - (frames[n + 1][1].at("x") - frames[n + 1][0].at("x"));
    const double hertz =
        d > 0.0 ? 8.0 / 15.0 * E_eff * std::sqrt(effective_radius(R, R)) * std::pow(d, 2.5) : 0.0;
    const double sum = rows[n].at("kinetic") + rows[n].at("strain") + rows[n].at("lost") + hertz;
    l.most = std::fmax(l.most, sum / start - 1.0);
    l.least = std::fmin(l.least, sum / start - 1.0);
    l.broken = l.broken || rows[n].at("intact") == 0;
  }
  return l;
}

} // namespace

TEST(VerificationContact, ABreakReleasesNoEnergy) {
  const double speed = 15.0; // m/s; at 10 m/s the bond would just hold
  const double force = 2e5 * kPi * R * R, energy = 0.25 * mass * speed * speed;
  const double stored = 0.5 * force * force / (2e8 * kPi * R * R / 1.28);
  const double at_break = speed * std::sqrt(1.0 - stored / energy);
  for (const std::string criterion : {"signed", "unsigned"})
    for (const double dt : {2e-6, 1e-6}) {
      const double v = criterion == "signed" ? speed : -speed; // apart; together
      const Ledger l = ledger(thrown(v, criterion, dt), v);
      const double last_pull = 0.5 * force * at_break * dt / energy;
      std::printf("break, %s, step %g us: energy changes by %+.1e %+.1e; half a step's pull %.1e\n",
                  criterion.c_str(), dt, l.most, l.least, last_pull);
      EXPECT_TRUE(l.broken);
      EXPECT_LT(l.most, 6.4e-5); // (omega dt)^2 / 4, as without a break
      EXPECT_NEAR(-l.least / last_pull, 1.0, 0.05);
    }
}

// Between two builds of the lists: each sphere moves by half of what would ask for new ones before
// they touch.
TEST(VerificationContact, SpheresThatComeNearMeetInTime) {
  const auto meet = [](const char *check) {
    return CaseRun(
        "in.body", {{"bonded", "0"}, {"dt", "1e-4"}, {"steps", "600"}, {"check", check}}, 1,
        files_of({{{-0.9, 0, 0}, 0.795, 1, {5, 0, 0}}, {{0.9, 0.1, 0}, 0.795, 2, {-5, 0, 0}}},
                 {-6, -6, -6}, {6, 6, 6}));
  };
  const CaseRun run = meet("yes");
  const auto often = meet("no").frames(), seldom = run.frames();
  ASSERT_FALSE(seldom.empty()) << run.why();
  EXPECT_LT(seldom.back().at(0).at("vx"), 0.0); // they have parted again
  ASSERT_EQ(seldom.size(), often.size());
  for (const size_t n : {0u, 1u})
    for (const char *value : {"x", "y", "vx", "vy", "omegaz"})
      EXPECT_EQ(seldom.back().at(n).at(value), often.back().at(n).at(value)) << n << " " << value;
}
