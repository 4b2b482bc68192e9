// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, nu = 0.3, R = 0.795, kSide = 5.0, kGap = 1e-4; // kPa, um
constexpr int kSpheres = 5;
const double E_eff = effective_modulus(E, nu, E, nu);

// Spheres on top of each other, `spacing` apart, the lowest just above the collector.
std::vector<BodySphere> column(double spacing, bool bonded) {
  std::vector<BodySphere> all;
  for (int n = 0; n < kSpheres; ++n)
    all.push_back({{2.5, 2.5, R + kGap + n * spacing}, R, bonded ? 1 : n + 1});
  return all;
}

double top_of(const std::vector<BodySphere> &all) { return all.back().x.z + R; }

CaseRun press(const std::vector<BodySphere> &all, const Settings &motion, Settings settings) {
  Files files = files_of(all, {0, 0, 0}, {kSide, kSide, 12});
  std::ostringstream start;
  start.precision(17);
  for (const auto &m : motion)
    start << "variable " << m.first << " index " << m.second << "\n";
  start << "include ${cases}/platen/in.platen\n";
  files["start.in"] += start.str();
  settings.insert({{"bx", "p"}, {"by", "p"}, {"ced", "0"}, {"friction", "0"}, {"skin", "0.15"}});
  return CaseRun("in.body", settings, 1, files);
}

Settings motion(const std::string &control, double aim, double top, double speed) {
  return {{"motion", control}, {"aim", number(aim)}, {"top", number(top)}, {"speed", number(speed)},
          {"window", "0.25"},  {"dwell", "2"},       {"ramp", "2"},        {"lost_at", "0.01"}};
}

constexpr double kBondLength = 1.28;
const double kBond = E * kPi * R * R / kBondLength; // k_n, nN/um

// Load of a contact; between bonded spheres the bond bears beside the contact beyond the reference.
double pair_load(double d, bool bonded) {
  return hertz_force(E_eff, 0.5 * R, d) + (bonded ? kBond * d : 0.0);
}

double pair_shortening(double load, bool bonded) {
  double low = 0.0, high = 0.1;
  while (high - low > 1e-15) {
    const double middle = 0.5 * (low + high);
    (pair_load(middle, bonded) < load ? low : high) = middle;
  }
  return low;
}

// Shortening of the column under a load: two contacts with walls, the others between spheres.
double shortening(double load, bool bonded) {
  const double wall = std::pow(0.75 * load / (E_eff * std::sqrt(R)), 2.0 / 3.0);
  return 2.0 * wall + (kSpheres - 1) * pair_shortening(load, bonded);
}

double load_of(double wanted, bool bonded) {
  double low = 0.0, high = 1e6;
  while (high - low > 1e-9 * high) {
    const double middle = 0.5 * (low + high);
    (shortening(middle, bonded) < wanted ? low : high) = middle;
  }
  return low;
}

double hertz_energy(double R_eff, double d) {
  return d > 0.0 ? 8.0 / 15.0 * E_eff * std::sqrt(R_eff) * std::pow(d, 2.5) : 0.0;
}

// Energy in the contacts of one frame; `length`: centre distance at which neighbours touch.
double contact_energy(const std::vector<Row> &frame, double platen, double length) {
  double sum = hertz_energy(R, R - frame.front().at("z")) +
               hertz_energy(R, frame.back().at("z") + R - platen);
  for (size_t n = 1; n < frame.size(); ++n)
    sum += hertz_energy(0.5 * R, length - (frame[n].at("z") - frame[n - 1].at("z")));
  return sum;
}

double spacing(bool bonded) { return bonded ? kBondLength : 2 * R; }

} // namespace

