// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "bridged_spheres.h"
#include "physics/binder_bridge.h"
#include "physics/hertz_contact.h"
#include "physics/sjkr_cohesion.h"

using namespace calendem;

namespace {

/// Broken in the step of the closed form, counted as its kind alone.
void expect_break(const CaseRun &run, const Joined &to, int step) {
  for (const Row &r : run.rows("curve.csv")) {
    const bool broken = r.at("step") >= step;
    for (const Joined &any : kJoined) {
      const bool own = &any == &to || std::string(any.name) == to.name;
      EXPECT_EQ(r.at(std::string("made_") + any.name), own ? 1.0 : 0.0);
      EXPECT_EQ(r.at(std::string("broken_") + any.name), own && broken ? 1.0 : 0.0)
          << any.name << " at step " << r.at("step");
    }
    EXPECT_EQ(r.at("bonds") + r.at("bonds_broken"), 0.0);
  }
  EXPECT_EQ(run.text("breaks.csv").find('\n'), run.text("breaks.csv").size() - 1);
}

/// Surfaces of bodies at the tips of their primaries and inside them; then such that come out as
/// bonds break, which all do.
const Settings kAtTips = {}, kInside = {{"inset", number(kInset)}},
               kComingOut = {
                   {"inset", number(kInset)}, {"fading", "1"}, {"sc", "3e3"}, {"tc", "3e3"}};

/// Largest difference of the force on the moved sphere from `law(way)`, and of the stored energy
/// from `energy(way)`, of the largest, before the break; 0 after it.
struct Errors {
  double force = 0.0, energy = 0.0;
};
template <class Law, class Energy>
Errors errors(const CaseRun &run, double speed, int step, Law law, Energy energy) {
  Errors worst;
  double most = 0.0, most_energy = 0.0;
  int rows = 0;
  for (const Row &r : run.rows("curve.csv")) {
    const double way = speed * r.at("step") * dt;
    const bool acts = r.at("step") <= step, stored = r.at("step") < step;
    const Vec3 expected = acts ? law(way) : Vec3{};
    worst.force = std::fmax(worst.force, norm(Vec3{r.at("fx"), r.at("fy"), r.at("fz")} - expected));
    worst.energy =
        std::fmax(worst.energy, std::fabs(r.at("strain") - (stored ? energy(way) : 0.0)));
    most = std::fmax(most, norm(expected));
    most_energy = std::fmax(most_energy, r.at("strain"));
    rows += acts;
    if (!stored) {
      EXPECT_NEAR(r.at("lost") / energy(speed * step * dt), 1.0, 1e-6);
    }
  }
  EXPECT_GT(rows, 100) << run.why();
  return {worst.force / most, worst.energy / most_energy};
}

} // namespace

TEST(VerificationBinderBridges, PulledToFailure) {
  for (const Joined &to : kJoined) {
    const double l = to.length(), k = E * kSection.area / l;
    const double v = to.strength * l / E / (kSteps * dt);
    const CaseRun run = move(to, v, 0.0);
    ASSERT_TRUE(run.finished()) << run.why();
    const Vec3 back = to.other > 0.0 ? Vec3{1, 0, 0} : Vec3{0, 0, -1};
    const Errors e = errors(
        run, v, 1280, [&](double d) { return k * d * back; },
        [&](double d) { return 0.5 * k * d * d; });
    std::printf("%s pulled: force to %.1e, energy to %.1e\n", to.name, e.force, e.energy);
    EXPECT_LT(e.force, 1e-6);
    EXPECT_LT(e.energy, 1e-6);
    expect_break(run, to, 1280);
    if (to.other > 0.0)
      continue;
    for (const Row &r : run.rows("curve.csv")) // the collector is pulled as the sphere is
      EXPECT_NEAR(r.at("load"), r.at("fz"), 1e-6 * k * v * kSteps * dt);
  }
}

