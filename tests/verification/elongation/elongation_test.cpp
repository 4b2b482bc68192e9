// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "physics/roll_nip.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, nu = 0.3, R = 0.795, kSpacing = 1.28, kRoll = 2e5; // kPa, um
const BondMaterial kBond = {E, shear_modulus(E, nu), 1.0, 0.0};
const BondStiffness kStiffness(kBond, BondSection(R), kSpacing);

/// Time [us] that the roll takes from `top` to the nip.
double way_down(double depth, double speed) {
  const RollNip nip = {kRoll, kRoll, 0.0};
  return nip.distance(depth) / nip.web_speed(speed, depth);
}

CaseRun stretch(const std::vector<BodySphere> &spheres, double side, const Settings &settings,
                const std::string &rest = "", int ranks = 1, const Files &more = {}) {
  Files files = files_of(spheres, {0, 0, 0}, {side, 5, 12});
  files["rest.in"] = files["start.in"] + rest;
  for (const auto &[name, text] : more)
    files[name] = text;
  return CaseRun("elongation/in.elongation", settings, ranks, files);
}

/// A roll that touches nothing on its way of 1 um, and steps for it.
Settings untouched(double e, double dt) {
  const double speed = 10.0;
  const int steps = static_cast<int>(way_down(1.0, speed) / dt);
  return {{"e", number(e)},
          {"dt", number(dt)},
          {"speed", number(speed)},
          {"rest", number(steps)},
          {"ced", "0"}};
}

std::vector<std::vector<double>> final_state(const CaseRun &run) {
  std::istringstream in(run.text("final.txt"));
  std::vector<std::vector<double>> all;
  std::string line;
  while (std::getline(in, line) && line.rfind("ITEM: ATOMS", 0) != 0)
    ;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    all.emplace_back(std::istream_iterator<double>(cells), std::istream_iterator<double>());
  }
  return all;
}

} // namespace

// Two bonded spheres at 45 degrees that take part in the mean motion only.
TEST(VerificationElongation, ForceAndTorqueOfATiltedBond) {
  const double e = 0.02, a = kSpacing / std::sqrt(2.0);
  const CaseRun run = stretch({{{5 + a, 2.5, 5 + a}, R, 1}, {{5, 2.5, 5}, R, 1}}, 10,
                              untouched(e, 1e-4), "unfix integrate\n");
  ASSERT_TRUE(run.finished()) << run.why();
  EXPECT_EQ(run.rows("curve.csv").back().at("elongation"), e);
  const std::vector<double> first = final_state(run).at(0), second = final_state(run).at(1);
  const double dx = a * (1 + e), r = std::hypot(dx, a), c = dx / r, s = a / r;
  EXPECT_NEAR(first[1] - second[1], dx, 1e-12);
  // shear: k_t int r d(angle), the spheres do not turn
  const double tension = kStiffness.normal * (r - kSpacing),
               shear = kStiffness.shear * a * (std::asinh(dx / a) - std::asinh(1.0));
  const double expected[] = {-tension * c - shear * s, -tension * s + shear * c, 0.5 * r * shear};
  const double found[] = {first[10], first[12], first[14]};
  for (int k = 0; k < 3; ++k) {
    std::printf("tilted bond: %.8g, closed form %.8g, off by %.1e\n", found[k], expected[k],
                found[k] / expected[k] - 1.0);
    EXPECT_NEAR(found[k] / expected[k], 1.0, 1e-10);
  }
  EXPECT_NEAR(second[14] / first[14], 1.0, 1e-12);
}

// A chain through the periodic side, free to move: stress E e, work (1/2) E A e^2 L.
TEST(VerificationElongation, ChainThroughThePeriodicSide) {
  std::vector<BodySphere> chain;
  const int spheres = 8;
  for (int n = 0; n < spheres; ++n)
    chain.push_back({{0.1 + n * kSpacing, 2.5, 5}, R, 1});
  const double e = 0.01, length = spheres * kSpacing;
  const CaseRun run = stretch(chain, length, untouched(e, 4e-5));
  ASSERT_TRUE(run.finished()) << run.why();
  double worst = 0.0, moving = 0.0;
  const double area = BondSection(R).area, most = 0.5 * E * area * e * e * length;
  for (const Row &row : run.rows("curve.csv")) {
    const double energy = 0.5 * E * area * std::pow(row.at("elongation"), 2) * length;
    worst =
        std::max({worst, std::fabs(row.at("strain") - energy), std::fabs(row.at("cell") - energy)});
    moving = std::fmax(moving, row.at("kinetic"));
    EXPECT_NEAR(row.at("side"), length * (1 + row.at("elongation")), 1e-14 * length);
  }
  std::printf("chain: energy off by %.1e of %.4g fJ, kinetic %.1e of it\n", worst / most, most,
              moving / most);
  EXPECT_EQ(run.rows("curve.csv").back().at("elongation"), e);
  EXPECT_LT(worst / most, 1e-10);
  EXPECT_LT(moving / most, 1e-10);
}

