// SPDX-License-Identifier: GPL-2.0-or-later
// Requirements: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

constexpr double R = 0.795, kLength = 1.28;

// True if the error that ended the run has these words.
bool says(const CaseRun &run, const std::string &words) {
  const std::string log = run.why();
  const size_t error = log.find("ERROR: ");
  return !run.finished() && error != std::string::npos &&
         log.find(words, error) != std::string::npos;
}

// A pair of body 1 that stays and one of body 7 that is torn apart in the first steps.
Files two_pairs() {
  return files_of({{{0, 0, 0}, R, 1},
                   {{kLength, 0, 0}, R, 1},
                   {{0, 4, 0}, R, 7, {-50, 0, 0}},
                   {{kLength, 4, 0}, R, 7, {50, 0, 0}}},
                  {-20, -6, -6}, {20, 10, 6});
}

Settings breakable() {
  return {{"breakable", "yes"}, {"dt", "1e-4"}, {"steps", "20"},
          {"every", "10"},      {"ced", "0"},   {"skin", "1"}};
}

const char *const kBodies = "compute bodies all bond/bpm/body\n"
                            "variable intact equal c_bodies[1][1]\n"
                            "variable broken equal c_bodies[7][2]\n"
                            "fix bodies_out all print 10 \"${intact},${broken}\" file bodies.csv "
                            "screen no title intact,broken\n";

constexpr double kDwell = 0.05; // us

// How long the platen stays, by the steps that it takes.
struct Dwell {
  double lasted = 0.0, passed = 0.0, clock = 0.0; ///< in the dwell; in all; what the plugin counts
};

Dwell dwell_of(const CaseRun &run, Dwell so_far = {}, double last_step = HUGE_VAL) {
  EXPECT_TRUE(run.finished()) << run.why();
  for (const Row &row : run.rows("dwell.csv")) {
    if (row.at("step") > last_step)
      break;
    so_far.passed += row.at("dt");
    so_far.lasted += row.at("stage") == 2.0 ? row.at("dt") : 0.0;
    so_far.clock = row.at("clock");
  }
  return so_far;
}

// A sphere that the platen presses and holds; `meanwhile` is done in the dwell.
CaseRun hold(const std::string &meanwhile, Settings settings = {}, const Files &more = {}) {
  Files files = files_of({{{2.5, 2.5, R}, R, 1}}, {0, 0, -0.1}, {5, 5, 4});
  files["meanwhile.in"] = meanwhile + "# goes on\n";
  for (const auto &f : more)
    files[f.first] = f.second;
  settings.insert({{"friction", "0"}, {"ced", "0"}, {"dwell", number(kDwell)}});
  return CaseRun("../reliability/between_runs/in.dwell", settings, 1, files);
}

} // namespace

// Rows of a body stay when its spheres are gone, through a restart too.
TEST(BetweenRuns, SpheresOfTheLastBodyAreDeleted) {
  Files files = two_pairs();
  files["start.in"] += std::string(kBodies) +
                       "run 20\ngroup torn id 3 4\ndelete_atoms group torn compress no\nrun 20\n"
                       "write_restart half.restart\n";
  const CaseRun run("in.body", breakable(), 1, files);
  ASSERT_TRUE(run.finished()) << run.why();
  Settings again = breakable();
  again["restart"] = "1";
  const CaseRun restarted("in.body", again, 1,
                          {{"half.restart", run.text("half.restart")},
                           {"bodies.map", run.text("bodies.map")},
                           {"start.in", kBodies}});
  ASSERT_TRUE(restarted.finished()) << restarted.why();
  for (const CaseRun *each : {&run, &restarted}) {
    EXPECT_EQ(each->rows("bodies.csv").back().at("intact"), 1.0);
    EXPECT_EQ(each->rows("bodies.csv").back().at("broken"), 1.0);
  }
}

