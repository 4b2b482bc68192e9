// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "meeting.h"
#include "spheres.h"

using namespace calendem;

namespace {

// Turns `a` about the unit vector `u`.
Vec3 rotated(const Vec3 &a, const Vec3 &u, double angle) {
  return std::cos(angle) * a + std::sin(angle) * cross(u, a) +
         ((1.0 - std::cos(angle)) * dot(u, a)) * u;
}

Vec3 unit(const Vec3 &a) { return (1.0 / norm(a)) * a; }

constexpr int kSteps = 4000;
constexpr double kStep = 2e-5, kHalf = 20.0;

CaseRun meet(const std::vector<BodySphere> &all, Settings more = {},
             Vec3 low = {-kHalf, -kHalf, -kHalf}, Vec3 high = {kHalf, kHalf, kHalf}) {
  more.insert({{"dt", number(kStep)}, {"steps", std::to_string(kSteps)}, {"every", "40"}});
  return CaseRun("in.body", more, 1, files_of(all, low, high));
}

// Largest difference of the scalars of two runs, in parts of the energy at the start.
double difference(const CaseRun &a, const CaseRun &b, const std::vector<std::string> &columns) {
  const std::vector<Row> x = a.rows("curve.csv"), y = b.rows("curve.csv");
  EXPECT_EQ(x.size(), 100u) << a.why();
  EXPECT_EQ(y.size(), 100u) << b.why();
  double worst = 0.0;
  for (size_t n = 0; n < std::min(x.size(), y.size()); ++n)
    for (const std::string &c : columns)
      worst = std::fmax(worst, std::fabs(x[n].at(c) - y[n].at(c)) / x[0].at("kinetic"));
  return worst;
}

const std::vector<std::string> kScalars = {"kinetic", "rotational", "strain"};

using Change = std::function<void(BodySphere &)>;

double changed(const Change &change, const std::vector<std::string> &columns = kScalars) {
  std::vector<BodySphere> all = meeting();
  const CaseRun plain = meet(all);
  std::for_each(all.begin(), all.end(), change);
  return difference(plain, meet(all), columns);
}

void expect_same(const char *what, double d) {
  std::printf("%s: scalars differ by %.1e of the energy\n", what, d);
  EXPECT_LT(d, 1e-9);
}

} // namespace

TEST(VerificationObjectivity, Translation) {
  expect_same("translation", changed([](BodySphere &s) { s.x = s.x + Vec3{7.3, -11.1, 5.7}; }));
}

TEST(VerificationObjectivity, Rotation) {
  const Vec3 u = unit({1, 2, 3});
  expect_same("rotation", changed([&](BodySphere &s) {
                s.x = rotated(s.x, u, 1.0);
                s.v = rotated(s.v, u, 1.0);
                s.omega = rotated(s.omega, u, 1.0);
              }));
}

TEST(VerificationObjectivity, Mirror) { // spins are axial vectors
  expect_same("mirror", changed([](BodySphere &s) {
                s.x.x = -s.x.x;
                s.v.x = -s.v.x;
                s.omega = {s.omega.x, -s.omega.y, -s.omega.z};
              }));
}

TEST(VerificationObjectivity, SwappedTags) {
  std::vector<BodySphere> all = meeting();
  const CaseRun plain = meet(all);
  std::reverse(all.begin(), all.end());
  expect_same("swapped tags", difference(plain, meet(all), kScalars));
}

TEST(VerificationObjectivity, GalileanShift) {
  expect_same("common speed", changed(
                                  [](BodySphere &s) {
                                    s.v = s.v + Vec3{16, -32, 8};
                                  },
                                  {"rotational", "strain"}));
}

TEST(VerificationObjectivity, HalfAPeriodicBox) {
  const double side = 12.0;
  std::vector<BodySphere> all = meeting();
  const Settings periodic = {{"bx", "p"}, {"by", "p"}, {"skin", "0.15"}};
  const Vec3 low = {-6, -6, -kHalf}, high = {6, 6, kHalf};
  const CaseRun plain = meet(all, periodic, low, high);
  for (BodySphere &s : all)
    for (double *x : {&s.x.x, &s.x.y})
      *x = *x + 6.0 < 6.0 ? *x + 6.0 : *x + 6.0 - side;
  expect_same("half a box", difference(plain, meet(all, periodic, low, high), kScalars));
}

TEST(VerificationObjectivity, MomentumThroughBreaks) {
  const CaseRun run = meet(meeting(), {{"breakable", "yes"}, {"sc", "2e4"}, {"tc", "2e4"}});
  const std::vector<Row> rows = run.rows("curve.csv");
  ASSERT_EQ(rows.size(), 100u) << run.why();
  const double mass = 16 * kDensity * 4.0 / 3.0 * kPi * std::pow(0.795, 3);
  double worst = 0.0;
  for (const char *c : {"px", "py", "pz", "lx", "ly", "lz"})
    for (const Row &r : rows)
      worst = std::fmax(worst, std::fabs(r.at(c) - rows[0].at(c)) / mass);
  std::printf("%g of %g bonds broke: momentum changes by %.1e of mass x 1 um/us\n",
              rows[0].at("made") - rows.back().at("intact"), rows[0].at("made"), worst);
  EXPECT_LT(rows.back().at("intact"), 0.8 * rows[0].at("made"));
  EXPECT_LT(worst, kSteps * 2.2e-16 * 4.0); // one rounding a step, speeds and arms of 2
}

