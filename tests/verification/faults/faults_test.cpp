// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "meeting.h"
#include "physics/hertz_contact.h"
#include "physics/hertz_mindlin.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr int kSteps = 4000;
const char *const kStrength = "4e4"; // kPa

struct Grid {
  int ranks;
  const char *x, *y, *z;
};
const Grid kGrids[] = {{1, "1", "1", "1"},
                       {2, "2", "1", "1"},
                       {2, "1", "2", "1"},
                       {4, "2", "2", "1"},
                       {4, "4", "1", "1"}};

Settings with(Settings settings, const Grid &g) {
  settings.insert({{"gx", g.x}, {"gy", g.y}, {"gz", g.z}});
  return settings;
}

// The two bodies of case 12, with bonds that break.
CaseRun meet(Settings settings, int ranks = 1, const std::string &more = "") {
  settings.insert({{"breakable", "yes"},
                   {"sc", kStrength},
                   {"tc", kStrength},
                   {"weibull", "5"},
                   {"dt", "2e-5"},
                   {"steps", std::to_string(kSteps)},
                   {"every", std::to_string(kSteps)}});
  Files files = files_of(meeting(), {-6, -6, -6}, {6, 6, 6});
  files["start.in"] += more;
  return CaseRun("in.body", settings, ranks, files);
}

constexpr int kChains = 36, kBonds = 8, kStretch = 400;

// Chains of bonds of scattered strength across all domains, every bond stretched alike. The motion
// is prescribed: breaks do not change it, so the whole log is exact.
Files chains() {
  std::vector<BodySphere> all;
  for (int c = 0; c < kChains; ++c)
    for (int k = 0; k <= kBonds; ++k) {
      const int column = c % 6, row = c / 6;
      all.push_back(
          {{(k - 0.5 * kBonds) * 1.28, 3.0 * column - 7.4, 3.0 * row - 7.4}, 0.795, c + 1});
    }
  return files_of(all, {-9, -9, -9}, {9, 9, 9});
}

std::string pull() {
  const double rate = 1.6e-3 / (kStretch * 1e-4);
  return "unfix integrate\nvariable v atom " + number(rate) +
         "*x\nfix pull all move variable NULL NULL NULL v_v NULL NULL units box\n";
}

CaseRun stretch(Settings settings, int ranks, const Files &files) {
  settings.insert({{"Ey", "1e3"},
                   {"friction", "0"},
                   {"ced", "0"},
                   {"breakable", "yes"},
                   {"weibull", "5"},
                   {"seed", "3"},
                   {"skin", "0.15"},
                   {"dt", "1e-4"},
                   {"steps", std::to_string(kStretch)},
                   {"every", "50"}});
  return CaseRun("in.body", settings, ranks, files);
}

CaseRun stretch(const Settings &settings, int ranks) {
  Files files = chains();
  files["start.in"] += pull();
  return stretch(settings, ranks, files);
}

// Rows of the log by step and tags.
using Breaks = std::vector<std::vector<long>>;
Breaks breaks_of(const CaseRun &run, double dt) {
  Breaks all;
  for (const Row &b : run.rows("breaks.csv"))
    all.push_back({std::lround(b.at("time_us") / dt), std::lround(b.at("tag_i")),
                   std::lround(b.at("tag_j"))});
  return all;
}

// State of all spheres at the end, all digits, as text.
std::string end_of(const CaseRun &run) {
  const std::string all = run.text("spheres.dump");
  const size_t last = all.rfind("ITEM: ATOMS");
  EXPECT_NE(last, std::string::npos) << run.why();
  return last == std::string::npos ? "" : all.substr(last);
}

} // namespace

TEST(VerificationFaults, SameStrengthsAndBreaksOnAnyRanksAndGrid) {
  std::string log;
  for (const Grid &g : kGrids) {
    const CaseRun run = stretch(with({}, g), g.ranks);
    ASSERT_TRUE(run.finished()) << run.why();
    log = g.ranks == 1 ? run.text("breaks.csv") : log;
    EXPECT_EQ(run.text("breaks.csv"), log) << g.x << g.y << g.z;
    const Row last = run.rows("curve.csv").back();
    EXPECT_EQ(last.at("made"), kChains * kBonds);
    EXPECT_EQ(last.at("made") - last.at("intact"), double(run.rows("breaks.csv").size()));
    EXPECT_GT(run.rows("breaks.csv").size(), 100u);
  }
  std::printf("stretched chains: %zu characters of log alike on %zu grids\n", log.size(),
              std::size(kGrids));
}

