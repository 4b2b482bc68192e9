// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include "column.h"
#include <gtest/gtest.h>

using namespace calendem;
using namespace calendem::platen_column;

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

// Averaged pressure and averaged position are a point of the closed curve, however long the window:
// here the platen moves 0.01 um in it, a fifth of the way, on which the position of the moment is
// up to 0.005 um ahead. The average of a curve is that of its middle but for its bend, F''(x)
// s^2/24.
TEST(VerificationPlaten, AveragedPressureAndPositionBelongTogether) {
  const std::vector<BodySphere> spheres = column(2 * R, false);
  const double top = top_of(spheres) + kGap, depth = 0.05, speed = 0.005, window = 2.0;
  Settings of_motion = motion("position", top - depth, top, speed);
  of_motion["window"] = number(window);
  const CaseRun run = press(
      spheres, of_motion, {{"bonded", "0"}, {"dt", "2e-4"}, {"steps", "140000"}, {"every", "100"}});
  ASSERT_TRUE(run.finished()) << run.why();
  const double largest = load_of(depth - 2 * kGap, false), s = window * speed, x = 0.5 * depth;
  const double bend =
      load_of(x + 0.5 * s, false) - 2.0 * load_of(x, false) + load_of(x - 0.5 * s, false);
  double error = 0.0, now = 0.0;
  for (const Row &r : run.rows("platen.csv")) {
    const double mean = top - r.at("height") - 2 * kGap, p = r.at("average") * kSide * kSide;
    if (mean < x)
      continue;
    error = std::fmax(error, std::fabs(p - load_of(mean, false)) / largest);
    now = std::fmax(now, std::fabs(p - load_of(r.at("moved") - 2 * kGap, false)) / largest);
  }
  std::printf(
      "averaged pressure against averaged position: %.1e of the largest (bend %.1e), against "
      "the position of the moment: %.1e\n",
      error, bend / 6.0 / largest, now);
  EXPECT_LT(error, bend / 6.0 / largest + 1e-3); // and the wave, as above
  EXPECT_GT(now, 0.05);
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

// Down to a pressure and up, three times: elastic, so that every time is as the first.
TEST(VerificationPlaten, PressedThreeTimesAnElasticColumnIsAsItWas) {
  const double target = 1500.0; // kPa
  const std::vector<BodySphere> spheres = column(2 * R, false);
  const double top = top_of(spheres) + kGap;
  Settings three = motion("pressure", target, top, 0.005);
  three["passes"] = "3";
  const CaseRun run = press(spheres, three,
                            {{"bonded", "0"},
                             {"damping", "0.02"},
                             {"dt", "2e-4"},
                             {"steps", "600000"},
                             {"every", "100"}});
  ASSERT_TRUE(run.finished()) << run.why();
  double error[3] = {}, most[3] = {}, stage = 0.0;
  int pass = -1;
  for (const Row &r : run.rows("platen.csv")) {
    pass += r.at("stage") == 1 && stage != 1;
    stage = r.at("stage");
    ASSERT_TRUE(pass >= 0 && pass < 3);
    const double expected = load_of(std::fmax(r.at("moved") - 2 * kGap, 0.0), false);
    error[pass] =
        std::fmax(error[pass], std::fabs(r.at("load") - expected) / (target * kSide * kSide));
    most[pass] = std::fmax(most[pass], r.at("load") / (kSide * kSide));
  }
  EXPECT_EQ(pass, 2);
  EXPECT_EQ(stage, 4);
  for (int n = 0; n < 3; ++n) {
    std::printf("pass %d: largest pressure %.6g kPa, %.1e of it off the closed curve\n", n + 1,
                most[n], error[n]);
    EXPECT_LT(error[n], 1e-3); // the wave
    EXPECT_GE(most[n] / target, 1.0);
    EXPECT_LT(most[n] / target, 1.01);
  }
}

namespace {

// A plate of the cell's size at height z, two cells along x and y: the host's periodic mesh needs
// both.
std::string plate(double side, double z) {
  std::ostringstream stl;
  stl.precision(17);
  stl << "solid plate\n";
  const auto triangle = [&](double ax, double ay, double bx, double by, double cx, double cy) {
    stl << "facet normal 0 0 1\n outer loop\n";
    for (const auto &[x, y] : {std::pair(ax, ay), std::pair(bx, by), std::pair(cx, cy)})
      stl << "  vertex " << x << " " << y << " " << z << "\n";
    stl << " endloop\nendfacet\n";
  };
  const double h = 0.5 * side;
  for (const double x : {0.0, h})
    for (const double y : {0.0, h}) {
      triangle(x, y, x + h, y, x + h, y + h);
      triangle(x, y, x + h, y + h, x, y + h);
    }
  stl << "endsolid plate\n";
  return stl.str();
}

// Three bonded cubes that stand on an edge of their own slope, and loose spheres between them.
std::vector<BodySphere> heap() {
  std::vector<BodySphere> all;
  const Vec3 places[] = {{1.7, 1.9, 0.0}, {5.3, 2.3, 0.0}, {3.1, 5.4, 0.0}};
  for (const int body : {1, 2, 3}) {
    const double a = 0.08 * body, c = std::cos(a), s = std::sin(a);
    const double lowest = -0.5 * kBondLength * (c + s);
    for (BodySphere b : cube(2, kBondLength, -0.5 * kBondLength * Vec3{1, 1, 1}, body)) {
      b.x = Vec3{c * b.x.x + s * b.x.z, b.x.y, c * b.x.z - s * b.x.x} + places[body - 1];
      b.x.z += R + kGap - lowest;
      all.push_back(b);
    }
  }
  for (const Vec3 &x : {Vec3{6.2, 5.6, 0.8}, Vec3{3.5, 2.0, 0.8}, Vec3{3.5, 2.0, 2.41}})
    all.push_back({x, R, static_cast<int>(all.size())});
  return all;
}

} // namespace

// The host's mesh plates, moved by the host, take the same force as the platen and the collector.
TEST(VerificationPlaten, SameForceAsAMovingMesh) {
  const std::vector<BodySphere> spheres = heap();
  const double side = 7.0, top = top_of(spheres) + kGap;
  const int steps = 8000;
  std::map<std::string, std::vector<Row>> walls, end;
  for (const std::string wall : {"platen", "mesh"}) {
    Files files = pressed(spheres, side, motion("position", top - 1.0, top, 0.5, 0.0), wall);
    files["floor.stl"] = plate(side, 0.0);
    files["plate.stl"] = plate(side, top);
    const CaseRun run("in.body",
                      {{"bx", "p"},
                       {"by", "p"},
                       {"ced", "0"},
                       {"skin", "0.15"},
                       {"dt", "5e-5"},
                       {"steps", number(steps)},
                       {"every", "20"}},
                      1, files);
    ASSERT_TRUE(run.finished()) << run.why();
    walls[wall] = run.rows(wall + ".csv");
    end[wall] = run.frames().back();
  }
  const std::vector<Row> &ours = walls["platen"], &mesh = walls["mesh"];
  ASSERT_EQ(ours.size(), mesh.size());
  double largest = 0.0, across = 0.0, worst = 0.0, moved = 0.0;
  for (size_t n = 0; n < ours.size(); ++n) {
    largest = std::fmax(largest, mesh[n].at("load"));
    across = std::fmax(across, mesh[n].at("side"));
    for (const char *force : {"load", "below"})
      worst = std::fmax(worst, std::fabs(ours[n].at(force) - mesh[n].at(force)));
  }
  for (size_t i = 0; i < spheres.size(); ++i)
    for (const char *x : {"x", "y", "z"})
      moved = std::fmax(moved, std::fabs(end["platen"][i].at(x) - end["mesh"][i].at(x)));
  const double ulps = steps * 8.9e-16; // um: one of the height in each step, all of one sign
  const double depth = std::pow(0.75 * largest / (E_eff * std::sqrt(R)), 2.0 / 3.0);
  std::printf("platen and mesh: forces differ by %.1e of %.4g nN (tolerance %.1e; friction up to "
              "%.3g nN), places by %.1e um\n",
              worst / largest, largest, 1.5 * ulps / depth, across, moved);
  EXPECT_GT(largest, 1e6);
  EXPECT_GT(across, 0.1 * largest);
  EXPECT_LT(worst / largest, 1.5 * ulps / depth);
}

// A machine that gives way by C per pressure stops when film and machine together have moved as far
// as it was set: d = x + C P(x), on the closed curve of the column.
TEST(VerificationPlaten, ASoftMachineStopsByWhatItShows) {
  const std::vector<BodySphere> spheres = column(spacing(false), false);
  const double top = top_of(spheres) + kGap, set_by = 0.06, compliance = 4e-6, speed = 0.005;
  Settings of_motion = motion("position", top - set_by, top, speed);
  of_motion.insert({"compliance", number(compliance)});
  const CaseRun run = press(spheres, of_motion,
                            {{"bonded", "0"},
                             {"damping", "0.02"},
                             {"dt", "2e-4"},
                             {"steps", "140000"},
                             {"every", "100"}});
  ASSERT_TRUE(run.finished()) << run.why();
  double low = 0.0, high = set_by;
  while (high - low > 1e-12) {
    const double x = 0.5 * (low + high), load = load_of(std::fmax(x - 2 * kGap, 0.0), false);
    (x + compliance * load / (kSide * kSide) < set_by ? low : high) = x;
  }
  double moved = 0.0;
  for (const Row &r : run.rows("platen.csv"))
    moved = std::fmax(moved, r.at("moved"));
  std::printf("soft machine: film compressed by %.5f of %.5f um set, %.5f by hand\n", moved, set_by,
              low);
  EXPECT_LT(low, 0.9 * set_by);
  EXPECT_NEAR(moved, low, 0.25 * speed); // the averaging window's way at most
}
