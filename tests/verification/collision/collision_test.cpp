// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "collision/impact.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr int kSteps = 4000; // in the shortest contact of a run

const Material aluminium_oxide(double mu, double e) {
  return {"aluminium oxide", 3.8e8, 0.23, 4.0, mu, e};
}
const Material aluminium_alloy(double e) { return {"aluminium alloy", 7e7, 0.33, 2.7, 0.4, e}; }
const Material nylon(double e) { return {"nylon", 2.5e6, 0.4, 1.0, 0.4, e}; }

/// The host's step for impacts side by side, and how long they last.
struct Clock {
  double dt = HUGE_VAL, longest = 0.0;

  Clock(const Material &m, const std::vector<Impact> &all) {
    for (const Impact &i : all) {
      const double time = Contact(m, i).time(i.closing());
      dt = std::fmin(dt, time / kSteps);
      longest = std::fmax(longest, time);
    }
  }
};

// Side by side in one box; each impact begins 2.5 steps after the start.
std::vector<BodySphere> placed(const std::vector<Impact> &all, double dt, double largest) {
  std::vector<BodySphere> spheres;
  const auto add = [&](const Ball &b, double x, double z) {
    spheres.push_back({{x, 4.0 * largest, z},
                       b.R,
                       static_cast<int>(spheres.size()) + 1,
                       {b.vx, 0.0, b.vz},
                       {0.0, b.spin, 0.0}});
  };
  double x = 2.0 * largest;
  for (const Impact &i : all) {
    const double low = i.on_plane() ? 0.0 : 6.0 * largest;
    add(i.upper, x, low + i.lower.R + i.upper.R + 2.5 * dt * i.closing());
    if (!i.on_plane())
      add(i.lower, x, low);
    x += 4.0 * largest;
  }
  return spheres;
}

// Runs the impacts for `times` the longest contact; frames `every` so many steps, 0: begin and end.
CaseRun collide(const Material &m, const std::vector<Impact> &all, double times, int every = 0) {
  const Clock clock(m, all);
  double largest = 0.0;
  for (const Impact &i : all)
    largest = std::fmax(largest, std::fmax(i.upper.R, i.lower.R));
  const double side = std::fmax(4.0 * largest * all.size(), 8.0 * largest);
  const int steps = static_cast<int>(times * clock.longest / clock.dt) + 5;
  return CaseRun("collision/in.collision",
                 {{"Ey", number(all[0].on_plane() ? 2.0 * m.E : m.E)}, // two such: a rigid plane
                  {"nu", number(m.nu)},
                  {"density", number(m.density)},
                  {"friction", number(m.mu)},
                  {"restitution", number(m.e)},
                  {"ced", "0"},
                  {"dt", number(clock.dt)},
                  {"skin", number(0.05 * largest)},
                  {"steps", number(steps)},
                  {"every", number(every ? every : steps)}},
                 1,
                 files_of(placed(all, clock.dt, largest), {0, 0, -largest},
                          {side, 8.0 * largest, 16.0 * largest}));
}

// The impacts after they are over.
std::vector<Impact> after(const CaseRun &run, const std::vector<Impact> &all) {
  const auto frames = run.frames();
  EXPECT_EQ(frames.size(), 2u) << run.why();
  std::vector<Impact> found;
  size_t row = 0;
  const auto ball = [&](double R) {
    const Row &r = frames.back().at(row++);
    return Ball{R, r.at("vx"), r.at("vz"), r.at("omegay")};
  };
  for (const Impact &i : all) {
    const Ball upper = ball(i.upper.R);
    found.push_back({upper, i.on_plane() ? Ball() : ball(i.lower.R)});
  }
  return found;
}

// Largest difference of speeds and of spins times radius.
double difference(const Impact &a, const Impact &b) {
  double most = 0.0;
  for (const auto &[p, q] : {std::pair(a.upper, b.upper), std::pair(a.lower, b.lower)})
    for (const double d : {p.vx - q.vx, p.vz - q.vz, p.R * (p.spin - q.spin)})
      most = std::fmax(most, std::fabs(d));
  return most;
}

// Error of the host's restitution: damping with the speed of half a step before, and its first and
// last step.
double lag(double e) {
  const double beta = damping_ratio(e);
  return 2.0 * kPi * beta * beta / std::pow(1.0 - beta * beta, 1.5) / kSteps +
         6.2 * beta * std::pow(kSteps, -1.25);
}

