// SPDX-License-Identifier: GPL-2.0-or-later
// Spheres held by binder bridges, for the cases that run binder_bridges/in.bridges: one that is
// moved away from what it is joined to, and a film that is thrown.
#ifndef CALENDEM_TESTS_BRIDGED_SPHERES_H
#define CALENDEM_TESTS_BRIDGED_SPHERES_H

#include "physics/parallel_bond.h"
#include "run_case.h"
#include <cmath>

namespace calendem {

// um, kPa, pg/um3
constexpr double kAm = 0.795, kCbd = 0.658, kGap = 0.004, kInset = 0.09;
constexpr double E = 5e5, G = E / 2.6, kLambda = 0.5, kRatio = 2.0, dt = 1e-4;
constexpr double kSteps = 1279.53; // until the break: well away from a whole number

struct Sphere {
  int type;
  Vec3 x, v = {}, spin = {};
  int body = 0;
};

/// atoms.data, bodies.map and start.in; types 1 AM, 2 CBD.
inline Files files_of(const std::vector<Sphere> &spheres, double width, double depth,
                      const std::string &start) {
  std::ostringstream data, map, set;
  for (std::ostringstream *s : {&data, &map, &set})
    s->precision(17);
  data << "verification case\n\n"
       << spheres.size() << " atoms\n3 atom types\n0 " << width << " xlo xhi\n0 " << depth
       << " ylo yhi\n0 20 zlo zhi\n\nAtoms\n\n";
  map << "# tag body\n";
  int tag = 0;
  for (const Sphere &s : spheres) {
    const bool am = s.type == 1;
    data << ++tag << " " << s.type << " " << 2.0 * (am ? kAm : kCbd) << " " << (am ? 4.65 : 0.915)
         << " " << s.x.x << " " << s.x.y << " " << s.x.z << "\n";
    if (s.body > 0)
      map << tag << " " << s.body << "\n";
    if (norm(s.v) + norm(s.spin) > 0.0)
      set << "set atom " << tag << " vx " << s.v.x << " vy " << s.v.y << " vz " << s.v.z
          << " omegax " << s.spin.x << " omegay " << s.spin.y << " omegaz " << s.spin.z << "\n";
  }
  return {{"atoms.data", data.str()}, {"bodies.map", map.str()}, {"start.in", set.str() + start}};
}

/// What a bridge joins a CBD sphere to.
struct Joined {
  const char *name;       // of its columns, and of its strength
  double strength, other; // kPa; radius, 0: the collector
  double length() const { return kCbd + other + kGap; }
};
inline const Joined kJoined[] = {{"am", 1e4, kAm}, {"cbd", 5e3, kCbd}, {"wall", 2e3, 0.0}};
inline const BondSection kSection(kLambda *kCbd); // the CBD sphere is the smaller one everywhere

/// The CBD sphere leaves along the line, or is moved across it, at this speed. AM is a body's.
inline CaseRun move(const Joined &to, double along, double across, Settings settings = {},
                    double length = 0.0) {
  const double l = length > 0.0 ? length : to.length();
  std::vector<Sphere> spheres = {{2, {5, 5, to.other > 0.0 ? 10 : l}}};
  if (to.other > 0.0)
    spheres.push_back({to.other == kAm ? 1 : 2, {5 + l, 5, 10}, {}, {}, to.other == kAm ? 1 : 0});
  spheres.push_back({1, {2, 2, 15}}); // the host wants a sphere of type 1
  const Vec3 v = to.other > 0.0 ? Vec3{-along, across, 0} : Vec3{0, across, along};
  const std::string speed = number(v.x) + " " + number(v.y) + " " + number(v.z);
  settings.insert({{"ced", "0"}, {"dt", number(dt)}});
  return CaseRun("binder_bridges/in.bridges", settings, 1,
                 files_of(spheres, 10, 10,
                          "group moved id 1\nvelocity moved set " + speed +
                              " units box\nfix mv moved move linear " + speed + " units box\n"));
}

constexpr double kFilmStep = 1e-5, kFilmModulus = 2e7; // us, kPa
// The fastest are the bonds inside the bodies: Verlet's energy swings by (omega dt)^2 / 16.
constexpr double kFilmTolerance = kFilmModulus * kPi * kAm * kAm / 1.28 /
                                  (0.5 * 4.0 / 3.0 * kPi * kAm * kAm * kAm * 4.65) * kFilmStep *
                                  kFilmStep / 16.0;
inline const char *const kIntegrate = "fix integrate all nve/sphere\n";

inline double noise(int n) { // reproducible, in (-1, 1)
  const double x = std::sin(12.9898 * n + 4.1) * 43758.5453;
  return 2.0 * (x - std::floor(x)) - 1.0;
}

/// On each of 16 sites, which faces of the cell and borders of ranks cut: two CBD spheres on the
/// collector, a body of two AM spheres that one of them holds, and CBD on top; all thrown.
/// `inset`: of the body's surface [um].
inline Files film(double inset = 0.0) {
  std::vector<Sphere> all;
  const double side = 16.0, low = kCbd + kGap, half = kCbd + 0.5 * kGap;
  const double held = kCbd + kAm + kGap - inset;
  int n = 0, body = 0;
  for (int site = 0; site < 16; ++site) {
    const int column = site % 4, row = site / 4;
    const double x = 4.0 * column, y = 4.0 * row, z = low + held;
    ++body;
    for (Sphere s : {Sphere{2, {x + half, y, low}},
                     {2, {x - half, y, low}},
                     {1, {x + half, y, z}},
                     {1, {x + half, y, z + 1.28}},
                     {2, {x + half, y, z + 1.28 + held}}}) {
      s.body = s.type == 1 ? body : 0;
      s.x.x -= side * std::floor(s.x.x / side);
      const double speed = s.type == 1 ? 0.6 : 4.0;
      s.v = speed * Vec3{noise(n + 1), noise(n + 2), noise(n + 3)};
      s.spin = Vec3{noise(n + 4), noise(n + 5), noise(n + 6)};
      n += 6;
      all.push_back(s);
    }
  }
  return files_of(all, side, side, kIntegrate);
}

inline CaseRun throw_film(Settings settings, int ranks = 1, Files files = {}) {
  if (files.empty())
    files = film(settings.count("inset") ? std::stod(settings["inset"]) : 0.0);
  const Settings all = {{"dt", number(kFilmStep)},
                        {"ced", "1e3"},
                        {"Eb", number(kFilmModulus)},
                        {"Ey", number(kFilmModulus)},
                        {"damping", "0.02"},
                        {"restitution", "0.5"},
                        {"am", "4e3"},
                        {"cbd", "3e3"},
                        {"steps", "3000"},
                        {"half", "1000"},
                        {"px", "1"},
                        {"py", "1"}};
  settings.insert(all.begin(), all.end());
  CaseRun run("binder_bridges/in.bridges", settings, ranks, files);
  EXPECT_TRUE(run.finished()) << run.why();
  return run;
}

/// What goes on from the middle of a film that was thrown.
inline Files half_way(const CaseRun &run) {
  std::ifstream in(run.folder() / "half.restart", std::ios::binary);
  return {{"half.restart", {std::istreambuf_iterator<char>(in), {}}},
          {"bodies.map", run.text("bodies.map")},
          {"start.in", kIntegrate}};
}

inline Row last_row(const CaseRun &run) {
  const std::vector<Row> rows = run.rows("curve.csv");
  return rows.empty() ? Row() : rows.back();
}

inline std::vector<double> numbers(const std::string &state) {
  std::istringstream in(state.substr(state.find("omegaz") + 6));
  return {std::istream_iterator<double>(in), {}};
}

} // namespace calendem

#endif
