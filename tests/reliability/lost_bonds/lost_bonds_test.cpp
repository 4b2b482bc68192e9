// SPDX-License-Identifier: GPL-2.0-or-later
// Requirements: README.md of this folder.
#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

const Settings kUnbreakable = {{"breakable", "no"}};
const Settings kTooStrong = {{"breakable", "yes"}, {"sc", "1e20"}, {"tc", "1e20"}}; // kPa

// No rows and no states until the end: nothing asks the program for its bonds meanwhile.
Settings unasked(Settings settings) {
  settings.insert({{"every", "1000000"}, {"ced", "0"}, {"friction", "0"}});
  return settings;
}

// A pair whose right sphere is drawn away; with two ranks each has one of them.
CaseRun draw(double speed, const Settings &settings, int ranks = 1) {
  Files files =
      files_of({{{-0.64, 0, 0}, 0.795, 1}, {{0.64, 0, 0}, 0.795, 1}}, {-20, -6, -6}, {20, 6, 6});
  files["start.in"] += "unfix integrate\ngroup right id 2\nvelocity right set " + number(speed) +
                       " 0 0 units box\nfix mv right move linear " + number(speed) +
                       " 0 0 units box\n";
  Settings all = unasked(settings);
  all.insert({{"dt", "1e-4"},
              {"steps", number(1000.0 + 5e3 / speed)},
              {"gx", std::to_string(ranks)},
              {"gy", "1"},
              {"gz", "1"}});
  return CaseRun("in.body", all, ranks, files);
}

bool says(const CaseRun &run, const std::string &words) {
  const std::string log = run.why();
  const size_t error = log.find("ERROR: ");
  return error != std::string::npos && log.find(words, error) != std::string::npos;
}

} // namespace

TEST(LostBonds, DrawnOutOfRangeIsAnError) {
  for (const Settings &bond : {kUnbreakable, kTooStrong}) {
    const CaseRun slowly = draw(5.0, bond);
    EXPECT_FALSE(slowly.finished());
    EXPECT_TRUE(says(slowly, "an intact bond is stretched to 1.078")) << slowly.why();
    for (const double speed : {1e3, 1e4}) { // from within the range to beyond it in one step
      const CaseRun at_once = draw(speed, bond);
      EXPECT_FALSE(at_once.finished());
      EXPECT_TRUE(says(at_once, "0 of 1 intact bonds acted")) << at_once.why();
    }
  }
}

TEST(LostBonds, DrawnApartByTwoRanksIsAnError) {
  EXPECT_TRUE(says(draw(5.0, kUnbreakable, 2), "an intact bond is stretched to 1.078"));
  EXPECT_TRUE(says(draw(1e4, kUnbreakable, 2), "0 of 1 intact bonds acted"));
}

// In the last steps of a run, in which the lists are not built again and ranks do not meet.
TEST(LostBonds, DrawnOutOfRangeAtTheEndOnOneAndTwoRanksIsAnError) {
  for (const int ranks : {1, 2}) {
    Files files =
        files_of({{{-0.64, 0, 0}, 0.795, 1}, {{0.64, 0, 0}, 0.795, 1}}, {-20, -6, -6}, {20, 6, 6});
    files["start.in"] += "unfix integrate\ngroup right id 2\nvelocity right set 80 0 0 units box\n"
                         "fix mv right move linear 80 0 0 units box\n";
    for (const Settings &bond : {kUnbreakable, kTooStrong}) {
      Settings settings = unasked(bond);
      settings.insert({{"dt", "1e-4"},
                       {"steps", "90"},
                       {"skin", "4"},
                       {"gx", std::to_string(ranks)},
                       {"gy", "1"},
                       {"gz", "1"}});
      const CaseRun run("in.body", settings, ranks, files);
      EXPECT_FALSE(run.finished()) << ranks << " ranks";
      EXPECT_TRUE(says(run, "an intact bond is stretched to")) << run.why();
    }
  }
}

// Each is an error that says why; in the second way a layer of the body leaves through a face.
TEST(LostBonds, SpheresThatAreGoneAreNamed) {
  const std::vector<BodySphere> body = cube(3, 1.28, {-1.28, -1.28, -1.28}, 1);
  const std::pair<const char *, const char *> ways[] = {
      {"run 10\ngroup some id 1 2 3\ndelete_atoms group some compress no\n",
       "3 spheres are gone since all of them did"},
      {"velocity all set -500 0 0 units box\n", "9 spheres are gone since all of them did"},
      {"run 10\ngroup some id 1 2 3\nneigh_modify exclude group some all\n",
       "'neigh_modify exclude' leaves pairs out of the lists"}};
  for (const auto &[way, words] : ways) {
    Files files = files_of(body, {-3, -20, -20}, {20, 20, 20});
    files["start.in"] += way;
    const CaseRun run("in.body", unasked({{"steps", "1000"}, {"dt", "1e-5"}}), 1, files);
    EXPECT_FALSE(run.finished());
    EXPECT_TRUE(says(run, words)) << run.why();
  }
}

TEST(LostBonds, ABondThatBreaksInTimeIsLoggedOnOneAndTwoRanks) {
  for (const double speed : {5.0, 1e3})
    for (const int ranks : {1, 2}) {
      const CaseRun run = draw(speed, {{"breakable", "yes"}}, ranks);
      EXPECT_TRUE(run.finished()) << run.why();
      EXPECT_EQ(run.rows("breaks.csv").size(), 1u);
    }
}

// The body explodes; just above the bound slowly enough to be seen by its forces, then beyond the
// range of histories at once.
TEST(LostBonds, AnUnstableStepIsAnError) {
  std::vector<BodySphere> body = cube(3, 1.28, {-1.28, -1.28, -1.28}, 1);
  body[0].v = {0.1, 0.2, 0.3};
  const std::pair<const char *, const char *> cases[] = {
      {"1.5", "more than the units of its sum hold"},
      {"3", " of 54 intact bonds acted"},
      {"10", " of 54 intact bonds acted"}};
  for (const Settings &bond : {kUnbreakable, kTooStrong})
    for (const auto &[step, words] : cases) {
      Settings all = unasked(bond);
      all.insert({{"of_bound", step}, {"steps", "2000"}});
      const CaseRun run("in.body", all, 1, files_of(body, {-20, -20, -20}, {20, 20, 20}));
      EXPECT_FALSE(run.finished()) << step;
      EXPECT_TRUE(says(run, words)) << step << " times the bound: " << run.why();
    }
}

// With other pages the host forgets histories at the next set-up and says nothing.
TEST(LostBonds, PagesThatForgetHistoriesAreRefused) {
  Files files = files_of(cube(3, 1.28, {-1.28, -1.28, -1.28}, 1), {-20, -20, -20}, {20, 20, 20});
  files["start.in"] += "neigh_modify one 500 page 50000\n";
  const CaseRun run("in.body", unasked({{"steps", "10"}}), 1, files);
  EXPECT_FALSE(run.finished());
  EXPECT_NE(run.why().find("ERROR: 'neigh_modify one 500 page 50000' after a run with"),
            std::string::npos)
      << run.why();
}