TEST(VerificationBinderBridges, ShearedToFailure) {
  for (const Joined &to : kJoined) {
    const double l = to.length(), kn = E * kSection.area / l, kt = G * kSection.area / l;
    const double v = l * std::sinh(kRatio * to.strength / G) / (kSteps * dt);
    const CaseRun run = move(to, 0.0, v);
    ASSERT_TRUE(run.finished()) << run.why();
    const Vec3 away = to.other > 0.0 ? Vec3{-1, 0, 0} : Vec3{0, 0, 1}, side = {0, 1, 0};
    const auto shear = [&](double s) { return kt * l * std::asinh(s / l); };
    const auto tension = [&](double s) { return kn * (std::hypot(l, s) - l); };
    const Errors e = errors(
        run, v, 1280,
        [&](double s) {
          const double r = std::hypot(l, s);
          const Vec3 n = (1.0 / r) * (l * away + s * side),
                     across = (1.0 / r) * (l * side - s * away);
          return -tension(s) * n - shear(s) * across;
        },
        [&](double s) {
          return 0.5 * (std::pow(tension(s), 2) / kn + std::pow(shear(s), 2) / kt);
        });
    std::printf("%s sheared: force to %.1e, energy to %.1e\n", to.name, e.force, e.energy);
    EXPECT_LT(e.force, 1e-6);
    EXPECT_LT(e.energy, 1e-6);
    expect_break(run, to, 1280);
    if (to.other > 0.0)
      continue;
    for (const Row &r : run.rows("curve.csv")) { // half of the height is the shear's arm
      const double s = v * r.at("step") * dt;
      const double moment = r.at("step") <= 1280 ? 0.5 * std::hypot(l, s) * shear(s) : 0.0;
      EXPECT_NEAR(std::fabs(r.at("tx")), moment, 1e-6 * l * shear(v * kSteps * dt));
    }
  }
}

TEST(VerificationBinderBridges, NoneBeyondTheGapOrWithoutStrength) {
  for (const Joined &to : kJoined) {
    for (const double inset : {0.0, kInset})
      for (const double gap : {0.0199, 0.0201}) {
        const double room = kCbd + to.other; // of the spheres
        const CaseRun run =
            move(to, 0.0, 0.0, {{"steps", "600"}, {"inset", number(inset)}}, room + gap);
        ASSERT_TRUE(run.finished()) << run.why();
        EXPECT_EQ(run.rows("curve.csv").back().at(std::string("made_") + to.name),
                  gap < 0.02 ? 1.0 : 0.0);
      }
    const CaseRun none = move(to, 0.0, 0.0, {{"steps", "600"}, {to.name, "0"}});
    ASSERT_TRUE(none.finished()) << none.why();
    EXPECT_EQ(none.rows("curve.csv").back().at(std::string("made_") + to.name), 0.0);
  }
}

// A pair that overlaps when it is joined: its forces then are those without a bridge; afterwards
// Hertz and SJKR go on beside it, from where the surfaces meet, and alone when it has broken.
TEST(VerificationBinderBridges, TheContactGoesOnBesideIt) {
  for (const Joined &to : {kJoined[0], kJoined[1]})
    for (const char *fused : {"on", "off"}) {
      const double inset = to.other == kAm ? kInset : 0.0, overlap = 0.05, ced = 1e4;
      const double l = kCbd + to.other - inset - overlap, k = E * kSection.area / l;
      const double E_eff = effective_modulus(to.other == kAm ? 2e8 : 2e6, 0.3, 2e6, 0.3);
      const auto contact = [&](double d) { // on sphere 1, which leaves along -x
        return sjkr_force(ced, l + inset + d, kCbd, to.other) -
               hertz_force(E_eff, effective_radius(kCbd, to.other), overlap - d);
      };
      const Settings with = {{"ced", number(ced)},
                             {"restitution", "1"},
                             {"friction", "0"},
                             {"inset", number(kInset)},
                             {"fused", fused}};
      Settings without = with;
      without["bridged"] = "0";
      const CaseRun held = move(to, 0.0, 0.0, with, l), plain = move(to, 0.0, 0.0, without, l);
      ASSERT_TRUE(held.finished() && plain.finished()) << held.why() << plain.why();
      for (size_t n = 0; n < held.rows("curve.csv").size(); n += 50)
        for (const char *column : {"fx", "rest"})
          EXPECT_EQ(held.rows("curve.csv")[n].at(column), plain.rows("curve.csv")[n].at(column));
      const double v = to.strength * l / E / (kSteps * dt);
      const CaseRun run = move(to, v, 0.0, with, l);
      ASSERT_TRUE(run.finished()) << run.why();
      double worst = 0.0;
      for (const Row &r : run.rows("curve.csv")) {
        const double d = v * r.at("step") * dt;
        const double expected = contact(d) + (r.at("step") <= 1280 ? k * d : 0.0);
        worst = std::fmax(worst, std::fabs(r.at("fx") - expected));
      }
      std::printf("contact beside: force to %.1e\n", worst / (k * v * kSteps * dt));
      EXPECT_LT(worst, 1e-6 * k * v * kSteps * dt);
      expect_break(run, to, 1280);
    }
}

