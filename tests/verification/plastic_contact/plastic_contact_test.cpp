// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "meeting.h"
#include "physics/hertz_contact.h"
#include "physics/plastic_contact.h"
#include "physics/sjkr_cohesion.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, nu = 0.3, R = 0.795, p_y = 4e6;
const double E_eff = effective_modulus(E, nu, E, nu);
const double mass = kDensity * 4.0 / 3.0 * kPi * R * R * R;

Settings elastic_otherwise() {
  return {{"restitution", "1"}, {"friction", "0"}, {"ced", "0"}, {"yield", number(p_y)}};
}

struct Errors {
  double force, elastic, taken; ///< largest, in parts of the largest value of the law
};

// In, halfway out, in deeper, all with the law beside it. `ced` [kPa]: of spheres whose limit is
// beyond cohesion.
Errors pressed(double touch, double R_eff, Settings settings, double hardening = 0.0,
               double ced = 0.0, double flattening = 0.0) {
  const PlasticContact law(E_eff, R_eff, p_y + 2.0 * ced, hardening, flattening);
  settings.insert({{"z0", number(touch)}, {"down", "1000"}, {"up", "200"}, {"again", "500"}});
  const CaseRun run("plastic_contact/in.press", settings);
  EXPECT_TRUE(run.finished()) << run.why();
  const std::vector<Row> rows = run.rows("curve.csv");
  EXPECT_GT(rows.size(), 160u);
  Errors worst = {0, 0, 0};
  double largest = 0.0, force = 0.0;
  for (const Row &row : rows) {
    const double d = std::fmax(touch - row.at("z"), 0.0);
    largest = std::fmax(largest, d);
    force = std::fmax(force, row.at("f"));
    const double expected = law.force(d, {largest}) - sjkr_force(ced, row.at("z"), R, R);
    worst.force = std::fmax(worst.force, std::fabs(row.at("f") - expected));
    worst.elastic =
        std::fmax(worst.elastic, std::fabs(row.at("elastic") - law.elastic_energy(d, {largest})));
    worst.taken = std::fmax(worst.taken, std::fabs(row.at("taken") - law.plastic_work(largest)));
  }
  EXPECT_GT(largest, 5.0 * law.yield_overlap());
  worst.force /= force;
  worst.elastic /= law.elastic_energy(largest, {largest});
  worst.taken /= law.plastic_work(largest);
  return worst;
}

void expect_small(const char *what, const Errors &e) {
  std::printf("%s: force %.1e, elastic %.1e, taken %.1e\n", what, e.force, e.elastic, e.taken);
  EXPECT_LT(e.force, 1e-9);
  EXPECT_LT(e.elastic, 1e-9);
  EXPECT_LT(e.taken, 1e-9);
}

} // namespace

TEST(VerificationPlasticContact, SpheresFollowTheLaw) {
  expect_small("spheres", pressed(2 * R, effective_radius(R, R), elastic_otherwise()));
}

TEST(VerificationPlasticContact, SphereAndWallFollowTheLaw) {
  Settings settings = elastic_otherwise();
  settings["wall"] = "1";
  expect_small("wall", pressed(R, R, settings));
}

// At a wall the area widens as the sphere's volume demands; between spheres it does not.
TEST(VerificationPlasticContact, ASphereFlattensAtAWall) {
  Settings settings = elastic_otherwise();
  settings.insert({{"flattening", "1"}, {"down", "65000"}}); // 0.65 um, 0.82 of the radius
  settings["wall"] = "1";
  expect_small("flattened at a wall", pressed(R, R, settings, 0.0, 0.0, 1.0));
  settings.insert({{"hardening", "1e7"}});
  expect_small("the same, hardening", pressed(R, R, settings, 1e7, 0.0, 1.0));
  settings["wall"] = "0";
  settings["down"] = "10000";
  expect_small("spheres", pressed(2 * R, effective_radius(R, R), settings, 1e7));
}

// Deep overlaps: spheres go on, one that is nearly through a wall stops the run.
TEST(VerificationPlasticContact, OnlyAWallStopsASphereThatSinks) {
  Settings settings = elastic_otherwise();
  settings["down"] = "40000"; // 0.4 um, 1.01 of the effective radius
  expect_small("deep", pressed(2 * R, effective_radius(R, R), settings));
  settings["down"] = "75000"; // 0.75 um, 0.94 of the radius
  settings.insert({{"wall", "1"}, {"z0", number(R)}, {"up", "200"}, {"again", "500"}});
  const CaseRun run("plastic_contact/in.press", settings);
  EXPECT_FALSE(run.finished());
  EXPECT_NEAR(run.rows("curve.csv").back().at("z"), 0.1 * R, 1e-3); // a row every 1e-4 um
}

TEST(VerificationPlasticContact, HardeningFollowsTheLaw) {
  Settings settings = elastic_otherwise();
  settings.insert({{"hardening", "1e7"}, {"down", "4000"}});
  expect_small("hardening", pressed(2 * R, effective_radius(R, R), settings, 1e7));
}

