// SPDX-License-Identifier: GPL-2.0-or-later
// Where the platen's work goes. Requirement, formulas and tolerances: README.md of this folder.
#include "column.h"
#include <cstdio>
#include <gtest/gtest.h>

using namespace calendem;
using namespace calendem::platen_column;

namespace {

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

// Largest difference of the platen's work from energies, motion and what damping took, in parts of
// the most work.
double first_law(bool bonded, const std::string &restitution, double &damped) {
  const std::vector<BodySphere> spheres = column(spacing(bonded), bonded);
  const double top = top_of(spheres) + kGap;
  const CaseRun run = press(spheres, motion("position", top - 0.03, top, 0.5),
                            {{"bonded", bonded ? "1" : "0"},
                             {"restitution", restitution},
                             {"dt", "2e-5"},
                             {"steps", "50000"},
                             {"every", "50"}},
                            "include ${cases}/platen/in.ledger\n");
  EXPECT_TRUE(run.finished()) << run.why();
  const std::vector<Row> platen = run.rows("platen.csv"), curve = run.rows("curve.csv"),
                         ledger = run.rows("ledger.csv");
  const auto frames = run.frames();
  EXPECT_EQ(frames.size(), platen.size() + 1);
  EXPECT_EQ(ledger.size(), platen.size());
  double worst = 0.0, most = 0.0;
  for (size_t n = 0; n < ledger.size() && n + 1 < frames.size(); ++n) {
    const double held = curve[n].at("kinetic") + curve[n].at("strain") + ledger[n].at("damped") +
                        contact_energy(frames[n + 1], top - platen[n].at("moved"), spacing(bonded));
    worst = std::fmax(worst, std::fabs(platen[n].at("work") - held));
    most = std::fmax(most, platen[n].at("work"));
    damped = ledger[n].at("damped") / most;
  }
  std::printf("%s column, restitution %s: work and energy differ by %.1e of %.4g fJ, damped %.1e\n",
              bonded ? "bonded" : "loose", restitution.c_str(), worst / most, most, damped);
  EXPECT_GT(most, 100.0);
  return worst / most;
}

} // namespace

// First law: the platen's work is in the contacts, the bonds and the motion, all along; with
// damping the rest of it is what damping took, at the walls too.
TEST(VerificationPlaten, WorkIsStoredEnergy) {
  for (const bool bonded : {false, true}) {
    double none = 0.0, damped = 0.0;
    const double tolerance = bonded ? 3e-3 : 1.4e-4; // (omega dt)^2 / 16
    EXPECT_LT(first_law(bonded, "1", none), tolerance);
    EXPECT_NEAR(none, 0.0, 1e-12);
    EXPECT_LT(first_law(bonded, "0.3", damped), tolerance);
    if (!bonded) { // else the bonds' energy hides it
      EXPECT_GT(damped, 30.0 * tolerance);
    }
  }
}

// Sticky walls: their cohesion is stored and given back. A sphere snaps to either wall and is
// pressed; without damping none is booked.
TEST(VerificationPlaten, CohesionOfStickyWallsIsStored) {
  const std::vector<BodySphere> sphere = {{{2.5, 2.5, R + kGap}, R, 1}};
  const double top = 2 * R + 2 * kGap;
  Settings of_motion = motion("position", top - 0.03, top, 0.5);
  of_motion["wall"] = "\"model hertz tangential history cohesion sjkr\"";
  const CaseRun run = press(sphere, of_motion,
                            {{"bonded", "0"},
                             {"ced", "3e6"},
                             {"restitution", "1"},
                             {"dt", "2e-5"},
                             {"steps", "50000"},
                             {"every", "50"}},
                            "include ${cases}/platen/in.ledger\n");
  ASSERT_TRUE(run.finished()) << run.why();
  const std::vector<Row> platen = run.rows("platen.csv"), curve = run.rows("curve.csv"),
                         ledger = run.rows("ledger.csv");
  ASSERT_EQ(ledger.size(), platen.size());
  double worst = 0.0, most = 0.0, cohesive = 0.0, damped = 0.0;
  for (size_t n = 0; n < ledger.size(); ++n) {
    const double held = curve[n].at("kinetic") + ledger[n].at("elastic") + ledger[n].at("cohesive");
    worst = std::fmax(worst, std::fabs(platen[n].at("work") - held));
    most = std::fmax(most, ledger[n].at("elastic"));
    cohesive = std::fmin(cohesive, ledger[n].at("cohesive"));
    damped = std::fmax(damped, std::fabs(ledger[n].at("damped")));
  }
  std::printf("sticky walls: work and energy differ by %.1e of %.4g fJ, cohesion to %.3g, damped "
              "%.1e\n",
              worst / most, most, cohesive / most, damped / most);
  EXPECT_LT(cohesive, -0.1 * most);
  EXPECT_LT(worst / most, 1.4e-4); // (omega dt)^2 / 16
  EXPECT_LT(damped / most, 1e-12);
}