// The dwell ends in the first step in which it is over, and time never goes back.
TEST(BetweenRuns, StepsOfAnotherLengthOrNumberTakeTheirTime) {
  for (const char *change : {"", "timestep 5e-5\n", "reset_timestep 0\n", "reset_timestep 100000\n",
                             "timestep 5e-5\nreset_timestep 7\ntimestep 2e-5\n"}) {
    const Dwell d = dwell_of(hold(change));
    EXPECT_NEAR(d.lasted, kDwell, 1.5e-4) << change;
    EXPECT_NEAR(d.clock, d.passed, 1e-9) << change;
  }
}

// Nobody tells LIGGGHTS' integrators of a new step there.
TEST(BetweenRuns, AStepOfAnotherLengthWithoutASetUpIsRefused) {
  for (const char *change : {"run 10 pre no\n", "timestep 5e-5\nrun 10 pre no\n"}) {
    const CaseRun run = hold(change);
    EXPECT_EQ(run.finished(), change[0] == 'r') << run.why();
    if (!run.finished()) {
      EXPECT_NE(run.why().find("time step was changed before 'run ... pre no'"), std::string::npos)
          << run.why();
    }
  }
}

// The host's fix sets the step anew in the middle of a run, and tells the others.
TEST(BetweenRuns, StepsThatChangeInARunTakeTheirTime) {
  const Dwell d = dwell_of(hold("fix step all dt/reset 50 NULL 5e-5 1 units box\n"));
  EXPECT_NEAR(d.lasted, kDwell, 1.5e-4);
  EXPECT_NEAR(d.clock, d.passed, 1e-9);
}

TEST(BetweenRuns, ARestartWithAnotherStepTakesItsTime) {
  const CaseRun first = hold("write_restart half.restart\n");
  const CaseRun again =
      hold("", {{"from", "1"}, {"dt", "5e-5"}}, {{"half.restart", first.text("half.restart")}});
  const Dwell d = dwell_of(again, dwell_of(first, {}, 400));
  EXPECT_NEAR(d.lasted, kDwell, 1.5e-4);
  EXPECT_NEAR(d.clock, d.passed, 1e-9);
}

// Two spheres at rest whose pressure leads all the way to the floor. Updates every 50 steps, with a
// change in the middle of an interval; `time`: at the last one.
TEST(BetweenRuns, NanoporesFollowForTheTimeThatPasses) {
  const std::pair<const char *, double> changes[] = {
      {"", 150e-4}, {"timestep 2e-4\n", 75e-4 + 150e-4}, {"reset_timestep 10\n", (75 + 40) * 1e-4}};
  for (const auto &[change, time] : changes) {
    Files files = files_of({{{0, 0, 0}, R, 1}, {{1.5, 0, 0}, R, 2}}, {-4, -4, -4}, {6, 4, 4});
    files["start.in"] +=
        "unfix integrate\nfix collapse all cbd/collapse type 1 initial 0.5 floor 0.27 "
        "yield 0 hardening 1e-3 relaxation 0.1\nrun 75\n" +
        std::string(change) +
        "variable phi equal f_collapse[1]\n"
        "fix phi_out all print 1 \"${phi}\" file phi.csv screen no title phi\n";
    const CaseRun run(
        "in.body", {{"Ey", "2e6"}, {"ced", "0"}, {"bonded", "0"}, {"dt", "1e-4"}, {"steps", "75"}},
        1, files);
    ASSERT_TRUE(run.finished()) << run.why();
    EXPECT_NEAR(run.rows("phi.csv").back().at("phi"), 0.27 + 0.23 * std::exp(-time / 0.1), 1e-12)
        << change;
  }
}

// The state of every style of the plugin that has one, found under no fix of the script.
TEST(BetweenRuns, ARestartUnderAnotherIdIsRefused) {
  const CaseRun first = hold("write_restart half.restart\n");
  for (const char *fix : {"bonds", "platen", "energy", "collapse"}) {
    const CaseRun again =
        hold("", {{"from", "1"}, {fix, "other"}}, {{"half.restart", first.text("half.restart")}});
    EXPECT_TRUE(says(again, "under the ID '" + std::string(fix) + "'")) << again.why();
    EXPECT_TRUE(says(again, "Name the fix '" + std::string(fix) + "'"));
    EXPECT_TRUE(says(again, "'other' begin anew"));
  }
}