// The limit beyond cohesion: the spheres carry p_y of a load, whatever pulls them together.
TEST(VerificationPlasticContact, TheLimitMayBeBeyondCohesion) {
  constexpr double ced = 6e5;
  Settings settings = elastic_otherwise();
  settings["ced"] = number(ced);
  settings.insert({{"beyond", "1"}, {"down", "4000"}});
  expect_small("beyond cohesion", pressed(2 * R, effective_radius(R, R), settings, 0.0, ced));
}

// Primaries of one body that were never bonded, and meet closer than at the sum of their radii.
TEST(VerificationPlasticContact, FragmentsFollowTheLaw) {
  Settings settings = elastic_otherwise();
  const double apart = 2 * R + 0.01, touch = 0.9 * 2 * R;
  settings.insert({{"body", "1"},
                   {"meet", "0.9"},
                   {"z0", number(apart)},
                   {"down", std::to_string(std::lround((apart - touch + 0.01) / 1e-5))}});
  expect_small("fragments", pressed(touch, effective_radius(R, R), settings));
}

// Thornton's coefficient of restitution, his eq. 31, from the ratio of yield speed and speed.
TEST(VerificationPlasticContact, RestitutionIsThorntons) {
  const double R_eff = 0.5 * R, m_eff = 0.5 * mass;
  const PlasticContact law(E_eff, R_eff, p_y);
  const double at_yield = std::sqrt(2.0 * hertz_energy(E_eff, R_eff, law.yield_overlap()) / m_eff);
  for (const double times : {2.0, 10.0, 40.0}) {
    Settings settings = elastic_otherwise();
    settings.insert({{"free", "1"},
                     {"vz", number(times * at_yield)},
                     {"z0", number(2 * R + 1e-9)},
                     {"down", "40000"},
                     {"every", "100"},
                     {"dt", number(3e-6 / std::sqrt(times))}});
    const CaseRun run("plastic_contact/in.press", settings);
    ASSERT_TRUE(run.finished()) << run.why();
    const std::vector<Row> rows = run.rows("curve.csv");
    const Row &last = rows.back();
    ASSERT_EQ(last.at("f"), 0.0) << "still in contact";
    const double measured = (last.at("v") - last.at("v_low")) / (times * at_yield);
    const double s = 1.0 / times;
    const double formula = std::sqrt(6.0 * std::sqrt(3.0) / 5.0) * std::sqrt(1.0 - s * s / 6.0) *
                           std::pow(s / (s + 2.0 * std::sqrt(1.2 - 0.2 * s * s)), 0.25);
    double worst = 0.0;
    const double start = 0.5 * mass * times * times * at_yield * at_yield;
    for (const Row &row : rows)
      worst = std::fmax(
          worst,
          std::fabs((row.at("kinetic") + row.at("elastic") + row.at("taken")) / start - 1.0));
    std::printf("%g times the yield speed: restitution %.7f, formula %.7f; ledger %.1e\n", times,
                measured, formula, worst);
    EXPECT_NEAR(measured, formula, 1e-5);
    EXPECT_LT(worst, 1e-5);
  }
}

// A bonded pair thrown together, by ten times the yield overlap: its contact counts from the bond's
// creation and stays Hertz.
TEST(VerificationPlasticContact, InsideABodyNothingChanges) {
  const std::vector<BodySphere> pair = {{{0, 0, 0}, R, 1, {50, 0, 0}},
                                        {{1.28, 0, 0}, R, 1, {-50, 0, 0}}};
  std::vector<std::vector<Row>> ends;
  for (const char *contact : {"hertz", "hertz_effects"}) {
    const Files files = files_of(pair, {-20, -20, -20}, {20, 20, 20});
    const CaseRun run("in.body",
                      {{"contact", contact},
                       {"yield", number(p_y)},
                       {"dt", "2e-6"},
                       {"steps", "500"},
                       {"every", "100"}},
                      1, files);
    ASSERT_TRUE(run.finished()) << run.why();
    ends.push_back(run.frames().back());
  }
  for (int n = 0; n < 2; ++n)
    for (const char *what : {"x", "vx", "fx"}) // another order of products: some ulp
      EXPECT_NEAR(ends[1][n].at(what) / ends[0][n].at(what), 1.0, 1e-12) << what;
}

// Two bodies that meet across the ranks' border: the effect acts, and the same on both.
TEST(VerificationPlasticContact, SameOnOneAndTwoRanks) {
  std::vector<std::vector<Row>> ends;
  const Files files = files_of(meeting(), {-6, -6, -6}, {6, 6, 6});
  const std::vector<std::pair<int, double>> runs = {{1, p_y}, {2, p_y}, {1, 0.0}};
  for (const auto &[ranks, yield] : runs) {
    const CaseRun run("in.body",
                      {{"contact", "hertz_effects"},
                       {"yield", number(yield)},
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
  std::printf(
      "positions: 1 and 2 ranks differ by %.1e um, with and without the effect by %.1e um\n",
      difference(0, 1), difference(0, 2));
  EXPECT_LT(difference(0, 1), 1e-9); // round-off in another order of sums, grown over the run
  EXPECT_GT(difference(0, 2), 1e-3);
}
