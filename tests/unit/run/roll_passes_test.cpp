// SPDX-License-Identifier: GPL-2.0-or-later
// Line loads of passes against the closed form of a linear film; the search for the gap of a line
// load.
#include "base/case.h"
#include "base/provenance.h"
#include "base/random.h"
#include "physics/roll_nip.h"
#include "simulate/collect.h"
#include "simulate/rolling.h"
#include "support/test_folder.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace calendem;

constexpr double kRadius = 2e5, kStart = 60.0, kFilm = 58.0, kStiffness = 10.0; // um, MPa/um

Settings rolling_case(const std::string &tables) {
  const std::string file = (calendem_test::test_folder() / "case.toml").string();
  write_file(file, "electrode = \"electrode\"\n" + tables);
  return read_case(file);
}

// One pass of that gap over a film that springs back all the way, or not at all.
void add_pass(std::vector<RawRow> &rows, double gap, bool springs) {
  const RollNip nip = {kRadius, kRadius, 0.0};
  const double way = nip.distance(kStart - gap);
  for (int n = -400; n <= 400; ++n) {
    RawRow r = {};
    r.stage = n <= 0 ? 1 : 3;
    r.gap = gap + nip.above(way * n / 400.0);
    r.displacement = kStart - r.gap;
    r.p_top = n > 0 && !springs ? 0.0 : kStiffness * std::max(kFilm - r.gap, 0.0);
    rows.push_back(r);
  }
}

} // namespace

// Requirement: a film of pressure k (h0 - h) takes q = (2/3) k (h0 - h_min) s0 on each side of the
// nip, s0 = sqrt(2 R (h0 - h_min)); the trapezoid of rows ds apart is off by (ds/s0)^2 at most.
TEST(RollPasses, LineLoadOfALinearFilm) {
  const Settings s = rolling_case("[platen]\ncontrol = \"roll_gap\"\nroll_gap_um = 50\n[roll]\n"
                                  "passes = 2\nfirst_gap_um = 54\n");
  std::vector<RawRow> rows;
  add_pass(rows, 54.0, true);
  add_pass(rows, 50.0, false);
  const nlohmann::json roll = roll_passes(rows, s);
  ASSERT_EQ(roll["passes"].size(), 2u);
  int n = 0;
  for (const double gap : {54.0, 50.0}) {
    const nlohmann::json &pass = roll["passes"][n++];
    const double s0 = std::sqrt(kRadius * (kFilm - gap)); // two equal rolls: R / 2
    const double in = 1e-3 * 2.0 / 3.0 * kStiffness * (kFilm - gap) * s0;
    const double error = std::pow(1.5 / 400.0, 2);
    EXPECT_NEAR(pass["line_load_before_the_nip_N_mm"].get<double>() / in, 1.0, error);
    if (gap == 54.0)
      EXPECT_NEAR(pass["line_load_N_mm"].get<double>() / in, 2.0, 0.01); // of the row in the nip
    EXPECT_DOUBLE_EQ(pass["gap_um"], gap);
    EXPECT_DOUBLE_EQ(pass["max_pressure_MPa"], kStiffness * (kFilm - gap));
  }
  const double web = 1.0 / std::sqrt(2.0 * (kStart - 50.0) / (0.5 * kRadius)); // v = s u / R
  EXPECT_NEAR(roll["web_speed_of_the_run_m_s"].get<double>() / web, 1.0, 1e-12);
  EXPECT_NEAR(roll["run_faster_by"].get<double>() / (web / (0.5 / 60.0)), 1.0, 1e-12);
}