// The first value of fix bond/bpm's record tells the version; the next one, 1, that bonds are made.
TEST(BetweenRuns, ARestartOfAnotherVersionIsRefused) {
  const CaseRun first = hold("write_restart half.restart\n");
  std::string file = first.text("half.restart");
  const double begins[] = {3.0, 1.0}, older = 2.0;
  const size_t place =
      file.find(std::string(reinterpret_cast<const char *>(begins), sizeof begins));
  ASSERT_NE(place, std::string::npos);
  file.replace(place, sizeof older, reinterpret_cast<const char *>(&older), sizeof older);
  EXPECT_TRUE(says(hold("", {{"from", "1"}}, {{"half.restart", file}}), "another version"));
}

// The host drops the states that nobody has asked for when the first run begins.
TEST(BetweenRuns, AFixThatComesAfterTheFirstRunOfARestartHasLostItsState) {
  const std::string wall = "wall/gran/platen model hertz tangential history primitive type 1 ";
  for (const std::string &style :
       {std::string("energy/bpm"), std::string("cbd/collapse type 1 yield 0 hardening 1e9"),
        wall + "zplane -5.0 side bottom motion hold average 0.05"}) {
    const std::string fix = "fix late all " + style + "\n";
    Files files = two_pairs();
    Settings settings = breakable();
    settings.insert({{"bx", "p"}, {"by", "p"}});
    files["start.in"] = fix + "run 10\nwrite_restart half.restart\n";
    const CaseRun first("in.body", settings, 1, files);
    EXPECT_TRUE(first.finished()) << first.why(); // without a state to lose it may come late
    settings["restart"] = "1";
    const CaseRun late("in.body", settings, 1,
                       {{"half.restart", first.text("half.restart")},
                        {"bodies.map", first.text("bodies.map")},
                        {"start.in", fix}});
    EXPECT_TRUE(says(late, "under the ID 'late', which no fix of the script took")) << late.why();
    EXPECT_TRUE(says(late, "define it before that run"));
  }
}

// The largest sphere is deleted before the restart file is written: a run that goes on from it still
// rounds forces to the units that follow from that sphere, to the last bit of every force.
TEST(BetweenRuns, TheLargestSphereOfAllGoesOnThroughARestart) {
  Files files = files_of({{{0, 0, 0}, R, 0, {0.3, 0.1, 0}},
                          {{1.57, 0, 0}, R, 0, {-0.3, 0, 0.2}},
                          {{0, 20, 0}, 10 * R, 0}},
                         {-20, -6, -20}, {20, 40, 20});
  files["start.in"] += "run 10\ngroup large id 3\ndelete_atoms group large compress no\nrun 10\n"
                       "write_restart half.restart\n";
  Settings settings = breakable();
  settings["bonded"] = "0";
  settings["dt"] = "1e-6";
  const CaseRun run("in.body", settings, 1, files);
  ASSERT_TRUE(run.finished()) << run.why();
  settings["restart"] = "1";
  const CaseRun again("in.body", settings, 1,
                      {{"half.restart", run.text("half.restart")},
                       {"bodies.map", run.text("bodies.map")},
                       {"start.in", "# goes on\n"}});
  ASSERT_TRUE(again.finished()) << again.why();
  ASSERT_EQ(run.frames().size(), 3u);
  EXPECT_GT(std::fabs(run.frames().back()[0].at("fx")), 1e3);
  EXPECT_EQ(again.text("spheres.dump"), run.text("spheres.dump"));
}

TEST(BetweenRuns, MinimizeIsRefused) {
  Files files = two_pairs();
  files["start.in"] += "run 10\ncompute thermo_pe all pe\nmin_style cg\nminimize 0 0 50 50\n";
  EXPECT_TRUE(says(CaseRun("in.body", breakable(), 1, files), "'minimize' does not know"));
}

TEST(BetweenRuns, BondsWithoutTheirForceAreRefused) {
  Files files = two_pairs();
  files["start.in"] += "pair_style gran model hertz tangential history surface bpm\n"
                       "pair_coeff * *\n";
  EXPECT_TRUE(says(CaseRun("in.body", breakable(), 1, files), "write 'cohesion bpm surface bpm'"));
}