constexpr double kOfOneBond = kInset / 6.0; // inset of a primary with one bond

// The primary that holds the sphere loses its only bond, and with it the inset when lists are built,
// every 500 steps. The sphere leaves at `speed`, from `gap` above where their surfaces meet.
CaseRun lose_the_inset(double speed, double gap, const char *fused) {
  const double l = kCbd + kAm - kOfOneBond + gap;
  const std::vector<Sphere> spheres = {
      {2, {5, 5, 10}}, {1, {5 + l, 5, 10}, {}, {}, 1}, {1, {5 + l + 1.28, 5, 10}, {}, {}, 1}};
  const std::string leave = number(-speed) + " 0 0 units box\n", tear = "0.1 0 0 units box\n";
  return CaseRun("binder_bridges/in.bridges",
                 {{"ced", "0"},
                  {"dt", number(dt)},
                  {"restitution", "1"},
                  {"friction", "0"},
                  {"inset", number(kInset)},
                  {"fading", "1"},
                  {"fused", fused}},
                 1,
                 files_of(spheres, 10, 10,
                          "group moved id 1\nvelocity moved set " + leave +
                              "fix mv moved move linear " + leave +
                              "group torn id 3\nvelocity torn set " + tear +
                              "fix tear torn move linear " + tear +
                              "neigh_modify delay 0 every 500 check no\n"));
}

void expect_contact_beside(const CaseRun &run, double speed, double l, int broken_at,
                           const std::function<double(long)> &overlap) {
  ASSERT_TRUE(run.finished()) << run.why();
  const double k = E * kSection.area / l, R_eff = effective_radius(kCbd, kAm);
  const double E_eff = effective_modulus(2e8, 0.3, 2e6, 0.3);
  for (const Row &r : run.rows("curve.csv")) {
    const long step = std::lround(r.at("step"));
    const double held = step <= broken_at ? k * speed * r.at("step") * dt : 0.0;
    EXPECT_NEAR(r.at("fx"), held - hertz_force(E_eff, R_eff, std::fmax(0.0, overlap(step))),
                1e-6 * k * std::fabs(speed) * kSteps * dt)
        << step;
  }
  EXPECT_EQ(last_row(run).at("bonds_broken"), 1);
}

// What touches keeps its overlap, also when the bridge has broken; what is open follows, and then
// meets where it was when lists were built.
TEST(VerificationBinderBridges, ASurfaceThatComesOutMovesNoContact) {
  for (const char *fused : {"on", "off"}) {
    const double touching = kCbd + kAm - kOfOneBond, pressed = touching - 0.05, gap = kGap;
    const double v = kJoined[0].strength * pressed / E / (kSteps * dt);
    expect_contact_beside(lose_the_inset(v, -0.05, fused), v, pressed, 1280,
                          [&](long step) { return 0.05 - v * step * dt; });
    const double back = -0.01 / (2000 * dt);
    expect_contact_beside(lose_the_inset(back, gap, fused), back, touching + gap, 2000,
                          [&](long step) { return -back * dt * (step - 500); });
  }
}

// First law: what the bridges hold, what breaks have lost, and the rest of the ledger.
void expect_ledger(const Settings &settings) {
  const std::vector<Row> rows = throw_film(settings).rows("curve.csv");
  ASSERT_GT(rows.size(), 100u);
  const auto total = [](const Row &r) {
    return r.at("kinetic") + r.at("strain") + r.at("lost") + r.at("rest");
  };
  double worst = 0.0, strain = 0.0;
  for (const Row &r : rows) {
    worst = std::fmax(worst, std::fabs(total(r) - total(rows.front())));
    strain = std::fmax(strain, r.at("strain"));
  }
  const Row &end = rows.back();
  std::printf("film: %g to AM, %g to CBD, %g to the collector, %g bonds broken of %g, %g, %g, %g; "
              "ledger to %.1e of %.4g fJ, strain up to %.3g, lost %.3g of it, tolerance %.1e\n",
              end.at("broken_am"), end.at("broken_cbd"), end.at("broken_wall"),
              end.at("bonds_broken"), end.at("made_am"), end.at("made_cbd"), end.at("made_wall"),
              rows.front().at("bonds"), worst / total(rows.front()), total(rows.front()),
              strain / total(rows.front()), end.at("lost") / total(rows.front()), kFilmTolerance);
  EXPECT_EQ(end.at("made_am"), 32);
  EXPECT_EQ(end.at("made_cbd"), 16);
  EXPECT_EQ(end.at("made_wall"), 32);
  const double weak = settings.count("sc") ? 16 : 0;
  EXPECT_EQ(end.at("bonds"), 16);
  EXPECT_EQ(end.at("bonds_broken"), weak);
  for (const Joined &any : kJoined)
    EXPECT_GT(end.at(std::string("broken_") + any.name), 2.0) << any.name;
  EXPECT_GT(end.at("lost"), 100 * kFilmTolerance * total(rows.front()));
  EXPECT_LT(worst, kFilmTolerance * total(rows.front()));
}

