// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "physics/hertz_contact.h"
#include "physics/nanopore_collapse.h"
#include "spheres.h"

using namespace calendem;

namespace {

constexpr double E = 2e6, nu = 0.3, R = 0.658, kTime = 0.1;
const double E_eff = effective_modulus(E, nu, E, nu);

std::string by_law(double hardening) { return "yield 2e3 hardening " + number(hardening); }

Files with_collapse(const std::vector<BodySphere> &all, const Vec3 &size, int update,
                    const std::string &law, Settings motion = {}) {
  Files files = files_of(all, {0, 0, 0}, size);
  const bool plates = !motion.empty();
  motion.insert({{"update", std::to_string(update)}, {"law", "\"" + law + "\""}});
  for (const auto &m : motion)
    files["start.in"] += "variable " + m.first + " index " + m.second + "\n";
  files["start.in"] += plates
                           ? "include ${cases}/platen/in.platen\nvariable done equal f_platen[7]\n"
                           : "variable done equal 0\n";
  files["start.in"] += "include ${cases}/nanopore_collapse/in.collapse\n";
  return files;
}

Settings soft() {
  return {{"Ey", number(E)}, {"ced", "0"},   {"friction", "0"}, {"bonded", "0"},
          {"bx", "p"},       {"by", "p"},    {"skin", "0.15"},  {"restitution", "0.5"},
          {"dt", "1e-4"},    {"every", "40"}};
}

// A ring: four spheres in a row through the periodic face, held apart by each other.
constexpr double kApart = 1.2;
std::vector<BodySphere> ring() {
  std::vector<BodySphere> all;
  for (int n = 0; n < 4; ++n)
    all.push_back({{(n + 0.5) * kApart, 2.4, 2.4}, R, n + 1});
  return all;
}

double ring_pressure(double r) {
  return mean_pressure(2.0 * hertz_force(E_eff, 0.5 * r, 2.0 * r - kApart), r);
}

// Nanoporosity of the ring after a time, by Runge and Kutta from the law's two equations.
double integrated(const NanoporeCollapse &law, double time) {
  const auto rate = [&](double phi) {
    return -(phi - std::fmin(law.target(ring_pressure(law.radius(R, phi))), phi)) / law.relaxation;
  };
  const int n = 2000;
  const double h = time / n;
  double phi = law.initial;
  for (int k = 0; k < n; ++k) {
    const double a = rate(phi), b = rate(phi + 0.5 * h * a), c = rate(phi + 0.5 * h * b),
                 d = rate(phi + h * c);
    phi += h / 6.0 * (a + 2 * b + 2 * c + d);
  }
  return phi;
}

// One sphere, pressed by two plates, held and released.
constexpr double kTop = 2 * R + 1e-4, kAim = kTop - 0.15;

struct Pressed {
  double lowest = 1.0;      ///< nanoporosity
  double most = 0.0;        ///< work of the plates
  double by_collapse = 0.0; ///< taken by it in the end
  double open = 0.0;        ///< what the ledger lacks at most
  double largest = 0.0;     ///< averaged pressure
};

Pressed pressed(const std::string &law) {
  const Settings motion = {{"motion", "position"}, {"aim", number(kAim)}, {"top", number(kTop)},
                           {"speed", "0.1"},       {"window", "0.05"},    {"dwell", "2"},
                           {"ramp", "0.1"},        {"lost_at", "0.01"}};
  Settings settings = soft();
  settings["steps"] = "60000";
  settings["every"] = "100";
  const CaseRun run(
      "in.body", settings, 1,
      with_collapse({{{2.4, 2.4, 0.5 * kTop}, R, 1}}, {4.8, 4.8, 4.8}, 10, law, motion));
  Pressed out;
  EXPECT_TRUE(run.finished()) << run.why();
  if (!run.finished())
    return out;
  for (const Row &row : run.rows("collapse.csv")) {
    EXPECT_LE(row.at("phi"), out.lowest);
    out.lowest = row.at("phi");
    out.most = std::fmax(out.most, row.at("work"));
    out.by_collapse = row.at("by_collapse");
    out.open = std::fmax(out.open, std::fabs(row.at("work") - row.at("held") - row.at("spent") -
                                             row.at("by_collapse") - row.at("kinetic")));
  }
  out.largest = run.rows("platen.csv").back().at("largest");
  return out;
}

} // namespace