namespace {

/// A bonded block through the periodic side and spheres on it that fly, meet it, and cross the side
/// and the border of ranks; under the roll.
CaseRun press(Settings settings, int ranks = 1, const Files &more = {}) {
  std::vector<BodySphere> all;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 2; ++y)
      for (int z = 0; z < 2; ++z)
        all.push_back({{0.3 + kSpacing * x, 1.0 + kSpacing * y, R + kSpacing * z}, R, 1});
  const double above = R + kSpacing + 1.5;
  for (int n = 0; n < 4; ++n)
    all.push_back({{0.9 + 1.9 * n, 1.64 + 0.1 * n, above}, R, 2 + n, {6.0 - n, 0, 0}});
  const double speed = 4.0, depth = 0.3, dt = 2e-5, top = above + R + 0.1;
  const int steps = static_cast<int>(1.9 * way_down(depth, speed) / dt);
  settings.insert({{"top", number(top)},
                   {"gap", number(top - depth)},
                   {"speed", number(speed)},
                   {"slip", "0.001"},
                   {"restitution", "0.3"},
                   {"damping", "0.3"},
                   {"e", "0.02"},
                   {"dt", number(dt)},
                   {"half", std::to_string(steps / 4)},
                   {"rest", std::to_string(steps - steps / 4)}});
  return stretch(all, 6 * kSpacing, settings, "", ranks, more);
}

double unaccounted(const CaseRun &run, double &most) {
  const std::vector<Row> rows = run.rows("curve.csv");
  const auto rest = [](const Row &r) {
    return r.at("work") + r.at("cell") - r.at("kinetic") - r.at("strain") - r.at("lost") -
           r.at("elastic") - r.at("damped") - r.at("friction");
  };
  double worst = 0.0;
  for (const Row &r : rows) {
    worst = std::fmax(worst, std::fabs(rest(r) - rest(rows.front())));
    most = std::fmax(most, r.at("work") + r.at("cell"));
  }
  return worst;
}

} // namespace

// Work of roll and cell is motion, elastic energy, and what damping, friction and breaks take; the
// same state on two ranks and after a restart in the middle.
TEST(VerificationElongation, LedgerRanksAndRestart) {
  for (const char *breakable : {"no", "yes"}) {
    const Settings kind = {{"breakable", breakable}};
    const CaseRun one = press(kind);
    ASSERT_TRUE(one.finished()) << one.why();
    double most = 0.0;
    const double worst = unaccounted(one, most);
    const Row end = one.rows("curve.csv").back();
    std::printf(
        "breakable %s: energies differ by %.1e of %.4g fJ; cell %.3g, damped %.3g, friction "
        "%.3g, lost %.3g; %g broken\n",
        breakable, worst / most, most, end.at("cell"), end.at("damped"), end.at("friction"),
        end.at("lost"), end.at("broken"));
    EXPECT_LT(worst / most, 1.4e-4);
    EXPECT_EQ(end.at("elongation"), 0.02);
    Settings split = kind;
    split["px"] = "2";
    const CaseRun two = press(split, 2);
    EXPECT_EQ(two.text("final.txt"), one.text("final.txt"));
    EXPECT_NEAR(two.rows("curve.csv").back().at("cell"), end.at("cell"), 1e-9 * most);
    std::ifstream in(one.folder() / "half.restart", std::ios::binary);
    const std::string half{std::istreambuf_iterator<char>(in), {}};
    Settings from = kind;
    from["from"] = "1";
    const CaseRun on = press(from, 1, {{"half.restart", half}, {"rest.in", "\n"}});
    EXPECT_EQ(on.text("final.txt"), one.text("final.txt"));
    const Row on_end = on.rows("curve.csv").back();
    for (const auto &[column, value] : end)
      EXPECT_EQ(on_end.at(column), value) << column;
    from["web"] = "other";
    const CaseRun other = press(from, 1, {{"half.restart", half}, {"rest.in", "\n"}});
    EXPECT_FALSE(other.finished());
    EXPECT_NE(other.why().find("under the ID 'elongation'"), std::string::npos) << other.why();
  }
}

TEST(VerificationElongation, OtherLoopsAndValuesStop) {
  const std::pair<Settings, const char *> cases[] = {{{{"fused", "off"}}, "needs the fused loop"},
                                                     {{{"e", "0.06"}}, "at most 0.05"}};
  for (const auto &[settings, words] : cases) {
    const CaseRun run = press(settings);
    EXPECT_FALSE(run.finished());
    EXPECT_NE(run.why().find(words), std::string::npos) << run.why();
  }
}
