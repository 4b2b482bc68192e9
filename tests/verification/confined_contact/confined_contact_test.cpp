// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "meeting.h"
#include "physics/hertz_contact.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e6, nu = 0.3, R = 0.795, K = 2e6, psi = 0.5, z = 12.0;
const double E_eff = effective_modulus(E, nu, E, nu), x_b = 4.0 * (1.0 - psi) / z;

// Force by hand: the bulk's pressure, from z areas that move in by R (x - x_b), on one of them.
double by_hand(double R_eff, double d) {
  const double x = R_eff * d / (R * R), area = kPi * R * R * x;
  const double volume = 4.0 / 3.0 * kPi * R * R * R;
  const double pressure = K * z * area * R * std::fmax(x - x_b, 0.0) / volume;
  return hertz_force(E_eff, R_eff, std::fmax(d, 0.0)) + pressure * area;
}

Settings confined(double touch) {
  return {{"Ey", number(E)},     {"restitution", "1"}, {"friction", "0"},
          {"ced", "0"},          {"bulk", number(K)},  {"free_surface", number(psi)},
          {"z0", number(touch)}, {"dt", "1e-4"}};
}

struct Errors {
  double force, ledger; ///< in parts of the largest force, of the largest work
};

// In beyond the onset, halfway out, in again.
Errors pressed(double touch, double R_eff, Settings settings) {
  settings.insert({{"vz", "0.5"}, {"down", "8000"}, {"up", "4000"}, {"again", "5000"}});
  settings["every"] = "4";
  const CaseRun run("plastic_contact/in.press", settings);
  EXPECT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  Errors worst = {0, 0};
  double force = 0.0, work = 0.0, most = 0.0, hertz = 0.0;
  for (size_t k = 0; k < rows.size(); ++k) {
    const Row &row = rows[k];
    const double law = by_hand(R_eff, touch - row.at("z"));
    hertz = std::fmax(hertz, hertz_force(E_eff, R_eff, touch - row.at("z")));
    force = std::fmax(force, law);
    worst.force = std::fmax(worst.force, std::fabs(row.at("f") - law));
    if (k > 0)
      work += 0.5 * (row.at("f") + rows[k - 1].at("f")) * (rows[k - 1].at("z") - row.at("z"));
    most = std::fmax(most, work);
    worst.ledger = std::fmax(worst.ledger, std::fabs(work - row.at("elastic")));
    EXPECT_EQ(row.at("taken"), 0.0);
  }
  EXPECT_GT(force, 2.0 * hertz); // well beyond the onset
  return {worst.force / force, worst.ledger / most};
}

} // namespace

TEST(VerificationConfinedContact, SpheresAndWallFollowTheLaw) {
  const Errors spheres = pressed(2 * R, 0.5 * R, confined(2 * R));
  Settings at_wall = confined(R);
  at_wall["wall"] = "1";
  const Errors wall = pressed(R, R, at_wall);
  std::printf("spheres: force %.1e, ledger %.1e; wall: force %.1e, ledger %.1e\n", spheres.force,
              spheres.ledger, wall.force, wall.ledger);
  for (const Errors &e : {spheres, wall}) {
    EXPECT_LT(e.force, 1e-9);
    EXPECT_LT(e.ledger, 1e-5);
  }
}

// A free impact deep into the bulk: it comes back as fast as it came.
TEST(VerificationConfinedContact, ImpactLosesNothing) {
  Settings settings = confined(2 * R + 1e-9);
  settings.insert({{"free", "1"}, {"vz", "400"}, {"down", "20000"}, {"every", "20"}});
  settings["dt"] = "5e-7";
  const CaseRun run("plastic_contact/in.press", settings);
  ASSERT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  const double start = 0.5 * kDensity * 4.0 / 3.0 * kPi * R * R * R * 400.0 * 400.0;
  double worst = 0.0, deepest = 0.0;
  for (const Row &row : rows) {
    worst = std::fmax(worst, std::fabs((row.at("kinetic") + row.at("elastic")) / start - 1.0));
    deepest = std::fmax(deepest, 2 * R - row.at("z") + row.at("z_low"));
  }
  const Row &last = rows.back();
  const double restitution = (last.at("v") - last.at("v_low")) / 400.0;
  std::printf("impact to x = %.3f: restitution - 1 %.1e, ledger %.1e\n", deepest / (2 * R),
              restitution - 1.0, worst);
  ASSERT_EQ(last.at("f"), 0.0) << "still in contact";
  EXPECT_GT(deepest / (2 * R), 2.0 * x_b);
  EXPECT_NEAR(restitution, 1.0, 1e-5);
  EXPECT_LT(worst, 1e-5);
}

// Two bodies that meet across the ranks' border: the law acts, and the same on both.
TEST(VerificationConfinedContact, SameOnOneAndTwoRanks) {
  std::vector<std::vector<Row>> ends;
  const Files files = files_of(meeting(), {-6, -6, -6}, {6, 6, 6});
  const std::vector<std::pair<int, double>> runs = {{1, 2e8}, {2, 2e8}, {1, 0.0}};
  for (const auto &[ranks, bulk] : runs) {
    const CaseRun run("in.body",
                      {{"contact", "hertz_effects"},
                       {"bulk", number(bulk)},
                       {"free_surface", "0.99"},
                       {"bx", "p"},
                       {"by", "p"},
                       {"dt", "2e-5"},
                       {"steps", "20000"},
                       {"every", "5000"}},
                      ranks, files);
    ASSERT_TRUE(run.finished()) << run.why();
    ends.push_back(run.frames().back());
  }
  const auto difference = [&](int a, int b) {
    double worst = 0.0;
    for (size_t n = 0; n < ends[a].size(); ++n)
      for (const char *what : {"x", "y", "z"})
        worst = std::fmax(worst, std::fabs(ends[a][n].at(what) - ends[b][n].at(what)));
    return worst;
  };
  std::printf("positions: 1 and 2 ranks differ by %.1e um, with and without the law by %.1e um\n",
              difference(0, 1), difference(0, 2));
  EXPECT_LT(difference(0, 1), 1e-9); // round-off in another order of sums, grown over the run
  EXPECT_GT(difference(0, 2), 1e-7);
}
