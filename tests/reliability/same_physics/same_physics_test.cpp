// SPDX-License-Identifier: GPL-2.0-or-later
// Requirements: README.md of this folder.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "liggghts/base/film_cuts.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double kSite = 4.0;
constexpr int kSites = 6; // per direction

double wrapped(double x, double side) { return x - side * std::floor(x / side); }

// Reproducible numbers in (-1, 1).
double noise(int n) {
  const double x = std::sin(12.9898 * n + 4.1) * 43758.5453;
  return 2.0 * (x - std::floor(x)) - 1.0;
}

// On every site of a grid that the faces of the cell and of the ranks cut, a pair in a direction of
// its own or, on each fourth, a cube of eight.
Files thrown_bodies(double between = kSite) {
  const double side = kSites * between;
  std::vector<BodySphere> all;
  int body = 0, n = 0;
  for (int site = 0; site < kSites * kSites * kSites; ++site) {
    const int column = site % kSites, row = site / kSites % kSites, layer = site / kSites / kSites;
    const Vec3 centre = {between * column, between * row, between * layer};
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
      s.x = {wrapped(s.x.x, side), wrapped(s.x.y, side), wrapped(s.x.z, side)};
      s.v = 0.4 * Vec3{noise(++n), noise(++n), noise(++n)};
      s.omega = 0.5 * Vec3{noise(++n), noise(++n), noise(++n)};
      all.push_back(s);
    }
  }
  return files_of(all, {0, 0, 0}, {side, side, side});
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
Outcome go_on(const Outcome &from, const Settings &settings, int ranks,
              const std::string &file = "half.restart") {
  Files files = {{"half.restart", contents(from.folder / file)},
                 {"bodies.map", contents(from.folder / "bodies.map")},
                 {"breaks.csv", from.breaks}};
  Settings with = settings;
  with["from"] = "restart";
  return outcome(CaseRun("in.breaks", with, ranks, files));
}

const Settings kSerial = {{"px", "1"}, {"py", "1"}, {"pz", "1"}};

Settings with(Settings more) {
  more.insert(kSerial.begin(), kSerial.end());
  return more;
}

// Rows of the log: time, tags, body and mode of each break, without stresses and places.
std::vector<std::string> events(const std::string &log) {
  std::vector<std::string> all;
  std::istringstream in(log);
  for (std::string line; std::getline(in, line);) {
    size_t end = 0;
    for (int comma = 0; comma < 5; ++comma)
      end = line.find(',', end + 1);
    all.push_back(line.substr(0, end));
  }
  return all;
}

// Bonds that broke in that step of 1e-5 us.
long breaks_in(const std::string &log, int step) {
  std::ostringstream time;
  time.precision(9);
  time << step * 1e-5 << ",";
  const std::vector<std::string> all = events(log);
  return std::count_if(all.begin(), all.end(), [&](const std::string &e) {
    return e.compare(0, time.str().size(), time.str()) == 0;
  });
}

// Numbers of final.txt, ten for each sphere: tag, place, velocity, spin.
std::vector<double> numbers(const std::string &state) {
  std::istringstream in(state.substr(state.find("omegaz") + 6));
  return {std::istream_iterator<double>(in), {}};
}

// Largest difference of places (1) or velocities (4).
double difference(const std::string &a, const std::string &b, int first) {
  const std::vector<double> p = numbers(a), q = numbers(b);
  EXPECT_EQ(p.size(), q.size());
  double most = 0.0;
  for (size_t n = 0; n < p.size() && n < q.size(); n += 10)
    for (int k = first; k < first + 3; ++k)
      most = std::fmax(most, std::fabs(p[n + k] - q[n + k]));
  return most;
}

} // namespace