// Requirement: what a roll cannot do is refused, all of it at once.
TEST(RollPasses, CaseIsChecked) {
  try {
    rolling_case(
        "[platen]\ncontrol = \"roll_gap\"\nroll_gap_um = 50\ndwell_us = 1\npresses = 2\n[roll]\n"
        "first_gap_um = 40\n[effects.machine_compliance]\num_per_MPa = 0.01\n");
    FAIL() << "the case was taken";
  } catch (const std::exception &e) {
    for (const char *said :
         {"roll.first_gap_um is 40, below platen.roll_gap_um = 50",
          "does not stand still in the nip", "a roll goes over the film roll.passes times",
          "is the gap of the loaded rolls"})
      EXPECT_NE(std::string(e.what()).find(said), std::string::npos) << e.what();
  }
  try {
    rolling_case("[roll]\nline_load_N_mm = 100\npasses = 2\n");
    FAIL() << "the case was taken";
  } catch (const std::exception &e) {
    EXPECT_NE(std::string(e.what()).find("only a roll has a line load"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("goes down platen.presses times"), std::string::npos);
  }
}

// Requirement: the load is met from any gap to begin with, above the film or deep in it; at once
// where it grows as the square of the depth.
TEST(LineLoad, GapIsFound) {
  const double touch = 58.0, lowest = 30.0, asked = 100.0;
  const auto hertz = [&](double gap) { return 3.0 * std::pow(std::max(touch - gap, 0.0), 2); };
  const auto stiff = [&](double gap) { return 5.0 * std::expm1(0.6 * std::max(touch - gap, 0.0)); };
  const auto runs = [&](const auto &film, double gap) {
    std::vector<TrialPassage> done;
    while (std::fabs(film(gap) / asked - 1.0) > 0.02 && done.size() < 100) {
      done.push_back({gap, film(gap), std::max(touch, gap)});
      gap = next_gap(done, asked, lowest);
      EXPECT_GT(gap, lowest);
    }
    return done.size() + 1;
  };
  for (const double gap : {31.0, 45.0, 50.0, 53.0, 57.5, 59.0}) {
    EXPECT_LE(runs(hertz, gap), gap < touch ? 2u : 4u) << "from " << gap;
    EXPECT_LE(runs(stiff, gap), kMostTrials) << "from " << gap;
    std::printf("from %g um: %zu and %zu runs\n", gap, runs(hertz, gap), runs(stiff, gap));
  }
}

// Requirement: runs count as their mean where a narrower gap carried less. The loads are those of a
// film of 6 x 6 um; 40 is looked for.
TEST(LineLoad, ARunThatCarriedMoreByChanceIsNoBound) {
  std::vector<TrialPassage> done = {{13.35, 41.0, 15.6}, {13.4, 36.0, 15.6}, {13.3, 37.0, 15.6}};
  // 13.35 and 13.3 um carry sqrt(41 * 37) = 38.95 at 13.325; nothing carries 40
  const double depth = (15.6 - 13.325) * std::sqrt(40.0 / std::sqrt(41.0 * 37.0));
  EXPECT_NEAR(next_gap(done, 40.0, 9.3), 15.6 - depth, 1e-12);
  done.push_back({13.2, 44.0, 15.6});
  const double part =
      std::log(40.0 / std::sqrt(41.0 * 37.0)) / std::log(44.0 / std::sqrt(41.0 * 37.0));
  EXPECT_NEAR(next_gap(done, 40.0, 9.3), 13.325 - part * (13.325 - 13.2), 1e-12);
}

// Requirement: a load that scatters by 4 % from run to run, twice the tolerance, is met. A run at the
// mean's gap meets it with a probability of 0.38 (a normal deviate below half its standard
// deviation), one at a gap that is known as badly as that of two runs, with 0.32. Three runs find the
// place: 0.68^9 = 3 % of the searches meet nothing in nine more, of 400 12 +- 3.5; 23 is three of
// these more.
TEST(LineLoad, IsFoundAmongRunsThatScatter) {
  const double touch = 15.6, asked = 40.0;
  int missed = 0;
  for (int seed = 0; seed < 400; ++seed) {
    Random random(std::uint64_t(seed), 7);
    std::vector<TrialPassage> done;
    double gap = 14.0, load = 0.0;
    while (std::fabs(load / asked - 1.0) > 0.02 && done.size() < kMostTrials) {
      load = 5.0 * std::expm1(0.9 * (touch - gap)) * std::exp(0.04 * random.normal());
      done.push_back({gap, load, touch});
      gap = next_gap(done, asked, 9.3);
    }
    missed += std::fabs(load / asked - 1.0) > 0.02;
  }
  std::printf("%d of 400 searches met nothing\n", missed);
  EXPECT_LE(missed, 23);
}
