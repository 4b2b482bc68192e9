// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "physics/pi.h"
#include "physics/roll_nip.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, nu = 0.3, R = 0.795, kSide = 5.0, kRoll = 2e5; // kPa, um
const double E_eff = effective_modulus(E, nu, E, nu);

CaseRun roll(const std::vector<BodySphere> &spheres, const Settings &of_roll, Settings settings,
             int ranks = 1) {
  settings.insert(
      {{"bx", "p"}, {"by", "p"}, {"gx", number(ranks)}, {"ced", "0"}, {"skin", "0.15"}});
  Files files = files_of(spheres, {0, 0, 0}, {kSide, kSide, 12});
  std::string start;
  for (const auto &[name, value] : of_roll)
    start.append("variable ").append(name).append(" index ").append(value).append("\n");
  files["start.in"] += start + "include ${cases}/roll/in.roll\n";
  return CaseRun("in.body", settings, ranks, files);
}

const std::vector<BodySphere> kSphere = {{{2.5, 2.5, R}, R, 1}};

} // namespace

// A sphere between collector and roll, twice: the roll's path h = h_min + s^2 / 2R at the web's
// speed, the load of two Hertz contacts, the line load of the nip.
TEST(VerificationRoll, PathLoadAndLineLoad) {
  const double top = 2 * R, speed = 0.005, dt = 2e-4, gaps[] = {top - 0.015, top - 0.025};
  const RollNip nip = {kRoll, 0.5 * kRoll, 0.0};
  const int every = 20;
  const CaseRun run = roll(kSphere,
                           {{"top", number(top)},
                            {"gap", number(gaps[1])},
                            {"first", number(gaps[0])},
                            {"passes", "2"},
                            {"radius", number(nip.radius)},
                            {"counter", number(nip.counter)},
                            {"speed", number(speed)}},
                           {{"bonded", "0"},
                            {"friction", "0"},
                            {"restitution", "0.3"},
                            {"dt", number(dt)},
                            {"steps", "200000"},
                            {"every", number(every)}});
  ASSERT_TRUE(run.finished()) << run.why();
  const auto load_at = [&](double h) { return hertz_force(E_eff, R, 0.5 * std::fmax(top - h, 0)); };
  const double largest = load_at(gaps[1]);
  double begin = 0.0, path = 0.0, force = 0.0, line[2] = {}, lowest[2] = {top, top};
  double before = -nip.distance(top - gaps[0]);
  int pass = 0, rows = 0;
  for (const Row &r : run.rows("roll.csv")) {
    if (r.at("stage") == 4)
      break;
    const int now = r.at("left") > 0.5 ? 0 : 1;
    const double way = nip.distance(top - gaps[now]), u = nip.web_speed(speed, top - gaps[now]);
    if (now != pass) { // the first is over
      begin = 2.0 * nip.distance(top - gaps[0]) / nip.web_speed(speed, top - gaps[0]);
      before = -way;
      pass = now;
    }
    const double s = u * (r.at("step") * dt - begin) - way;
    path = std::fmax(path, std::fabs(r.at("height") - gaps[now] - nip.above(s)));
    force = std::fmax(force, std::fabs(r.at("load") - load_at(r.at("height"))) / largest);
    line[now] += r.at("load") * (s - before);
    lowest[now] = std::fmin(lowest[now], r.at("height"));
    before = s;
    ++rows;
  }
  std::printf("roll: path to %.1e um, load to %.1e of the largest\n", path, force);
  EXPECT_GT(rows, 1000);
  EXPECT_LT(path, 6.5 * speed * dt); // six steps: one in each nip, one of round-off on each way
  EXPECT_LT(force, 1e-3);
  for (const int n : {0, 1}) {
    const double depth = top - gaps[n];
    const double expected = 3.0 * kPi / 8.0 * load_at(gaps[n]) * nip.distance(depth);
    std::printf("pass %d: smallest gap off by %.1e um, line load by %.1e\n", n + 1,
                lowest[n] - gaps[n], line[n] / expected - 1.0);
    EXPECT_LT(lowest[n] - gaps[n], nip.above(every * dt * nip.web_speed(speed, depth)));
    EXPECT_NEAR(line[n] / expected, 1.0, 1e-3);
  }
}