TEST(SamePhysics, EnoughBreaksToCompare) {
  ASSERT_FALSE(reference().rows.empty());
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

TEST(SamePhysics, SameBitsOnAnyRanksAndGrid) {
  const char *const grids[][3] = {{"2", "1", "1"}, {"1", "1", "2"}, {"2", "2", "1"},
                                  {"1", "2", "1"}, {"3", "1", "1"}, {"1", "2", "2"}};
  const bool heavy = std::getenv("CALENDEM_HEAVY") != nullptr;
  for (int k = 0; k < (heavy ? 6 : 3); ++k) {
    const auto &g = grids[k];
    const int ranks = std::stoi(g[0]) * std::stoi(g[1]) * std::stoi(g[2]);
    const Outcome o = throw_them({{"px", g[0]}, {"py", g[1]}, {"pz", g[2]}}, ranks);
    EXPECT_EQ(o.breaks, reference().breaks) << g[0] << " x " << g[1] << " x " << g[2];
    EXPECT_EQ(o.state, reference().state) << g[0] << " x " << g[1] << " x " << g[2];
    ASSERT_EQ(o.rows.size(), reference().rows.size());
    for (size_t i = 0; i < o.rows.size(); ++i) // no bond's energy counted twice or half
      EXPECT_NEAR(o.rows[i].at("strain"), reference().rows[i].at("strain"),
                  1e-9 * reference().rows[i].at("strain"));
  }
}

// Faces move at the start of the run, and again at every build of lists.
TEST(SamePhysics, MovingTheFacesBetweenRanksChangesNoBit) {
  const Outcome o = throw_them(
      {{"px", "1"}, {"py", "1"}, {"pz", "2"}, {"balance", "1"}, {"rebuild", "every"}}, 2);
  EXPECT_EQ(o.breaks, reference().breaks);
  EXPECT_EQ(o.state, reference().state);
}

TEST(FilmCuts, LeaveEverySlabTheSameWork) {
  const std::vector<double> work = {3, 1, 1, 1, 1, 1, 0, 0}, halves = {0, 0.5, 1};
  EXPECT_EQ(calendem::busiest_slab(work, halves), 6.0 / 4.0);
  const auto cuts = calendem::cuts_of_equal_work(work, halves);
  EXPECT_EQ(cuts, (std::vector<double>{0, 0.25, 1})); // of 8 the lower two layers have 4
  EXPECT_EQ(calendem::busiest_slab(work, cuts), 1.0);
}

TEST(FilmCuts, CutWithinALayer) {
  const auto cuts = calendem::cuts_of_equal_work({2, 2, 2, 2}, {0, 0.3, 0.7, 1});
  EXPECT_NEAR(cuts[1], 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(cuts[2], 2.0 / 3.0, 1e-15);
}

TEST(FilmCuts, GoHalfOfTheWayToTheNextAtMost) {
  EXPECT_EQ(calendem::cuts_of_equal_work({1, 0, 0, 0, 0, 0, 0, 0}, {0, 0.5, 1})[1], 0.25);
  EXPECT_EQ(calendem::cuts_of_equal_work({0, 0, 0, 0, 0, 0, 0, 1}, {0, 0.5, 1})[1], 0.75);
  EXPECT_EQ(calendem::cuts_of_equal_work({0, 0}, {0, 0.4, 1})[1], 0.4); // nothing to share
}

TEST(SamePhysics, RebuildingEveryStepChangesNoBit) {
  const Outcome o = throw_them({{"px", "1"}, {"py", "1"}, {"pz", "1"}, {"rebuild", "every"}});
  EXPECT_EQ(o.breaks, reference().breaks);
  EXPECT_EQ(o.state, reference().state);
}

TEST(SamePhysics, LookingChangesNoBitOnAnyRanks) {
  for (const int ranks : {1, 2}) {
    const Outcome o =
        throw_them({{"px", std::to_string(ranks)}, {"py", "1"}, {"pz", "1"}, {"look", "1"}}, ranks);
    EXPECT_EQ(o.breaks, reference().breaks) << ranks;
    EXPECT_EQ(o.state, reference().state) << ranks;
  }
}

TEST(SamePhysics, RestartInMidDamageChangesNoBit) {
  const Outcome o = go_on(reference(), {{"px", "1"}, {"py", "1"}, {"pz", "1"}}, 1);
  EXPECT_EQ(o.breaks, reference().breaks);
  EXPECT_EQ(o.state, reference().state);
}

TEST(SamePhysics, RestartOnOtherRanksChangesNoBit) {
  const Outcome two = go_on(reference(), {{"px", "2"}, {"py", "1"}, {"pz", "1"}}, 2);
  const Outcome four = go_on(reference(), {{"px", "1"}, {"py", "2"}, {"pz", "2"}}, 4);
  for (const Outcome &o : {two, four}) {
    EXPECT_EQ(o.breaks, reference().breaks);
    EXPECT_EQ(o.state, reference().state);
  }
}

TEST(SamePhysics, PiecesWithoutASetUpAndRestartFilesChangeNoBit) {
  const Outcome once = throw_them(with({{"how", "once"}}));
  for (const char *how : {"on", "periodic"}) {
    const Outcome o = throw_them(with({{"how", how}}));
    EXPECT_EQ(o.breaks, once.breaks) << how;
    EXPECT_EQ(o.state, once.state) << how;
  }
}

// Without damping a set-up computes the forces that were there, but for bonds that broke in that
// step.
TEST(SamePhysics, TwoRunsAreOneWithoutDamping) {
  const Settings undamped = with({{"damping", "0"}, {"restitution", "1"}});
  const auto in = [&](const char *how, int half) {
    Settings s = undamped;
    s.insert({{"how", how}, {"half", std::to_string(half)}});
    return throw_them(s);
  };
  const Outcome once = in("once", 250);
  int half = 200;
  while (breaks_in(once.breaks, half) > 0)
    ++half;
  const Outcome twice = in("twice", half);
  EXPECT_EQ(twice.breaks, once.breaks) << "parted after step " << half;
  EXPECT_EQ(twice.state, once.state) << "parted after step " << half;
}

// With damping, and in a step with breaks, the force of one moment differs: half a step's kick.
TEST(SamePhysics, TwoRunsAreOneButForAKickWithDamping) {
  const auto in = [&](const char *how, int steps) {
    return throw_them(with({{"how", how}, {"steps", std::to_string(steps)}}));
  };
  const Outcome before = in("once", 250), next = in("once", 251), parted = in("twice", 251);
  EXPECT_GT(breaks_in(before.breaks, 250), 0);
  const double step = difference(before.state, next.state, 4);
  const double kick = difference(next.state, parted.state, 4);
  const Outcome once = in("once", 1500), twice = in("twice", 1500);
  const double shift = difference(once.state, twice.state, 1), time = 1250 * 1e-5;
  std::printf(
      "set-up: velocities change by %.1e um/us more or less, %.2f of a step's; 1250 steps later "
      "places by %.1e um\n",
      kick, kick / step, shift);
  EXPECT_GT(kick, 0.0);
  EXPECT_LE(kick, 0.5 * step);
  EXPECT_LE(shift, 0.5 * step * time);
  EXPECT_EQ(events(twice.breaks), events(once.breaks));
}

// `restart N` writes the file of write_restart, also in a step with breaks.
TEST(SamePhysics, PeriodicRestartIsWriteRestartOnAnyRanks) {
  const Outcome periodic = throw_them(with({{"how", "periodic"}}));
  EXPECT_GT(breaks_in(periodic.breaks, 250), 0);
  const Outcome o = go_on(periodic, kSerial, 1, "half.250.restart");
  EXPECT_EQ(o.breaks, reference().breaks);
  EXPECT_EQ(o.state, reference().state);
  EXPECT_EQ(go_on(periodic, {{"px", "2"}, {"py", "1"}, {"pz", "1"}}, 2, "half.250.restart").breaks,
            reference().breaks);
}

namespace {
// Bodies so close that surfaces of different ones press, rub and part.
Outcome press_them(const std::string &law, Settings more, int ranks = 1) {
  more.insert({{"law", law},
               {"how", "once"},
               {"steps", "3000"},
               {"contact", law == "none" || law == "collapse" ? "hertz" : "hertz_effects"}});
  return outcome(CaseRun("in.breaks", more, ranks, thrown_bodies(2.7)));
}

const std::pair<const char *, const char *> kLaws[] = {
    {"none", "hertz"}, {"plastic", "flow"}, {"viscous", "dashpots"}, {"confined", "hertz"}};
} // namespace

TEST(SamePhysics, ContactsAreTheSameOnAnyRanksAndGrid) {
  for (const auto &[law, taken] : kLaws) {
    const Outcome one = press_them(law, kSerial);
    const Outcome four = press_them(law, {{"px", "2"}, {"py", "2"}, {"pz", "1"}}, 4);
    EXPECT_EQ(four.breaks, one.breaks) << law;
    EXPECT_EQ(four.state, one.state) << law;
  }
}

// The pressure of a sphere sums the forces of its contacts.
TEST(SamePhysics, CollapseIsTheSameOnAnyRanksAndAfterRebuilds) {
  const Outcome one = press_them("collapse", kSerial);
  EXPECT_GT(difference(one.state, press_them("none", kSerial).state, 1), 1e-6) << "it does not act";
  const Outcome four = press_them("collapse", {{"px", "2"}, {"py", "2"}, {"pz", "1"}}, 4);
  const Outcome rebuilt = press_them("collapse", with({{"rebuild", "every"}}));
  for (const Outcome *o : {&four, &rebuilt}) {
    EXPECT_EQ(o->breaks, one.breaks);
    EXPECT_EQ(o->state, one.state);
  }
}

// The two add the same pairs' forces, one as whole numbers, one as doubles in the order of its
// list.
TEST(SamePhysics, OnePassGivesTheHostsForces) {
  std::string first;
  for (const auto &[law, taken] : kLaws) {
    const Outcome host = press_them(law, with({{"fused", "off"}}));
    const Outcome one = press_them(law, with({{"fused", "on"}}));
    const double apart = difference(one.state, host.state, 1);
    std::printf("%s: places differ by %.1e um after 3000 steps\n", law, apart);
    EXPECT_EQ(events(one.breaks), events(host.breaks)) << law;
    EXPECT_LE(apart, 1e-9) << law;
    ASSERT_FALSE(host.rows.empty()) << law;
    ASSERT_EQ(one.rows.size(), host.rows.size()) << law;
    for (const auto &[term, value] : host.rows[1])
      EXPECT_NEAR(one.rows[1].at(term), value, 1e-12 * std::fabs(value)) << law << " " << term;
    const Row &end = host.rows.back();
    for (const char *term : {"broken", "damped", "rubbed", taken})
      EXPECT_GT(end.at(term), 0.0) << law << " " << term;
    EXPECT_NE(host.state, first) << law << " does not act";
    first = first.empty() ? host.state : first;
  }
}