TEST(VerificationFaults, FreeBodiesBreakAlikeOnAnyRanksAndGrid) {
  Breaks serial;
  for (const Grid &g : kGrids) {
    const CaseRun run = meet(with({}, g), g.ranks);
    ASSERT_TRUE(run.finished()) << run.why();
    const Breaks found = breaks_of(run, 2e-5);
    serial = g.ranks == 1 ? found : serial;
    EXPECT_EQ(found, serial) << g.x << g.y << g.z;
  }
  std::printf("free bodies: %zu breaks alike on %zu grids\n", serial.size(), std::size(kGrids));
  EXPECT_GT(serial.size(), 10u);
}

TEST(VerificationFaults, NoBreakIsOneSidedOnTwoRanks) { // counts of both spheres of every bond
  const CaseRun run = stretch({{"gx", "2"}, {"gy", "1"}, {"gz", "1"}}, 2, [] {
    Files files = chains();
    files["start.in"] += pull() +
                         "compute sides all bond/bpm/atom\ncompute both all reduce sum c_sides[1] "
                         "c_sides[2]\nvariable n1 equal c_both[1]\nvariable n2 equal c_both[2]\n"
                         "fix sides_out all print 50 \"${n1},${n2}\" file sides.csv screen no "
                         "title intact,broken\n";
    return files;
  }());
  const std::vector<Row> sides = run.rows("sides.csv"), curve = run.rows("curve.csv");
  ASSERT_EQ(sides.size(), curve.size()) << run.why();
  for (size_t n = 0; n < sides.size(); ++n) {
    EXPECT_EQ(sides[n].at("intact"), 2 * curve[n].at("intact"));
    EXPECT_EQ(sides[n].at("broken"), 2 * (curve[n].at("made") - curve[n].at("intact")));
  }
  EXPECT_GT(sides.back().at("broken"), 200);
}

TEST(VerificationFaults, BondEnergyOnAnyRanksIsThatOfTheFormula) {
  const double E = 2e8, R = 0.795, l = 1.28, d = 1e-6, s = 2e-6, A = kPi * R * R;
  const double expected = 0.5 * E * A / l * (d * d + s * s / 2.6);
  for (const Grid &g : kGrids) { // the pair lies across the planes that part the domains
    std::vector<BodySphere> all = {{{-0.64, 0, 0}, R, 1}, {{0.64, 0, 0}, R, 1}};
    for (const double x : {-4.5, 4.5}) // no domain is empty
      for (const double y : {-4.0, 4.0})
        all.push_back({{x, y, 0}, R, static_cast<int>(all.size())});
    Files files = files_of(all, {-6, -6, -6}, {6, 6, 6});
    std::ostringstream move;
    move.precision(17);
    move << "unfix integrate\ngroup right id 2\nvelocity right set " << d / 0.1 << " " << s / 0.1
         << " 0 units box\nfix mv right move linear " << d / 0.1 << " " << s / 0.1
         << " 0 units box\n";
    files["start.in"] += move.str();
    const CaseRun run = CaseRun("in.body",
                                with({{"Ey", "1e3"},
                                      {"friction", "0"},
                                      {"ced", "0"},
                                      {"dt", "1e-4"},
                                      {"steps", "1000"},
                                      {"every", "1000"}},
                                     g),
                                g.ranks, files);
    ASSERT_EQ(run.rows("curve.csv").size(), 1u) << run.why();
    const Row last = run.rows("curve.csv").back();
    EXPECT_NEAR(last.at("strain") / expected, 1.0, 1e-5) << g.x << g.y << g.z;
    std::printf("%d ranks: bond energy %.9g fJ, formula %.9g fJ\n", g.ranks, last.at("strain"),
                expected);
  }
}