// Down to a thickness, a dwell, up until contact is lost: both ways on the closed curve.
TEST(VerificationPlaten, ColumnToAThicknessAndBack) {
  for (const bool bonded : {false, true}) {
    const std::vector<BodySphere> spheres = column(spacing(bonded), bonded);
    const double top = top_of(spheres) + kGap, depth = bonded ? 0.03 : 0.05, speed = 0.005;
    const CaseRun run = press(spheres, motion("position", top - depth, top, speed),
                              {{"bonded", bonded ? "1" : "0"},
                               {"damping", "0.02"},
                               {"dt", bonded ? "7e-5" : "2e-4"},
                               {"steps", bonded ? "280000" : "140000"},
                               {"every", "100"}});
    ASSERT_TRUE(run.finished()) << run.why();
    const double largest = load_of(depth - 2 * kGap, bonded);
    double error[5] = {}, balance = 0.0, moved = 0.0;
    int rows[5] = {};
    for (const Row &r : run.rows("platen.csv")) {
      const int stage = static_cast<int>(r.at("stage"));
      const double expected = load_of(std::fmax(r.at("moved") - 2 * kGap, 0.0), bonded);
      moved = std::fmax(moved, r.at("moved"));
      const double e = std::fabs(r.at("load") - expected) / largest;
      error[stage] = stage == 2 ? e : std::fmax(error[stage], e); // at the dwell's end
      balance = std::fmax(balance, std::fabs(r.at("load") - r.at("below")) / largest);
      ++rows[stage];
    }
    const Row last = run.rows("platen.csv").back();
    std::printf("%s column: error down %.1e, dwell %.1e, up %.1e of the largest load; platen minus "
                "collector %.1e\n",
                bonded ? "bonded" : "loose", error[1], error[2], error[3], balance);
    for (const int stage : {1, 2, 3}) {
      EXPECT_GT(rows[stage], 50);
      EXPECT_LT(error[stage], stage == 2 ? 1e-6 : 1e-3);
    }
    EXPECT_LT(balance, 1e-3);
    EXPECT_NEAR(moved, depth, 1e-12);
    EXPECT_EQ(last.at("stage"), 4); // done: contact lost below 1 % of the largest pressure
    EXPECT_LT(last.at("average"), 0.01 * last.at("largest"));
  }
}

// First law, no damping: the platen's work is in the contacts, the bonds and the motion, all along.
TEST(VerificationPlaten, WorkIsStoredEnergy) {
  for (const bool bonded : {false, true}) {
    const std::vector<BodySphere> spheres = column(spacing(bonded), bonded);
    const double top = top_of(spheres) + kGap;
    const CaseRun run = press(spheres, motion("position", top - 0.03, top, 0.5),
                              {{"bonded", bonded ? "1" : "0"},
                               {"restitution", "1"},
                               {"dt", "2e-5"},
                               {"steps", "50000"},
                               {"every", "50"}});
    ASSERT_TRUE(run.finished()) << run.why();
    const std::vector<Row> platen = run.rows("platen.csv"), curve = run.rows("curve.csv");
    const auto frames = run.frames();
    ASSERT_EQ(frames.size(), platen.size() + 1);
    double worst = 0.0, most = 0.0;
    for (size_t n = 0; n < platen.size(); ++n) {
      const double held =
          curve[n].at("kinetic") + curve[n].at("strain") +
          contact_energy(frames[n + 1], top - platen[n].at("moved"), spacing(bonded));
      worst = std::fmax(worst, std::fabs(platen[n].at("work") - held));
      most = std::fmax(most, platen[n].at("work"));
    }
    std::printf("%s column: work and energy differ by %.1e of %.4g fJ\n",
                bonded ? "bonded" : "loose", worst / most, most);
    EXPECT_GT(most, 100.0);
    EXPECT_LT(worst / most, bonded ? 3e-3 : 1.4e-4); // (omega dt)^2 / 16
  }
}

TEST(VerificationPlaten, PressureControlOvershootsByLessThanOnePercent) {
  for (const double target : {500.0, 3000.0}) { // kPa
    const std::vector<BodySphere> spheres = column(2 * R, false);
    const double top = top_of(spheres) + kGap;
    const CaseRun run =
        press(spheres, motion("pressure", target, top, 0.01),
              {{"bonded", "0"}, {"dt", "2e-4"}, {"steps", "100000"}, {"every", "10"}});
    ASSERT_TRUE(run.finished()) << run.why();
    double most = 0.0, reached = 0.0;
    for (const Row &r : run.rows("platen.csv")) {
      most = std::fmax(most, r.at("load") / (kSide * kSide));
      reached = std::fmax(reached, r.at("reached"));
    }
    std::printf("target %g kPa: largest pressure %.6g kPa, overshoot %.2e\n", target, most,
                most / target - 1.0);
    EXPECT_EQ(reached, 1.0);
    EXPECT_GE(most / target, 1.0);
    EXPECT_LT(most / target, 1.01);
  }
}
