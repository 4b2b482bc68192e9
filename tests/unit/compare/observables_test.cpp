// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/observables.h"
#include "pressed.h"
#include "support/test_folder.h"
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace calendem {
namespace {

// Table 1 of the paper: h/h_solid = 1.385 and 1.336, from mass and thickness with foil.
TEST(Observables, ThicknessOverSolidThicknessOfTable1) {
  Experiment e = paper();
  std::vector<std::string> not_said;
  const double expected[] = {1.385, 1.336};
  for (int k = 0; k < 2; ++k) {
    e.conditions[k].porosity_after_percent.reset();
    const auto all = observables_of(e, e.conditions[k], not_said);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].name, "thickness over solid thickness");
    EXPECT_NEAR(all[0].measured, expected[k], 0.005);
    EXPECT_NEAR(all[0].simulated(pressed_to(80, 0.30, "a")), 1.0 / 0.7, 1e-12);
  }
}

// What the recipe says, against the sample: of another stage than the porosity that comes out.
TEST(Observables, PorosityBeforeIsThatOfThePacking) {
  Experiment e = paper();
  e.conditions[1].porosity_before_percent = Measured{45.0, 0.5};
  SimulatedRun run = pressed_to(150, 0.2997, "a");
  run.porosity_initial = 0.48;
  const Gap gap = find_gap(e, {run});
  ASSERT_EQ(gap.rows.size(), 2u);
  const Residual &before = gap.rows[0];
  EXPECT_EQ(before.observable, "total porosity before");
  EXPECT_EQ(before.stage, "before");
  EXPECT_NEAR(before.z, 3.0 / 0.5, 1e-9);
  EXPECT_EQ(before.sd_pressure, 0.0);
}

/// The observables of a condition to 150 MPa that has nothing but this curve.
std::vector<Observable> of_curve(const std::string &rows) {
  const auto file = calendem_test::test_folder() / "curve.csv";
  std::ofstream(file) << rows;
  Experiment e = paper();
  Condition &c = e.conditions[1];
  c.porosity_after_percent.reset();
  c.mass_mg.reset();
  c.thickness_after_um.reset();
  c.curve = file.string();
  c.curve_sd_um = 0.02;
  std::vector<std::string> not_said;
  return observables_of(e, c, not_said);
}

TEST(Observables, CurveIsComparedAtSharesOfItsLargestPressure) {
  const auto all = of_curve("displacement_um,pressure_MPa\n0,0\n10,50\n15,40\n20,100\n");
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[3].name, "displacement at 75 MPa");
  EXPECT_NEAR(all[3].measured, 15.0,
              1e-9); // between 50 MPa at 10 and 100 at 20; the dip is skipped
  EXPECT_NEAR(all[3].simulated(pressed_to(150, 0.3, "a")), 20.0, 1e-9);
  EXPECT_EQ(all[3].sd, 0.02);
}

TEST(Observables, ThicknessAfterCountsInMicrometresWhereTheLoadingIsNotKnown) {
  Experiment e = paper();
  Condition &c = e.conditions[1];
  c.porosity_after_percent.reset();
  c.mass_mg.reset();
  std::vector<std::string> not_said;
  const auto all = observables_of(e, c, not_said);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].unit, "um");
  EXPECT_NEAR(all[0].measured, 75.4 - 22.5, 1e-9);
  EXPECT_NEAR(all[0].simulated(pressed_to(150, 0.2, "a")), 40.0 / 0.8, 1e-9);
  ASSERT_EQ(not_said.size(), 1u);
}

// Loading to 100 MPa; the release dips at 70 MPa, which is skipped, and ends above the lowest
// share.
TEST(Observables, ReleaseIsComparedAtSharesOfTheLargestPressure) {
  const auto all =
      of_curve("displacement_um,pressure_MPa,stage\n0,0,compression\n20,100,compression\n"
               "20,100,relaxation\n18,60,relaxation\n17.9,70,relaxation\n16,40,relaxation\n");
  ASSERT_EQ(all.size(), 6u); // four of loading
  const Observable &half = all[4], &upper = all[5];
  EXPECT_EQ(half.name, "displacement at 50 MPa on release");
  EXPECT_EQ(half.stage, "relaxation");
  EXPECT_EQ(half.coordinate, 0.5);
  EXPECT_NEAR(half.measured, 16.0 + 1.9 / 3.0, 1e-9);  // from 40 MPa at 16 to 70 at 17.9
  EXPECT_NEAR(upper.measured, 17.9 + 2.1 / 6.0, 1e-9); // to 100 at 20
  SimulatedRun r = pressed_to(150, 0.3, "a");          // 25 % porous at the maximum
  r.release_pressure = {0.0, 150.0};
  r.release_displacement = {12.0, 24.0};
  EXPECT_NEAR(half.simulated(r), 16.0, 1e-9);
  r.porosity_slope = -2e-4; // h = solid / (1 - porosity): dh = h / (1 - porosity) d(porosity)
  EXPECT_NEAR(half.slope(r), 2e-4 * r.thickness_at_max / 0.75, 1e-12);
  EXPECT_TRUE(std::isnan(half.simulated(pressed_to(150, 0.3, "a")))); // it has none
}