TEST(VerificationFaults, RestartInTheMiddleOfTheDamageIsBitIdenticalOnTwoRanksToo) {
  const int first = 25; // while the shaken bodies crack
  const CaseRun whole =
      meet({}, 1, "run " + std::to_string(first) + "\nwrite_restart half.restart\n");
  ASSERT_TRUE(whole.finished()) << whole.why();
  Files files = {{"half.restart", whole.text("half.restart")},
                 {"bodies.map", whole.text("bodies.map")},
                 {"start.in", "# goes on\n"}};
  const std::string steps = std::to_string(kSteps);
  const Settings settings = {{"restart", "1"},  {"breakable", "yes"}, {"sc", kStrength},
                             {"tc", kStrength}, {"weibull", "5"},     {"dt", "2e-5"},
                             {"steps", steps},  {"every", steps}};
  const CaseRun again("in.body", settings, 1, files);
  ASSERT_TRUE(again.finished()) << again.why();
  EXPECT_EQ(end_of(again), end_of(whole));
  EXPECT_EQ(again.text("breaks.csv"), whole.text("breaks.csv"));
  const CaseRun two("in.body", settings, 2, files);
  EXPECT_EQ(breaks_of(two, 2e-5), breaks_of(whole, 2e-5)) << two.why();
  int before = 0;
  for (const auto &b : breaks_of(whole, 2e-5))
    before += b[0] <= first;
  std::printf("restart: %d of %zu breaks before it\n", before, breaks_of(whole, 2e-5).size());
  EXPECT_GT(before, 3);
  EXPECT_GT(static_cast<int>(breaks_of(whole, 2e-5).size()) - before, 3);
}

TEST(VerificationFaults, RebuildsChangeNothing) {
  const CaseRun never = meet({{"skin", "1.5"}}), always = meet({{"skin", "1.5"}, {"check", "no"}});
  EXPECT_EQ(end_of(never), end_of(always));
  EXPECT_EQ(never.text("breaks.csv"), always.text("breaks.csv"));
  EXPECT_NE(never.text("log.liggghts").find("Neighbor list builds = 0"), std::string::npos);
  EXPECT_NE(always.text("log.liggghts").find("Neighbor list builds = " + std::to_string(kSteps)),
            std::string::npos);
  EXPECT_FALSE(never.rows("breaks.csv").empty());
}

TEST(VerificationFaults, OutputChangesNothing) {
  const CaseRun rare = meet({}), often = meet({{"every", "1"}});
  EXPECT_EQ(end_of(rare), end_of(often));
  EXPECT_EQ(rare.text("breaks.csv"), often.text("breaks.csv"));
}

TEST(VerificationFaults, MomentumOfADampedUnequalPair) {
  const std::vector<BodySphere> pair = {{{0, 0, 0}, 0.795, 1, {1, 2, 3}, {3, -2, 1}},
                                        {{0.9, 0.3, -0.2}, 0.5, 1, {-1, 1, -2}, {-4, 5, 2}}};
  const CaseRun run(
      "in.body",
      {{"damping", "0.3"}, {"dt", "2e-5"}, {"steps", std::to_string(kSteps)}, {"every", "40"}}, 1,
      files_of(pair, {-20, -20, -20}, {20, 20, 20}));
  const std::vector<Row> rows = run.rows("curve.csv");
  ASSERT_EQ(rows.size(), 100u) << run.why();
  const double mass = kDensity * 4.0 / 3.0 * kPi * (std::pow(0.795, 3) + std::pow(0.5, 3));
  double worst = 0.0;
  for (const char *c : {"px", "py", "pz", "lx", "ly", "lz"})
    for (const Row &r : rows)
      worst = std::fmax(worst, std::fabs(r.at(c) - rows[0].at(c)) / mass);
  std::printf("damped unequal pair: momentum changes by %.1e of mass x 1 um/us\n", worst);
  EXPECT_LT(worst, kSteps * 2.2e-16 * 4.0);
}

namespace {
// Forces are sums of whole units, 2^62 of which are E R^2 or up to twice that: twice it or more stops
// the run instead of wrapping.
constexpr double kRadius = 0.795, kPressed = 0.1 * kRadius; // um
double most_force() { return 2.0 * std::exp2(std::ceil(std::log2(2e8 * kRadius * kRadius))); }

// At which two spheres that overlap by kPressed must meet to be under that force, mostly by damping.
double speed_for(double force) {
  const double modulus = effective_modulus(2e8, 0.3, 2e8, 0.3), log_e = std::log(0.15);
  const double mass = kDensity * 4.0 / 3.0 * kPi * std::pow(kRadius, 3);
  const double beta = log_e / std::sqrt(log_e * log_e + kPi * kPi);
  const double damping =
      contact_resistance({modulus, 0.0, beta, 0.0}, std::sqrt(0.5 * kRadius * kPressed), 0.5 * mass)
          .normal_damping;
  return (force - hertz_force(modulus, 0.5 * kRadius, kPressed)) / damping;
}

CaseRun pressed(const std::vector<BodySphere> &spheres) {
  return CaseRun(
      "in.body",
      {{"bonded", "0"}, {"ced", "0"}, {"friction", "0"}, {"dt", "1e-8"}, {"steps", "10"}}, 1,
      files_of(spheres, {0, 0, 0}, {10, 10, 10}));
}
} // namespace