// The explicit update takes the pressure at its beginning: first order in update * dt/t_r.
TEST(VerificationNanoporeCollapse, RingFollowsTheLaw) {
  const NanoporeCollapse law = {0.5, 0.27, 2e3, 5e3, kTime};
  std::vector<double> at_end, errors;
  for (const int update : {40, 20, 10}) {
    Settings settings = soft();
    settings["steps"] = "2000";
    const CaseRun run("in.body", settings, 1,
                      with_collapse(ring(), {4 * kApart, 4.8, 4.8}, update, by_law(law.hardening)));
    ASSERT_TRUE(run.finished()) << run.why();
    const Row last = run.rows("collapse.csv").back();
    errors.push_back(last.at("phi") - integrated(law, last.at("t")));
    EXPECT_NEAR(last.at("least"), last.at("phi"), 1e-12);
    EXPECT_NEAR(last.at("radius"), law.radius(R, last.at("phi")), 1e-12);
    EXPECT_NEAR(last.at("mass"), kDensity * 4.0 / 3.0 * kPi * R * R * R, 1e-12);
    const double r = last.at("radius");
    EXPECT_NEAR(last.at("gone"), 4 * 4.0 / 3.0 * kPi * (R * R * R - r * r * r), 1e-12);
  }
  const double order = std::log2(errors[1] / errors[2]);
  const double limit = 2.0 * errors[2] - errors[1]; // what is left of second order
  std::printf("ring: nanoporosity errors %.1e %.1e %.1e, order %.2f, extrapolated %.1e\n",
              errors[0], errors[1], errors[2], order, limit);
  EXPECT_NEAR(order, 1.0, 0.1);
  EXPECT_LT(std::fabs(limit), 0.1 * std::fabs(errors[2])); // update dt/t_r = 0.01 of it, ten times
}

// On two ranks every sphere has a ghost neighbour: radii of ghosts must follow.
TEST(VerificationNanoporeCollapse, SameOnTwoRanks) {
  std::vector<Row> ends;
  for (const int ranks : {1, 2}) {
    Settings settings = soft();
    settings["steps"] = "1000";
    const CaseRun run("in.body", settings, ranks,
                      with_collapse(ring(), {4 * kApart, 4.8, 4.8}, 20, by_law(5e3)));
    ASSERT_TRUE(run.finished()) << run.why();
    ends.push_back(run.rows("collapse.csv").back());
  }
  EXPECT_LT(ends[0].at("phi"), 0.45);
  for (const char *what : {"phi", "least", "held", "by_collapse"})
    EXPECT_NEAR(ends[1].at(what) / ends[0].at(what), 1.0, 1e-12) << what;
}

// At the dwell's end the nanoporosity is the one that its pressure leads to; it does not come back;
// work = energies + what was taken.
TEST(VerificationNanoporeCollapse, BetweenPlates) {
  const double hardening = 2e4;
  const NanoporeCollapse law = {0.5, 0.27, 2e3, hardening, kTime};
  const Pressed by = pressed(by_law(hardening));
  double low = law.floor, high = law.initial; // of phi - target: rising
  for (int n = 0; n < 100; ++n) {
    const double phi = 0.5 * (low + high), r = law.radius(R, phi);
    const double p = mean_pressure(2.0 * hertz_force(E_eff, r, r - 0.5 * kAim), r);
    (phi < law.target(p) ? low : high) = phi;
  }
  std::printf(
      "between plates: nanoporosity %.8f, by hand %.8f; ledger %.1e of the work, %.2g of it "
      "by collapse\n",
      by.lowest, low, by.open / by.most, by.by_collapse / by.most);
  EXPECT_NEAR(by.lowest, low, 1e-6);
  EXPECT_GT(by.by_collapse, 0.1 * by.most);
  EXPECT_LT(by.open / by.most, 1e-3);
}

// The sphere's nanoporosity is imposed by the platen's largest pressure.
TEST(VerificationNanoporeCollapse, ImposedByThePlaten) {
  const double until = 2e3;
  const NanoporeCollapse law = {0.5, 0.27, 0.0, 1.0, kTime};
  const Pressed by = pressed("imposed " + number(until));
  const double to = law.imposed(by.largest, until);
  std::printf("imposed: nanoporosity %.8f, by hand %.8f; ledger %.1e of the work\n", by.lowest, to,
              by.open / by.most);
  EXPECT_NEAR(by.lowest, to, 1e-6);
  EXPECT_GT(by.lowest, law.floor + 0.01); // the fall has not come to its end
  EXPECT_LT(by.lowest, law.initial - 0.01);
  EXPECT_LT(by.open / by.most, 1e-3);
}