TEST(Observables, UnloadingIsNoPartOfLoading) {
  const auto all = of_curve("displacement_um,pressure_MPa,stage\n0,0,loading\n20,100,loading\n"
                            "19,101,unloading\n");
  ASSERT_EQ(all.size(), 4u); // the release has no value below 101 MPa
  EXPECT_EQ(all[3].name, "displacement at 75 MPa");
}

// Shares are 10 to 75 % of the largest pressure; a curve from 30 % on says nothing of the lower ones.
TEST(Observables, ACurveThatBeginsLateHasTheRest) {
  const auto all = of_curve("displacement_um,pressure_MPa\n5,30\n10,50\n20,100\n");
  EXPECT_LT(all.size(), 4u);
  EXPECT_GT(all.size(), 0u);
  for (const Observable &o : all)
    EXPECT_TRUE(std::isfinite(o.measured)) << o.name;
}

// The peak of a coarse curve stands out of its neighbours, and is no outlier.
TEST(Observables, ThePeakOfACoarseCurveCounts) {
  std::string rows = "displacement_um,pressure_MPa,stage\n";
  for (int p = 0; p <= 150; p += 15)
    rows += std::to_string(0.1 * p) + "," + std::to_string(p) + ",loading\n";
  for (int p = 135; p >= 0; p -= 15)
    rows += std::to_string(12.0 + 0.02 * p) + "," + std::to_string(p) + ",unloading\n";
  EXPECT_EQ(of_curve(rows)[3].name, "displacement at 112 MPa"); // 75 % of 150
}

// A film that was pressed twice is read in its first loading and its last release; the turns
// between are no outliers, and nothing jumps.
TEST(Observables, OfTwoPressesTheFirstLoadingAndTheLastRelease) {
  std::string rows = "displacement_um,pressure_MPa,stage\n";
  const auto add = [&](double from, double to, int pressure, const std::string &stage) {
    rows += std::to_string(from + (to - from) * 0.01 * pressure) + "," + std::to_string(pressure) +
            "," + stage + "\n";
  };
  for (int p = 0; p <= 100; p += 10)
    add(0.0, 20.0, p, "loading");
  for (int p = 90; p >= 0; p -= 10)
    add(16.0, 20.0, p, "unloading");
  for (int p = 10; p <= 100; p += 10)
    add(17.0, 22.0, p, "loading");
  for (int p = 90; p >= 0; p -= 10)
    add(18.0, 22.0, p, "unloading");
  const auto all = of_curve(rows);
  ASSERT_EQ(all.size(), 7u);
  EXPECT_NEAR(all[2].measured, 10.0, 1e-9); // half of the pressure
  EXPECT_NEAR(all[5].measured, 20.0, 1e-9);
}

// A roll gap counts by its pressure, a curve by its largest displacement.
TEST(Belongs, ControlsThatARunCanHave) {
  SimulatedRun r = pressed_to(150, 0.3, "a");
  Condition c = paper().conditions[1];
  EXPECT_TRUE(belongs(r, c));
  c.control = "roll_gap";
  EXPECT_TRUE(belongs(r, c));
  c.max_pressure_MPa.reset();
  EXPECT_FALSE(belongs(r, c));
  const std::string file = testing::TempDir() + "calendem_compare_control.csv";
  std::ofstream(file) << "displacement_um,pressure_MPa\n0,0\n20,100\n";
  c.control = r.control = "displacement";
  c.curve = file;
  r.target = 20.2;
  EXPECT_TRUE(belongs(r, c));
  r.target = 24.0;
  EXPECT_FALSE(belongs(r, c));
  std::filesystem::remove(file);
}

TEST(DisplacementAt, IsLinearBetweenPointsAndNothingBeyond) {
  EXPECT_NEAR(displacement_at({0, 10, 20}, {0, 4, 6}, 15), 5.0, 1e-12);
  EXPECT_TRUE(std::isnan(displacement_at({0, 10, 20}, {0, 4, 6}, 21)));
}

} // namespace
} // namespace calendem