namespace {

// One sphere moved on the circle about `u` through `from`, as displacement and velocity (the chord
// of a step) in the script's language.
std::string circle(int tag, const Vec3 &from, const Vec3 &u, double dt, int steps) {
  const Vec3 across = from - dot(u, from) * u, w = cross(u, from);
  const std::string id = std::to_string(tag), step = number(0.5 * kPi / steps);
  std::ostringstream out;
  out.precision(17);
  const char axes[] = {'x', 'y', 'z'};
  const double a[] = {across.x, across.y, across.z}, b[] = {w.x, w.y, w.z};
  for (int k = 0; k < 3; ++k) {
    const std::string now = "(step-" + std::to_string(steps) + ")*" + step,
                      then = "(step-" + std::to_string(steps + 1) + ")*" + step;
    out << "variable d" << axes[k] << id << " equal (" << a[k] << ")*(cos(" << now << ")-1)+("
        << b[k] << ")*sin(" << now << ")\n";
    out << "variable u" << axes[k] << id << " equal ((" << a[k] << ")*(cos(" << now << ")-cos("
        << then << "))+(" << b[k] << ")*(sin(" << now << ")-sin(" << then << ")))/" << dt << "\n";
  }
  out << "fix turn" << id << " s" << id << " move variable v_dx" << id << " v_dy" << id << " v_dz"
      << id << " v_ux" << id << " v_uy" << id << " v_uz" << id << " units box\n";
  return out.str();
}

std::string spin(int tag, const Vec3 &w) {
  return "set atom " + std::to_string(tag) + " omegax " + number(w.x) + " omegay " + number(w.y) +
         " omegaz " + number(w.z) + "\n";
}

// A pair of size `scale` is sheared, stretched, bent and twisted, then turned about `axis` by 90
// degrees as a rigid body. Returns the largest departure of force and torques from the turned ones.
double turned(const Vec3 &axis, double scale, int steps) {
  const double R = 0.795 * scale, l = 1.28 * scale, dt = 0.1 * scale / steps;
  const double speed = 1e-3, time = steps * dt; // strains of about 1e-4
  const Vec3 u = unit(axis), v = {0.4 * speed, speed, -0.7 * speed};
  const Vec3 w = (1.0 / scale) * Vec3{1.5e-3, 1e-3, -2e-3};
  const Vec3 end_1 = {-0.5 * l, 0, 0}, end_2 = Vec3{0.5 * l, 0, 0} + time * v;
  std::ostringstream start;
  start.precision(17);
  start << "unfix integrate\ngroup s1 id 1\ngroup s2 id 2\nvelocity s2 set " << v.x << " " << v.y
        << " " << v.z << " units box\nfix load s2 move linear " << v.x << " " << v.y << " " << v.z
        << " units box\n"
        << spin(1, -w) << spin(2, w) << "run " << steps << "\nunfix load\n"
        << circle(1, end_1, u, dt, steps) << circle(2, end_2, u, dt, steps);
  const double theta = 0.5 * kPi / steps;
  const Vec3 common = (2.0 * std::tan(0.5 * theta) / dt) * u;
  start << spin(1, common) << spin(2, common) << "velocity all set 0 0 0 units box\n";
  Files files = files_of({{{-0.5 * l, 0, 0}, R, 1}, {{0.5 * l, 0, 0}, R, 1}},
                         -10 * scale * Vec3{1, 1, 1}, 10 * scale * Vec3{1, 1, 1});
  files["start.in"] += start.str();
  const CaseRun run("in.body",
                    {{"Ey", "1e3"},
                     {"restitution", "1"},
                     {"friction", "0"},
                     {"ced", "0"},
                     {"skin", number(0.4 * scale)},
                     {"dt", number(dt)},
                     {"steps", std::to_string(steps)},
                     {"every", std::to_string(steps)}},
                    1, files);
  const auto frames = run.frames();
  EXPECT_EQ(frames.size(), 2u) << run.why();
  if (frames.size() != 2)
    return HUGE_VAL;
  double worst = 0.0;
  for (const int s : {0, 1})
    for (const std::string q : {"f", "tq"}) {
      const auto vector = [&](const Row &r) {
        return Vec3{r.at(q + "x"), r.at(q + "y"), r.at(q + "z")};
      };
      const Vec3 before = vector(frames[0][s]), after = vector(frames[1][s]);
      worst = std::fmax(worst, norm(after - rotated(before, u, 0.5 * kPi)) / norm(before));
    }
  return worst;
}

} // namespace

TEST(VerificationObjectivity, PreloadedBondTurnedByNinetyDegrees) {
  for (const double scale : {1.0, 1e-6})
    for (const Vec3 &axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 2, 3}}) {
      const double e = turned(axis, scale, 1000);
      std::printf("turn about (%g %g %g), size %g: loads depart by %.1e\n", axis.x, axis.y, axis.z,
                  scale, e);
      EXPECT_LT(e, 1e-9);
    }
}
