// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "physics/pi.h"
#include "physics/sjkr_cohesion.h"
#include "run_case.h"

using namespace calendem;

namespace {
constexpr double E = 2e8, G = E / 2.6, R = 0.795, l = 1.28, dt = 1e-4, sc = 2e5, tc = 2e4;
const double A = kPi * R * R, I = kPi * R * R * R * R / 4.0, J = 2.0 * I;
const double kSteps = 1279.53; // steps until the break: well away from a whole number
const char *const kCriteria[] = {"signed", "unsigned", "as_printed"};

CaseRun load(const std::string &criterion, Settings motion, int steps = 1500) {
  motion.insert({{"criterion", criterion},
                 {"sc", number(sc)},
                 {"tc", number(tc)},
                 {"restitution", "1"},
                 {"steps", std::to_string(steps)}});
  return CaseRun("pair/in.pair", motion);
}

// Step of the only break, 0 if there is none; checks its mode through the log's text.
int break_step(const CaseRun &run, const std::string &mode) {
  const std::vector<Row> breaks = run.rows("breaks.csv");
  if (breaks.empty())
    return 0;
  EXPECT_EQ(breaks.size(), 1u);
  EXPECT_NE(run.text("breaks.csv").find("," + mode + ","), std::string::npos);
  return static_cast<int>(std::lround(breaks[0].at("time_us") / dt));
}

// Largest relative error of a column against law(step), over the rows with `intact` bonds. The step
// of the break still has the bond's force: the contact alone acts from the next one on.
template <class Law>
double error(const CaseRun &run, const std::string &column, double intact, Law law) {
  double worst = 0.0, last_intact = -1.0;
  int rows = 0;
  for (const Row &row : run.rows("curve.csv"))
    if (row.at("intact") == 1)
      last_intact = row.at("step");
  for (const Row &row : run.rows("curve.csv"))
    if (row.at("intact") == intact && (intact == 1 || row.at("step") > last_intact + 10)) {
      const double expected = law(row.at("step"));
      worst = std::fmax(worst, std::fabs(row.at(column) / expected - 1.0));
      ++rows;
    }
  EXPECT_GT(rows, 10) << run.why();
  return worst;
}

} // namespace

TEST(VerificationPair, Tension) {
  const double v = sc * l / E / (kSteps * dt);
  for (const std::string c : kCriteria) {
    const CaseRun run = load(c, {{"vx", number(v)}});
    ASSERT_TRUE(run.finished()) << run.why();
    const double e = error(run, "fx", 1, [&](double n) { return -E * A * v * n * dt / l; });
    std::printf("tension, %s: error %.1e\n", c.c_str(), e);
    EXPECT_LT(e, 1e-6);
    EXPECT_EQ(break_step(run, "tension"), c == "as_printed" ? 0 : 1280);
  }
}

TEST(VerificationPair, CompressionToFiveTimesTheTensileLimit) {
  const double v = sc * l / E / (kSteps * dt);
  const double E_eff = effective_modulus(E, 0.3, E, 0.3), R_eff = effective_radius(R, R);
  for (const std::string c : kCriteria) {
    const CaseRun run = load(c, {{"vx", number(-v)}}, 6400);
    ASSERT_TRUE(run.finished()) << run.why();
    const double e = error(run, "fx", 1, [&](double n) {
      const double d = v * n * dt; // bond and, beyond the overlap at creation, Hertz
      return E * A * d / l + hertz_force(E_eff, R_eff, d);
    });
    std::printf("compression, %s: error %.1e\n", c.c_str(), e);
    EXPECT_LT(e, 1e-6);
    EXPECT_EQ(break_step(run, "tension"), c == "unsigned" ? 1280 : 0);
    if (c != "unsigned")
      continue;
    const double after = error(run, "fx", 0, [&](double n) { // Hertz and SJKR from the reference
      const double d = v * n * dt;
      return hertz_force(E_eff, R_eff, d) - sjkr_force(6e5, 2 * R - d, R, R);
    });
    std::printf("after the break: error %.1e\n", after);
    EXPECT_LT(after, 1e-6);
  }
}

TEST(VerificationPair, Shear) {
  const double v = l * std::sinh(tc / G) / (kSteps * dt);
  for (const std::string c : kCriteria) {
    const CaseRun run = load(c, {{"vy", number(v)}});
    ASSERT_TRUE(run.finished()) << run.why();
    const auto force = [&](double n) { return G * A * v * n * dt / l; };
    const double ef = error(run, "fy", 1, [&](double n) { return -force(n); });
    const double em = error(run, "tz", 1, [&](double n) { return force(n) * l / 2; });
    std::printf("shear, %s: error of force %.1e, of moment %.1e\n", c.c_str(), ef, em);
    EXPECT_LT(ef, 1e-6);
    EXPECT_LT(em, 1e-6);
    EXPECT_EQ(break_step(run, "shear"), 1280);
  }
}

TEST(VerificationPair, Bending) {
  const double w = sc * l / (E * R) / (2.0 * kSteps * dt);
  for (const std::string c : kCriteria) {
    const CaseRun run = load(c, {{"wz", number(w)}});
    ASSERT_TRUE(run.finished()) << run.why();
    const double e = error(run, "tz", 1, [&](double n) { return -E * I * 2 * w * n * dt / l; });
    std::printf("bending, %s: error %.1e\n", c.c_str(), e);
    EXPECT_LT(e, 1e-6);
    EXPECT_EQ(break_step(run, "bending"), 1280);
  }
}

TEST(VerificationPair, Torsion) {
  const double w = tc * l / (G * R) / (2.0 * kSteps * dt);
  for (const std::string c : kCriteria) {
    const CaseRun run = load(c, {{"wx", number(w)}});
    ASSERT_TRUE(run.finished()) << run.why();
    const double e = error(run, "tx", 1, [&](double n) { return -G * J * 2 * w * n * dt / l; });
    std::printf("torsion, %s: error %.1e\n", c.c_str(), e);
    EXPECT_LT(e, 1e-6);
    EXPECT_EQ(break_step(run, "torsion"), 1280);
  }
}