// A sphere between collector and a roll that runs ahead rolls at half of the slip.
TEST(VerificationRoll, SlipRollsASphereOnOneAndTwoRanks) {
  const double top = 2 * R, depth = 0.05, speed = 0.05, dt = 5e-5, slip = 1e-3;
  const RollNip nip = {kRoll, kRoll, slip};
  const double way = nip.distance(depth), u = nip.web_speed(speed, depth);
  const int steps = static_cast<int>(1.5 * way / u / dt);
  std::vector<std::vector<Row>> ends;
  for (const int ranks : {1, 2}) {
    const CaseRun run = roll(kSphere,
                             {{"top", number(top)},
                              {"gap", number(top - depth)},
                              {"radius", number(nip.radius)},
                              {"counter", number(nip.counter)},
                              {"slip", number(slip)},
                              {"speed", number(speed)}},
                             {{"bonded", "0"},
                              {"friction", "1"},
                              {"dt", number(dt)},
                              {"steps", number(steps)},
                              {"every", "100"}},
                             ranks);
    ASSERT_TRUE(run.finished()) << run.why();
    ends.push_back(run.frames().back());
  }
  const double moved = ends[0][0].at("x") - 2.5, slipped = slip * u * steps * dt;
  // from rest by friction: (1/2) v m = int F dt under the growing load of d = v t / 2
  const double mass = 4.0 / 3.0 * kPi * R * R * R * kDensity;
  const double rise = hertz_force(E_eff, R, 1.0) * std::pow(0.5 * speed, 1.5);
  const double start = std::pow(2.5 * 0.5 * slip * u * mass / rise, 0.4);
  std::printf("slip of %.4g um moves the sphere by %.5f of it; start takes %.1e\n", slipped,
              moved / slipped, start * u * slip / slipped);
  EXPECT_NEAR(moved, 0.5 * slipped, start * u * slip);
  EXPECT_NEAR(ends[0][0].at("vx"), 0.5 * slip * u, 1e-2 * slip * u);
  EXPECT_NEAR(ends[1][0].at("x"), ends[0][0].at("x"), 1e-12);
}

// A cube that cannot roll slides: the roll's work, along and across, is motion, elastic energy and
// what damping and friction take. On two ranks the cube lies on both; faster, to be done sooner.
TEST(VerificationRoll, LedgerWithSlipOnOneAndTwoRanks) {
  const double spacing = 1.28, top = 2 * R + spacing, depth = 0.03, dt = 2e-5;
  const RollNip nip = {kRoll, kRoll, 0.01};
  for (const int ranks : {1, 2}) {
    const double speed = ranks == 1 ? 0.2 : 2.0;
    const double way = nip.distance(depth), u = nip.web_speed(speed, depth);
    const CaseRun run = roll(cube(2, spacing, {1.86, 1.86, R}, 1),
                             {{"top", number(top)},
                              {"gap", number(top - depth)},
                              {"radius", number(nip.radius)},
                              {"counter", number(nip.counter)},
                              {"slip", number(nip.slip)},
                              {"speed", number(speed)}},
                             {{"friction", "0.1"},
                              {"dt", number(dt)},
                              {"steps", number(static_cast<int>(1.9 * way / u / dt))},
                              {"every", "50"}},
                             ranks);
    ASSERT_TRUE(run.finished()) << run.why();
    const std::vector<Row> rows = run.rows("roll.csv"), curve = run.rows("curve.csv");
    ASSERT_EQ(rows.size(), curve.size());
    double worst = 0.0, most = 0.0, friction = 0.0;
    for (size_t n = 0; n < rows.size(); ++n) {
      const double held = curve[n].at("kinetic") + curve[n].at("rotational") +
                          curve[n].at("strain") + rows[n].at("elastic") + rows[n].at("damped") +
                          rows[n].at("friction");
      worst = std::fmax(worst, std::fabs(rows[n].at("work") - held));
      most = std::fmax(most, rows[n].at("elastic") + curve[n].at("strain"));
      friction = std::fmax(friction, rows[n].at("friction"));
    }
    std::printf("slip, %d ranks: work and energy differ by %.1e of %.4g fJ; friction took %.3g of "
                "it\n",
                ranks, worst / most, most, friction / most);
    EXPECT_GT(friction, 0.1 * most);
    EXPECT_LT(worst / most, 1.4e-4); // (omega dt)^2 / 16
  }
}