TEST(VerificationBinderBridges, LedgerThroughBreaks) {
  for (const Settings &settings : {kAtTips, kInside, kComingOut})
    expect_ledger(settings);
}

TEST(VerificationBinderBridges, SameBitsOnRanksAndAfterARestart) {
  for (Settings settings : {kAtTips, kComingOut}) {
    const CaseRun one = throw_film(settings);
    const auto on_ranks = [&settings](int px, int py, const Files &files = {}) {
      Settings more = settings;
      more.insert({{"px", number(px)}, {"py", number(py)}});
      return throw_film(more, px * py, files);
    };
    for (const auto &[px, py] : {std::pair(2, 1), {1, 2}, {2, 2}})
      EXPECT_EQ(on_ranks(px, py).text("final.txt"), one.text("final.txt")) << px << " x " << py;
    settings["restart"] = "1";
    const Files half = half_way(one);
    const CaseRun on = on_ranks(1, 1, half), two = on_ranks(2, 1, half);
    EXPECT_EQ(on.text("final.txt"), one.text("final.txt"));
    EXPECT_EQ(two.text("final.txt"), one.text("final.txt"));
    const Row end = last_row(one), end_on = last_row(on);
    for (const auto &[column, value] : end)
      EXPECT_EQ(end_on.at(column), value) << column;
  }
}

TEST(VerificationBinderBridges, OnePassGivesTheHostsForces) {
  for (Settings settings : {kAtTips, kInside, kComingOut}) {
    const CaseRun one = throw_film(settings);
    settings["fused"] = "off";
    const CaseRun host = throw_film(settings);
    const std::vector<double> a = numbers(one.text("final.txt")),
                              b = numbers(host.text("final.txt"));
    ASSERT_EQ(a.size(), b.size());
    double apart = 0.0;
    for (size_t n = 0; n < a.size(); n += 10)
      for (int k = 1; k < 4; ++k)
        apart = std::fmax(apart, std::fabs(a[n + k] - b[n + k]));
    std::printf("host's loop: places differ by %.1e um\n", apart);
    EXPECT_LT(apart, 1e-9);
    const std::vector<Row> p = one.rows("curve.csv"), q = host.rows("curve.csv");
    for (const char *column : {"broken_am", "broken_cbd", "broken_wall"})
      EXPECT_EQ(p.back().at(column), q.back().at(column));
    for (const auto &[column, value] : q.front())
      EXPECT_NEAR(p.front().at(column), value, 1e-12 * std::fabs(value)) << column;
  }
}

TEST(VerificationBinderBridges, ValuesOutOfRangeStop) {
  const std::pair<Settings, const char *> cases[] = {
      {{{"cbd", "2e4"}}, "stretch too far before they break"},
      {{{"gap", "0.06"}}, "'bridges: gap' is '0.06'; it must be a number between 0 and 0.05"},
      {{{"gap", "-0.01"}}, "'bridges: gap' is '-0.01'; it must be a number between 0 and 0.05"},
      {{{"ratio", "inf"}}, "'inf'; it must be a finite number > 0"},
      {{{"ratio", "1x"}}, "'1x'; it must be a finite number > 0"},
      {{{"ratio", "0"}}, "must be a finite number > 0"}};
  for (const auto &[settings, words] : cases) {
    const CaseRun run = move(kJoined[1], 0.0, 0.0, settings);
    EXPECT_FALSE(run.finished());
    EXPECT_NE(run.why().find(words), std::string::npos) << run.why();
  }
}