// Compares with the reference and, in elastic impacts that slide all the time, with the closed
// form.
std::vector<Impact> compare(const Material &m, const std::vector<Impact> &all, double times) {
  const CaseRun run = collide(m, all, times);
  EXPECT_TRUE(run.finished()) << run.why();
  const std::vector<Impact> found = after(run, all);
  double worst = 0.0, share = 0.0, sliding = 0.0;
  const double dt = Clock(m, all).dt;
  int slid = 0;
  for (size_t n = 0; n < all.size(); ++n) {
    const Contact c(m, all[n]);
    const double v = all[n].closing();
    Reference reference(m, all[n]);
    const double error = difference(found[n], reference.after()) / v;
    const double step =
        2.5 * reference.most_friction() * dt / (c.m * v) + lag(m.e) + std::pow(4.0 / kSteps, 2);
    worst = std::fmax(worst, error);
    share = std::fmax(share, error / step);
    EXPECT_LT(error, step) << m.name << ", impact " << n;
    if (m.e < 0.95 || !slides_throughout(m, all[n]))
      continue;
    const double arms = 2.5 * m.mu * (1.0 + m.e) * c.depth(v) / (2.0 * all[n].upper.R);
    const double attraction = 10.0 * m.mu * std::pow(damping_ratio(m.e), 2);
    const double closed = difference(found[n], after_sliding(m, all[n])) / v;
    EXPECT_LT(closed, arms + attraction) << m.name << ", impact " << n;
    sliding = std::fmax(sliding, closed);
    ++slid;
  }
  std::printf("%s, e %.2f: %zu impacts within %.1e of the closing speed (%.2f of the tolerance); "
              "closed form of %d that slide: %.1e\n",
              m.name, m.e, all.size(), worst, share, slid, sliding);
  return found;
}

std::vector<double> tangents() { // of angles to the normal
  std::vector<double> all;
  for (int angle = 5; angle <= 85; angle += 5)
    all.push_back(std::tan(angle * kPi / 180.0));
  return all;
}

} // namespace

// Tests 1 and 2: without friction and damping the impact is Hertz'.
TEST(VerificationCollision, ElasticNormalImpact) {
  const Impact pair = {{1e4, 0.0, -10.0, 0.0}, {1e4, 0.0, 10.0, 0.0}};
  const Impact plane = {{1e5, 0.0, -0.2, 0.0}, {}};
  const std::vector<std::pair<Material, Impact>> cases = {
      {{"glass", 4.8e7, 0.2, 2.8, 0.35, 1.0}, pair},
      {{"limestone", 2e7, 0.25, 2.5, 0.35, 1.0}, pair},
      {{"aluminium alloy", 7e7, 0.3, 2.699, 0.0, 1.0}, plane},
      {{"magnesium alloy", 4e7, 0.35, 1.8, 0.0, 1.0}, plane}};
  for (const auto &[m, i] : cases) {
    const CaseRun run = collide(m, {i}, 1.0, 1);
    ASSERT_TRUE(run.finished()) << run.why();
    double time = 0.0, before = -1.0, force = 0.0; // time in steps, by interpolation at both ends
    const auto frames = run.frames();
    for (size_t n = 0; n < frames.size(); ++n) {
      const double low = i.on_plane() ? 0.0 : frames[n][1].at("z") + i.lower.R;
      const double overlap = i.upper.R + low - frames[n][0].at("z");
      if ((before <= 0.0) != (overlap <= 0.0) && n > 0)
        time = n - overlap / (overlap - before) - time;
      before = overlap;
      force = std::fmax(force, frames[n][0].at("fz"));
    }
    const double v = i.closing(), expected = Contact(m, i).force(v);
    std::printf("%s: largest force %.6g kN, error %.1e; time %.6g us, error %.1e\n", m.name,
                1e-12 * force, force / expected - 1.0, Contact(m, i).time(v), time / kSteps - 1.0);
    const double second_order = std::pow(4.0 / kSteps, 2); // (omega dt)^2
    EXPECT_NEAR(force / expected, 1.0, second_order);
    EXPECT_NEAR(time / kSteps, 1.0, second_order);
  }
}

