// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "physics/parallel_bond.h"
#include "run_case.h"

using namespace calendem;

namespace {

constexpr double E = 2e6, nu = 0.3, R = 0.795, g = 0.4, tau = 0.05, dt = 1e-4;
constexpr int kDown = 1000, kHold = 1000, kUp = 300;
const double E_eff = effective_modulus(E, nu, E, nu), r = 2.0 / (3.0 * tau);

// The branch's spring after a time at constant speed.
double moved(double e, double speed, double time) {
  return e * std::exp(-r * time) + speed * (1.0 - std::exp(-r * time)) / r;
}

double hertz(double R_eff, double x) {
  return std::copysign(hertz_force(E_eff, R_eff, std::fabs(x)), x);
}

// Force by hand while the contact is pressed, held and let out at the speed v.
double by_hand(double R_eff, double v, double time) {
  const double down = kDown * dt, hold = kHold * dt;
  const double t1 = std::fmin(time, down), t2 = std::fmin(std::fmax(time - down, 0.0), hold),
               t3 = std::fmax(time - down - hold, 0.0);
  const double e = moved(moved(moved(0.0, v, t1), 0.0, t2), -v, t3);
  return (1.0 - g) * hertz(R_eff, v * (t1 - t3)) + g * hertz(R_eff, e);
}

Settings viscous(double touch, double speed) {
  return {{"Ey", number(E)},
          {"restitution", "1"},
          {"friction", "0"},
          {"ced", "0"},
          {"relaxed", number(g)},
          {"relaxation", number(tau)},
          {"dt", number(dt)},
          {"z0", number(touch)},
          {"vz", number(speed)},
          {"down", std::to_string(kDown)},
          {"hold", std::to_string(kHold)},
          {"up", std::to_string(kUp)}};
}

struct Errors {
  double force, ledger; ///< in parts of the largest force, of the largest work
};

Errors pressed(double R_eff, double speed, Settings settings) {
  settings["every"] = "1";
  const CaseRun run("plastic_contact/in.press", settings);
  EXPECT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  Errors worst = {0, 0};
  double force = 0.0, work = 0.0, most = 0.0;
  for (size_t k = 0; k < rows.size(); ++k) {
    const Row &row = rows[k];
    const double law = by_hand(R_eff, speed, row.at("step") * dt);
    force = std::fmax(force, law);
    worst.force = std::fmax(worst.force, std::fabs(row.at("f") - law));
    if (k > 0)
      work += 0.5 * (row.at("f") + rows[k - 1].at("f")) * (rows[k - 1].at("z") - row.at("z"));
    most = std::fmax(most, work);
    worst.ledger = std::fmax(worst.ledger, std::fabs(work - row.at("elastic") - row.at("taken")));
  }
  EXPECT_GT(rows.back().at("taken"), 0.05 * most);
  return {worst.force / force, worst.ledger / most};
}

} // namespace

// Speeds at which the branch relaxes all along and hardly at all.
TEST(VerificationViscousContact, SpheresFollowTheLaw) {
  for (const double speed : {0.02, 0.2}) {
    const Errors e = pressed(0.5 * R, speed, viscous(2 * R, speed));
    std::printf("spheres at %g um/us: force %.1e, ledger %.1e\n", speed, e.force, e.ledger);
    EXPECT_LT(e.force, 1e-9);
    EXPECT_LT(e.ledger, 1e-5);
  }
}

TEST(VerificationViscousContact, SphereAndWallFollowTheLaw) {
  Settings settings = viscous(R, 0.1);
  settings["wall"] = "1";
  const Errors e = pressed(R, 0.1, settings);
  std::printf("wall: force %.1e, ledger %.1e\n", e.force, e.ledger);
  EXPECT_LT(e.force, 1e-9);
  EXPECT_LT(e.ledger, 1e-5);
}

// A free impact: kinetic + stored + taken stays; it comes back slower than it came.
TEST(VerificationViscousContact, ImpactKeepsItsLedger) {
  Settings settings = viscous(2 * R + 1e-9, 0.5);
  settings.insert({{"free", "1"}, {"every", "20"}});
  settings["down"] = "20000";
  settings["dt"] = "1e-5";
  const CaseRun run("plastic_contact/in.press", settings);
  ASSERT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  const double start = 0.5 * 4.65 * 4.0 / 3.0 * kPi * R * R * R * 0.25;
  double worst = 0.0;
  for (const Row &row : rows)
    worst = std::fmax(
        worst, std::fabs((row.at("kinetic") + row.at("elastic") + row.at("taken")) / start - 1.0));
  const Row &last = rows.back();
  const double restitution = (last.at("v") - last.at("v_low")) / 0.5;
  std::printf("impact: restitution %.4f, ledger %.1e\n", restitution, worst);
  ASSERT_EQ(last.at("f"), 0.0) << "still in contact";
  EXPECT_LT(restitution, 0.95);
  EXPECT_LT(worst, 1e-5);
}
