// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "bridged_spheres.h"
#include "physics/drying_shrinkage.h"

using namespace calendem;

namespace {

constexpr double kShrinkage = 0.002;
/// 700 steps: the run that is thrown is restarted in its middle.
constexpr double kFilmTime = 700 * kFilmStep;

CaseRun hold(const Joined &to, double time) {
  return move(to, 0.0, 0.0, {{"shrinkage", number(kShrinkage)}, {"dry_us", number(time)}});
}

Settings shrinking(double strain, double time) {
  return {{"shrinkage", number(strain)}, {"dry_us", number(time)}};
}

/// A layer of CBD at rest, in rows along x every other of which is shifted by half a spacing if
/// `triangular`; its rows along y are as wide as those of a square cell.
struct Layer {
  double spacing;
  int columns, rows;
  bool triangular;

  double width() const { return columns * spacing; }
  double depth() const { return rows * spacing * (triangular ? std::sqrt(0.75) : 1.0); }

  Files files() const {
    std::vector<Sphere> spheres = {{1, {1, 1, 2}}}; // the host wants a sphere of type 1
    for (int k = 0; k < columns * rows; ++k) {
      const int row = k / columns, column = k % columns;
      const double shift = triangular && row % 2 ? 0.75 : 0.25;
      spheres.push_back({2, {(column + shift) * spacing, (row + 0.5) * depth() / rows, 10}});
    }
    return files_of(spheres, width(), depth(), kIntegrate);
  }
};

double closed_form(const Layer &layer, double k_n) {
  const double load = k_n * kShrinkage * layer.spacing;
  return (layer.triangular ? std::sqrt(3.0) : 1.0) * load / layer.spacing;
}

double total(const Row &r) {
  return r.at("kinetic") + r.at("strain") + r.at("lost") + r.at("rest") - r.at("put");
}

} // namespace

// Whatever it joins, a bridge between what does not move bears E A eps s, and holds what was put in.
TEST(VerificationDryingStress, HeldSpheresArePulled) {
  for (const Joined &to : kJoined) {
    const double l = to.length(), k = E * kSection.area / l;
    const Vec3 to_other = to.other > 0.0 ? Vec3{1, 0, 0} : Vec3{0, 0, -1};
    for (const double time : {0.1, 0.0}) {
      const CaseRun run = hold(to, time);
      ASSERT_TRUE(run.finished()) << run.why();
      double force = 0.0, energy = 0.0, put = 0.0;
      for (const Row &r : run.rows("curve.csv")) {
        const double t = r.at("step") * dt;
        const double shrunk = kShrinkage * (time > 0.0 ? std::fmin(1.0, t / time) : 1.0);
        const double load = k * shrunk * l, stored = 0.5 * load * load / k;
        const Vec3 f = {r.at("fx"), r.at("fy"), r.at("fz")};
        force = std::fmax(force, norm(f - load * to_other));
        energy = std::fmax(energy, std::fabs(r.at("strain") - stored));
        put = std::fmax(put, std::fabs(r.at("put") - (time > 0.0 ? stored : 0.0)));
        EXPECT_NEAR(r.at("shrunk"), shrunk, 1e-12);
      }
      const double most = k * kShrinkage * l;
      std::printf("%s held, %g us: force to %.1e, energy to %.1e, what is put in to %.1e\n",
                  to.name, time, force / most, energy * k / most / most, put * k / most / most);
      EXPECT_LT(force, 1e-6 * most);
      EXPECT_LT(energy, 1e-6 * most * most / k);
      EXPECT_LT(put, 1e-6 * most * most / k);
    }
  }
}

TEST(VerificationDryingStress, HeldBridgeBreaksWhereItsStrengthIsReached) {
  const Joined &to = kJoined[1]; // 0.01 of the modulus
  const double strain = 1.25 * to.strength / E, time = 0.1;
  const CaseRun run = move(to, 0.0, 0.0, shrinking(strain, time));
  ASSERT_TRUE(run.finished()) << run.why();
  for (const Row &r : run.rows("curve.csv"))
    if (r.at("step") != 800) { // round-off decides which of two steps it is
      EXPECT_EQ(r.at("broken_cbd"), r.at("step") > 800 ? 1.0 : 0.0) << r.at("step");
    }
}

// E eps / (1 - nu) of a triangular layer, whose E and nu are 2 k_n / sqrt 3 and 1/3 per width.
TEST(VerificationDryingStress, AFilmIsUnderTheStressOfTheClosedForm) {
  const double spacing = 2 * kCbd + kGap, k_n = E * kSection.area / spacing;
  for (const Layer &layer : {Layer{spacing, 6, 6, false}, Layer{spacing, 6, 6, true}}) {
    const double expected = closed_form(layer, k_n);
    for (const char *fused : {"on", "off"}) {
      Settings settings = shrinking(kShrinkage, 0.05);
      settings.insert({{"fused", fused}, {"ced", "0"}});
      const CaseRun run("binder_bridges/in.bridges", settings, 1, layer.files());
      ASSERT_TRUE(run.finished()) << run.why();
      const Row end = last_row(run);
      std::printf("%s layer, fused %s: %.9g and %.9g nN/um, closed form %.9g\n",
                  layer.triangular ? "triangular" : "square", fused, end.at("width_x"),
                  end.at("width_y"), expected);
      EXPECT_NEAR(end.at("width_x"), expected, 1e-6 * expected);
      EXPECT_NEAR(end.at("width_y"), expected, 1e-6 * expected);
    }
  }
}

