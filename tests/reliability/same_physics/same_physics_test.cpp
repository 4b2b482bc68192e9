// SPDX-License-Identifier: GPL-2.0-or-later
// Requirements: README.md of this folder.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

constexpr double kSite = 4.0, kSide = 24.0;
constexpr int kSites = 6; // per direction

double wrapped(double x) { return x - kSide * std::floor(x / kSide); }

// Reproducible numbers in (-1, 1).
double noise(int n) {
  const double x = std::sin(12.9898 * n + 4.1) * 43758.5453;
  return 2.0 * (x - std::floor(x)) - 1.0;
}

// On every site of a grid that the faces of the cell and of the ranks cut, a pair in a direction of
// its own or, on each fourth, a cube of eight.
Files thrown_bodies() {
  std::vector<BodySphere> all;
  int body = 0, n = 0;
  for (int site = 0; site < kSites * kSites * kSites; ++site) {
    const Vec3 centre = {kSite * (site % kSites), kSite * (site / kSites % kSites),
                         kSite * (site / kSites / kSites)};
    ++body;
    std::vector<BodySphere> made;
    if (site % 4 == 0) {
      made = cube(2, 1.28, centre - Vec3{0.64, 0.64, 0.64}, body);
    } else {
      const Vec3 way = {noise(++n), noise(++n), noise(++n)};
      const Vec3 half = (0.64 / norm(way)) * way;
      made = {{centre + half, 0.795, body}, {centre - half, 0.795, body}};
    }
    for (BodySphere &s : made) {
      s.x = {wrapped(s.x.x), wrapped(s.x.y), wrapped(s.x.z)};
      s.v = 0.4 * Vec3{noise(++n), noise(++n), noise(++n)};
      s.omega = 0.5 * Vec3{noise(++n), noise(++n), noise(++n)};
      all.push_back(s);
    }
  }
  return files_of(all, {0, 0, 0}, {kSide, kSide, kSide});
}

struct Outcome {
  std::string breaks, state;
  std::vector<Row> rows;
  std::filesystem::path folder;
};

Outcome outcome(const CaseRun &run) {
  EXPECT_TRUE(run.finished()) << run.why();
  Outcome o{run.text("breaks.csv"), run.text("final.txt"), run.rows("curve.csv"), run.folder()};
  for (const Row &r : o.rows)
    EXPECT_EQ(r.at("made"), r.at("intact") + r.at("broken"));
  return o;
}

Outcome throw_them(const Settings &settings, int ranks = 1) {
  return outcome(CaseRun("in.breaks", settings, ranks, thrown_bodies()));
}

const Outcome &reference() {
  static const Outcome o = throw_them({{"px", "1"}, {"py", "1"}, {"pz", "1"}});
  return o;
}

long lines(const std::string &text) { return std::count(text.begin(), text.end(), '\n'); }

std::string contents(const std::filesystem::path &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// Goes on from another run's restart file.
Outcome go_on(const Outcome &from, const Settings &settings, int ranks) {
  Files files = {{"half.restart", contents(from.folder / "half.restart")},
                 {"bodies.map", contents(from.folder / "bodies.map")},
                 {"breaks.csv", from.breaks}};
  Settings with = settings;
  with["from"] = "restart";
  return outcome(CaseRun("in.breaks", with, ranks, files));
}

} // namespace

TEST(SamePhysics, EnoughBreaksToCompare) {
  EXPECT_EQ(reference().rows.front().at("made"), 54 * 12 + 162);
  const long breaks = lines(reference().breaks) - 1;
  std::printf("%ld of %g bonds broken\n", breaks, reference().rows.front().at("made"));
  EXPECT_GE(breaks, 200);
  const std::string &log = reference().breaks;
  const long before = lines(log.substr(0, log.find("\n0.0025")));
  std::printf("%ld of them before the restart file\n", before);
  EXPECT_GT(before, 100);
  EXPECT_GT(breaks - before, 100);
}

TEST(SamePhysics, SameBreaksOnEveryProcessorGrid) {
  const char *const grids[][3] = {{"2", "1", "1"}, {"1", "1", "2"}, {"2", "2", "1"},
                                  {"1", "2", "1"}, {"3", "1", "1"}, {"1", "2", "2"}};
  const bool heavy = std::getenv("CALENDEM_HEAVY") != nullptr;
  for (int k = 0; k < (heavy ? 6 : 3); ++k) {
    const auto &g = grids[k];
    const int ranks = std::stoi(g[0]) * std::stoi(g[1]) * std::stoi(g[2]);
    const Outcome o = throw_them({{"px", g[0]}, {"py", g[1]}, {"pz", g[2]}}, ranks);
    EXPECT_EQ(o.breaks, reference().breaks) << g[0] << " x " << g[1] << " x " << g[2];
    ASSERT_EQ(o.rows.size(), reference().rows.size());
    for (size_t i = 0; i < o.rows.size(); ++i) // no bond's energy counted twice or half
      EXPECT_NEAR(o.rows[i].at("strain"), reference().rows[i].at("strain"),
                  1e-9 * reference().rows[i].at("strain"));
  }
}

TEST(SamePhysics, RebuildingEveryStepChangesNoBit) {
  const Outcome o = throw_them({{"px", "1"}, {"py", "1"}, {"pz", "1"}, {"rebuild", "every"}});
  EXPECT_EQ(o.breaks, reference().breaks);
  EXPECT_EQ(o.state, reference().state);
}

TEST(SamePhysics, LookingChangesNoBit) {
  const Outcome o = throw_them({{"px", "1"}, {"py", "1"}, {"pz", "1"}, {"look", "1"}});
  EXPECT_EQ(o.breaks, reference().breaks);
  EXPECT_EQ(o.state, reference().state);
}

TEST(SamePhysics, RestartInMidDamageChangesNoBit) {
  const Outcome o = go_on(reference(), {{"px", "1"}, {"py", "1"}, {"pz", "1"}}, 1);
  EXPECT_EQ(o.breaks, reference().breaks);
  EXPECT_EQ(o.state, reference().state);
}

TEST(SamePhysics, RestartOnOtherRanksGivesTheSameBreaks) {
  EXPECT_EQ(go_on(reference(), {{"px", "2"}, {"py", "1"}, {"pz", "1"}}, 2).breaks,
            reference().breaks);
  EXPECT_EQ(go_on(reference(), {{"px", "1"}, {"py", "2"}, {"pz", "2"}}, 4).breaks,
            reference().breaks);
}
