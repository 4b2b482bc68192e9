// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "run_case.h"

using namespace calendem;

namespace {

constexpr double E = 2e8, G = E / 2.6, R = 0.795, l = 1.28, dt = 1e-4, sc = 2e5, tc = 2e4;

/// Rates of stress [kPa/us] that the motion of the spheres makes; tension > 0.
struct Rates {
  double axial, bending, shear, torsion;
};

Settings motion_of(const Rates &r) {
  return {{"vx", number(r.axial * l / E)},
          {"wz", number(0.5 * r.bending * l / (E * R))},
          {"vy", number(r.shear * l / G)},
          {"wx", number(0.5 * r.torsion * l / (G * R))}};
}

struct Outcome {
  int step = 0; // 0: no break
  std::string mode;
};

Outcome broken(const Rates &rates, const std::string &criterion) {
  Settings settings = motion_of(rates);
  settings.insert({{"criterion", criterion},
                   {"sc", number(sc)},
                   {"tc", number(tc)},
                   {"restitution", "1"},
                   {"steps", "1500"}});
  const CaseRun run("pair/in.pair", settings);
  EXPECT_TRUE(run.finished()) << run.why();
  Outcome o;
  const std::vector<Row> breaks = run.rows("breaks.csv");
  if (breaks.empty())
    return o;
  o.step = static_cast<int>(std::lround(breaks[0].at("time_us") / dt));
  for (const std::string m : {"tension", "bending", "shear", "torsion"})
    if (run.text("breaks.csv").find("," + m + ",") != std::string::npos)
      o.mode = m;
  return o;
}

// Rate at which the larger of sigma/sigma_c and tau/tau_c grows.
double rate_of(const Rates &r, const std::string &criterion) {
  const double axial = criterion == "signed"     ? r.axial
                       : criterion == "unsigned" ? std::fabs(r.axial)
                                                 : -std::fabs(r.axial);
  return std::fmax((axial + std::fabs(r.bending)) / sc,
                   (std::fabs(r.shear) + std::fabs(r.torsion)) / tc);
}

// The bond must break in step 1280 (the load meets the limit at 1279.53) and in `mode`.
void expect_break(Rates r, const std::string &criterion, const std::string &mode) {
  const double scale = 1.0 / (rate_of(r, criterion) * 1279.53 * dt);
  r = {r.axial * scale, r.bending * scale, r.shear * scale, r.torsion * scale};
  const Outcome o = broken(r, criterion);
  std::printf("%s: step %d, %s\n", criterion.c_str(), o.step, o.mode.c_str());
  EXPECT_EQ(o.step, 1280);
  EXPECT_EQ(o.mode, mode);
}

} // namespace

TEST(VerificationMixedLoad, TensionAndBending) {
  for (const std::string c : {"signed", "unsigned"}) {
    expect_break({0.6 * sc, 0.4 * sc, 0, 0}, c, "tension");
    expect_break({0.4 * sc, 0.6 * sc, 0, 0}, c, "bending");
  }
  expect_break({0.4 * sc, 0.6 * sc, 0, 0}, "as_printed", "bending"); // tension counts against
}

TEST(VerificationMixedLoad, CompressionAndBending) {
  expect_break({-0.4 * sc, 0.6 * sc, 0, 0}, "signed", "bending"); // compression protects
  expect_break({-0.6 * sc, 0.4 * sc, 0, 0}, "unsigned", "tension");
  expect_break({-0.4 * sc, 0.6 * sc, 0, 0}, "as_printed", "bending");
}

TEST(VerificationMixedLoad, ShearAndTorsion) {
  for (const std::string c : {"signed", "unsigned", "as_printed"}) {
    expect_break({0, 0, 0.6 * tc, 0.4 * tc}, c, "shear");
    expect_break({0, 0, 0.4 * tc, 0.6 * tc}, c, "torsion");
  }
}

TEST(VerificationMixedLoad, TheTwoLimitsDoNotAdd) {
  expect_break({0.99 * sc, 0, 0, 0.5 * tc}, "signed", "tension");
  expect_break({0.5 * sc, 0, 0, 0.99 * tc}, "signed", "torsion");
}