// Test 3: the speed after is e times that before.
TEST(VerificationCollision, RestitutionIsTheOneAskedFor) {
  for (const double e : {0.1, 0.2, 0.4, 0.6, 0.8, 1.0})
    for (const Material &m :
         {aluminium_oxide(0.0, e), Material{"cast iron", 1e8, 0.25, 7.0, 0.0, e}}) {
      const std::vector<Impact> all = {{{2500.0, 0.0, -3.9, 0.0}, {}}};
      const CaseRun run = collide(m, all, 3.0);
      ASSERT_TRUE(run.finished()) << run.why();
      const double found = -after(run, all)[0].closing() / 3.9;
      std::printf("%s: restitution %.1f asked, relative error %.1e, tolerance %.1e\n", m.name, e,
                  found / e - 1.0, lag(e));
      EXPECT_NEAR(found / e, 1.0, lag(e) + 1e-9); // 1e-9: round-off of the overlap
    }
}

// Test 4: from nearly normal to grazing impact at one speed.
TEST(VerificationCollision, ObliqueAtConstantSpeed) {
  std::vector<Impact> all;
  for (const double t : tangents())
    all.push_back({{2500.0, 3.9 * t / std::hypot(1.0, t), -3.9 / std::hypot(1.0, t), 0.0}, {}});
  const std::vector<Impact> found = compare(aluminium_oxide(0.092, 0.98), all, 1.1);
  for (const size_t n : {0u, 1u, 3u, 5u, 8u, 11u, 14u}) {
    const Ball &b = found[n].upper;
    std::printf(
        "  %d degrees: tangential restitution %.4f, spin %.0f rad/s, rebound of the surface "
        "%.2f degrees\n",
        5 * (static_cast<int>(n) + 1), b.vx / all[n].upper.vx, 1e6 * b.spin,
        std::atan2(found[n].slip(), b.vz) * 180.0 / kPi);
  }
}

// Test 5: a small sphere, one normal speed, elastic.
TEST(VerificationCollision, ObliqueAtConstantNormalSpeed) {
  std::vector<Impact> all;
  for (const double t : tangents())
    all.push_back({{10.0, 5.0 * t, -5.0, 0.0}, {}});
  compare({"steel", 2.08e8, 0.3, 7.85, 0.3, 1.0}, all, 1.1);
}

// Test 6: a sphere that spins falls straight on the plane.
TEST(VerificationCollision, SpinningSphereOnAPlane) {
  std::vector<Impact> all;
  for (const double t : tangents())
    all.push_back({{1e5, 0.0, -0.2, -0.2 * t / 1e5}, {}});
  for (const double e : {0.5, 1.0})
    for (const Material &m : {aluminium_alloy(e), nylon(e)}) {
      const std::vector<Impact> found = compare(m, all, 1.6);
      const double impulse = -found.back().upper.vx / (m.mu * (1.0 + e) * 0.2);
      std::printf("  impulse of friction at 85 degrees: %.3f mu m (1 + e) v\n", impulse);
    }
}

// Test 7: equal spheres that spin against each other roll like gears; with spins of one sense they
// rub.
TEST(VerificationCollision, EqualSpheresThatSpin) {
  for (const double e : {0.5, 1.0}) {
    std::vector<Impact> gears, rub;
    for (const double t : tangents()) {
      const double spin = 0.2 * t / 1e5;
      gears.push_back({{1e5, 0.0, -0.2, spin}, {1e5, 0.0, 0.2, -spin}});
      rub.push_back({{1e5, 0.0, -0.2, spin}, {1e5, 0.0, 0.2, spin}});
    }
    const std::vector<Impact> found = compare(aluminium_alloy(e), gears, 1.6);
    for (size_t n = 0; n < gears.size(); ++n) {
      EXPECT_EQ(found[n].upper.vx, 0.0);
      EXPECT_EQ(found[n].lower.vx, 0.0);
      EXPECT_EQ(found[n].upper.spin, gears[n].upper.spin);
      EXPECT_EQ(found[n].lower.spin, gears[n].lower.spin);
    }
    compare(aluminium_alloy(e), rub, 1.6);
  }
}

// Test 8: a sphere that spins meets one five times as large; both are free, so that momentum and
// angular momentum stay what they were.
TEST(VerificationCollision, UnequalSpheres) {
  for (const double e : {0.5, 1.0}) {
    std::vector<Impact> all;
    for (const double t : tangents())
      all.push_back({{1e5, 0.0, -0.2, 0.2 * t / 1e5}, {5e5, 0.0, 0.0, 0.0}});
    const Material m = aluminium_alloy(e);
    const std::vector<Impact> found = compare(m, all, 1.6);
    const double m1 = mass_of(m, 1e5), m2 = mass_of(m, 5e5);
    for (size_t n = 0; n < all.size(); ++n)
      EXPECT_NEAR(m1 * found[n].upper.vx, -m2 * found[n].lower.vx, 1e-12 * m1 * 0.2);
  }
}