// First law: what shrinking puts in, bridges hold, breaks lose and the rest of the ledger.
TEST(VerificationDryingStress, LedgerThroughDryingAndBreaks) {
  for (const double time : {kFilmTime, 0.0}) {
    const std::vector<Row> rows = throw_film(shrinking(kShrinkage, time)).rows("curve.csv");
    ASSERT_GT(rows.size(), 100u);
    double worst = 0.0;
    for (const Row &r : rows)
      worst = std::fmax(worst, std::fabs(total(r) - total(rows.front())));
    const Row &end = rows.back();
    const double tolerance = kFilmTolerance * total(rows.front());
    std::printf("dried in %g us: ledger to %.1e of %.4g fJ, put in %.3g, at once %.3g, tolerance "
                "%.1e\n",
                time, worst / total(rows.front()), total(rows.front()), end.at("put"),
                rows.front().at("strain"), kFilmTolerance);
    for (const Joined &any : kJoined)
      EXPECT_GT(end.at(std::string("broken_") + any.name), 2.0) << any.name;
    EXPECT_GT(time > 0.0 ? end.at("put") : rows.front().at("strain"), 10 * tolerance);
    EXPECT_LT(worst, tolerance);
  }
}

TEST(VerificationDryingStress, SameBitsOnRanksAndAfterARestartInTheMiddle) {
  Settings settings = shrinking(kShrinkage, kFilmTime);
  settings["half"] = "300";
  const CaseRun one = throw_film(settings);
  Settings two_ranks = settings;
  two_ranks["px"] = "2";
  EXPECT_EQ(throw_film(two_ranks, 2).text("final.txt"), one.text("final.txt"));
  const Files half = half_way(one);
  settings["restart"] = two_ranks["restart"] = "1";
  const CaseRun again = throw_film(settings, 1, half), two = throw_film(two_ranks, 2, half);
  EXPECT_EQ(again.text("final.txt"), one.text("final.txt"));
  EXPECT_EQ(two.text("final.txt"), one.text("final.txt"));
  const Row end = last_row(one), end_again = last_row(again);
  for (const auto &[column, value] : end)
    EXPECT_EQ(end_again.at(column), value) << column;
}

TEST(VerificationDryingStress, OnePassGivesTheHostsForces) {
  Settings settings = shrinking(kShrinkage, kFilmTime);
  const CaseRun one = throw_film(settings);
  settings["fused"] = "off";
  const CaseRun host = throw_film(settings);
  const std::vector<double> a = numbers(one.text("final.txt")), b = numbers(host.text("final.txt"));
  ASSERT_EQ(a.size(), b.size());
  double apart = 0.0;
  for (size_t n = 0; n < a.size(); n += 10)
    for (int k = 1; k < 4; ++k)
      apart = std::fmax(apart, std::fabs(a[n + k] - b[n + k]));
  const Row p = last_row(one), q = last_row(host);
  std::printf("host's loop: places differ by %.1e um, work put in by %.1e\n", apart,
              p.at("put") / q.at("put") - 1.0);
  EXPECT_LT(apart, 1e-9);
  EXPECT_NEAR(p.at("put"), q.at("put"), 1e-9 * q.at("put"));
}

TEST(VerificationDryingStress, NoneChangesNoBit) {
  const CaseRun without = throw_film({}), none = throw_film(shrinking(0.0, kFilmTime));
  EXPECT_EQ(none.text("final.txt"), without.text("final.txt"));
  EXPECT_EQ(none.text("curve.csv"), without.text("curve.csv"));
}

TEST(VerificationDryingStress, WhatCannotBeStops) {
  Settings too_much = shrinking(0.04, 1.0), no_bridges = shrinking(kShrinkage, 1.0);
  no_bridges.insert({{"am", "0"}, {"cbd", "0"}, {"wall", "0"}});
  const std::pair<Settings, const char *> cases[] = {
      {too_much, "'shrinkage' is 0.04; at most 0.03 is allowed"},
      {no_bridges, "there are no binder bridges that could shrink"}};
  for (const auto &[settings, words] : cases) {
    const CaseRun run = move(kJoined[1], 0.0, 0.0, settings);
    EXPECT_FALSE(run.finished());
    EXPECT_NE(run.why().find(words), std::string::npos) << run.why();
  }
}

TEST(VerificationDryingStress, ARestartWithAnotherShrinkageStops) {
  const CaseRun one = throw_film(shrinking(kShrinkage, kFilmTime));
  for (const Settings &other : {shrinking(0.003, kFilmTime), shrinking(kShrinkage, 1.0)}) {
    Settings settings = other;
    settings.insert({{"restart", "1"}, {"ced", "0"}});
    const CaseRun run("binder_bridges/in.bridges", settings, 1, half_way(one));
    EXPECT_FALSE(run.finished());
    EXPECT_NE(run.why().find("it must stay as it was"), std::string::npos) << run.why();
  }
}