TEST(VerificationFaults, ForceBeyondTheUnitsOfItsSumStops) {
  for (const double share : {0.9, 1.1}) {
    const double speed = 0.5 * speed_for(share * most_force()); // of each
    const CaseRun run =
        pressed({{{5.0, 5.0, 5.0}, kRadius, 1, {speed, 0.0, 0.0}},
                 {{5.0 + 2.0 * kRadius - kPressed, 5.0, 5.0}, kRadius, 2, {-speed, 0.0, 0.0}}});
    EXPECT_EQ(run.finished(), share < 1.0) << run.why();
  }
}

// Three spheres press a fourth from one side, each with less than the most: together with 0.6 of it,
// or with 2.0 and 2.3, where the whole number of the sum has wrapped and is a small one again. And
// when two of them press from opposite sides, the sum is in its range.
TEST(VerificationFaults, SumThatLooksLikeASmallOneStops) {
  const double r = 2.0 * kRadius - kPressed, angle = 37.5 / 180.0 * kPi; // they do not touch
  for (const double share : {0.25, 0.85, 0.97}) {
    const double speed = speed_for(share * most_force());
    std::vector<BodySphere> all = {{{5.0, 5.0, 5.0}, kRadius, 1}};
    for (int k = 0; k < 3; ++k) {
      const double turn = 2.0 / 3.0 * kPi * k;
      const Vec3 n = {std::cos(angle), std::sin(angle) * std::cos(turn),
                      std::sin(angle) * std::sin(turn)};
      all.push_back({all[0].x + r * n, kRadius, k + 2, -speed * n});
    }
    const CaseRun run = pressed(all);
    EXPECT_EQ(run.finished(), share < 0.5) << run.why();
    EXPECT_EQ(run.why().find("more than the units of its sum hold") == std::string::npos,
              share < 0.5);
  }
  const double speed = speed_for(0.9 * most_force());
  const CaseRun both = pressed({{{5.0, 5.0, 5.0}, kRadius, 1},
                                {{5.0 + r, 5.0, 5.0}, kRadius, 2, {-speed, 0.0, 0.0}},
                                {{5.0 - r, 5.0, 5.0}, kRadius, 3, {speed, 0.0, 0.0}}});
  EXPECT_TRUE(both.finished()) << both.why();
}

// A sphere is driven into four to which it is bonded: until the run stops its force grows.
TEST(VerificationFaults, OverflowStopsInItsStepOnAnyRanks) {
  for (const int ranks : {1, 2}) {
    Files files = files_of({{{0, 0, 0}, 1.0, 1},
                            {{1.6113, 1.0068, 0}, 1.0, 1},
                            {{1.6113, -1.0068, 0}, 1.0, 1},
                            {{1.6113, 0, 1.0068}, 1.0, 1},
                            {{1.6113, 0, -1.0068}, 1.0, 1}},
                           {-5, -5, -5}, {5, 5, 5});
    files["start.in"] +=
        "unfix integrate\ngroup driven id 1\nvelocity driven set 60 0 0 units box\n"
        "fix mv driven move linear 60 0 0 units box\n";
    const CaseRun run("in.body",
                      {{"ced", "0"},
                       {"friction", "0"},
                       {"restitution", "1"},
                       {"dt", "1e-4"},
                       {"steps", "190"},
                       {"every", "1"},
                       {"gx", std::to_string(ranks)},
                       {"gy", "1"},
                       {"gz", "1"}},
                      ranks, files);
    EXPECT_FALSE(run.finished());
    double before = 0.0;
    const std::vector<std::vector<Row>> frames = run.frames();
    for (const std::vector<Row> &frame : frames) {
      ASSERT_FALSE(frame.empty());
      EXPECT_LE(frame[0].at("fx"), before);
      before = frame[0].at("fx");
    }
    std::printf("%d ranks: stopped after %zu steps, at a force of %.3g nN\n", ranks,
                frames.size() - 1, before);
    EXPECT_GT(frames.size(), 50u);
    EXPECT_LT(frames.size(), 100u); // faults of one rank are told at the 100th
  }
}
