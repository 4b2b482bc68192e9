// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/sample_film.h"
#include "support/test_folder.h"
#include <cmath>
#include <fstream>

namespace {

using namespace calendem;

/// A bank of 6 mg/cm2 and two points on a cell of 18 mg/cm2, whose porosities are 0.04 and 0.06
/// lower.
struct Films {
  BankTable bank;
  Experiment experiment;
  std::vector<CoveredCondition> covered;

  explicit Films(double loading) {
    const auto folder = calendem_test::test_folder();
    const auto recipe = [&](const char *name, double mg_cm2) {
      std::ofstream(folder / name)
          << "[coating]\nloading_mg_cm2 = " << mg_cm2 << "\n[cell]\nx_um = 12\ny_um = 12\n";
      return (folder / name).string();
    };
    bank.spec.recipe_file = recipe("thin.toml", 6.0);
    bank.spec.full_cell = {recipe("full.toml", 18.0), "", 2, false};
    bank.spec.pressures = {150.0};
    experiment.recipe = read_recipe(recipe("sample.toml", loading));
    for (const auto &[point, effect, porosity] :
         {std::tuple(0, "", 0.36), std::tuple(1, "", 0.38), std::tuple(0, kFullCell, 0.32),
          std::tuple(1, kFullCell, 0.32)}) {
      BankRow row;
      row.point.base_point = point;
      row.point.effect = effect;
      row.run.target = 150.0;
      row.run.porosity_after = porosity;
      bank.rows.push_back(row);
    }
    Observable o;
    o.simulated = [](const SimulatedRun &r) { return r.porosity_after; };
    covered = {{Condition{}, 150.0, {o}, 1, {150.0}}};
  }
};

TEST(FullCell, AFilmOfItsLoadingIsShiftedByTheMeanDifference) {
  std::vector<std::string> reported;
  const Films f(18.0);
  const FullCellChange t = full_cell_change(f.experiment, f.bank, f.covered, reported);
  ASSERT_EQ(t.change.size(), 1);
  EXPECT_NEAR(t.change[0], -0.05, 1e-15);
  // variance of -0.04 and -0.06 is 2e-4; that of a third about their mean 1.5 times as large
  EXPECT_NEAR(t.covariance(0, 0), 3e-4, 1e-15);
  EXPECT_EQ(reported.size(), 1u);
}

TEST(FullCell, TheShiftGoesWithOneOverLoading) {
  std::vector<std::string> reported;
  const Films own(6.0), between(9.0); // 1/6, 1/9 and 1/18: half way
  EXPECT_EQ(full_cell_change(own.experiment, own.bank, own.covered, reported).change[0], 0.0);
  const FullCellChange t =
      full_cell_change(between.experiment, between.bank, between.covered, reported);
  EXPECT_NEAR(t.change[0], -0.025, 1e-15);
  EXPECT_NEAR(t.covariance(0, 0), 0.25 * 3e-4, 1e-15);
}

// Whatever its loading: it is not the film's faces that differ.
TEST(FullCell, AnotherElectrodeIsShiftedByAllOfTheDifference) {
  std::vector<std::string> reported;
  Films f(9.0);
  f.bank.spec.full_cell.other_electrode = true;
  EXPECT_NEAR(full_cell_change(f.experiment, f.bank, f.covered, reported).change[0], -0.05, 1e-15);
  f.bank.spec.full_cell.recipe_file = f.bank.spec.recipe_file; // as thick as the bank's
  const FullCellChange t = full_cell_change(f.experiment, f.bank, f.covered, reported);
  EXPECT_NEAR(t.change[0], -0.05, 1e-15);
  EXPECT_NEAR(t.covariance(0, 0), 3e-4, 1e-15);
  EXPECT_NE(reported.at(0).find("of another electrode"), std::string::npos);
}

// A film of 25 um and 44 % pores, for which the bank's of 27 um and 48 % stand: a dial that shows 5 um less shows 30 %
// there and 36.8 % on the bank's.
TEST(FullCell, AnotherElectrodesDialIsReadOnItsOwnFilm) {
  Films f(6.0);
  f.bank.spec.full_cell.other_electrode = true;
  for (BankRow &row : f.bank.rows) {
    const bool other = row.point.effect == kFullCell;
    row.run.thickness_after = other ? 25.0 : 27.0;
    row.run.porosity_after = other ? 0.44 : 0.48;
    row.run.solid_column = other ? 14.0 : 14.04;
    row.run.pressure = {10.0, 20.0};
    row.run.displacement = other ? std::vector<double>{1.0, 2.0} : std::vector<double>{1.5, 2.75};
  }
  const OtherFilm other(f.bank);
  const SimulatedRun shown =
      shown_with(find_effect("thickness_zero"), -5.0, other(f.bank.rows[0].run));
  EXPECT_NEAR(shown.porosity_after, 1.0 - 14.0 / 20.0, 1e-12);
  EXPECT_NEAR(shown.thickness_after, 20.0, 1e-12);
  EXPECT_NEAR(other(f.bank.rows[0].run).displacement[1], 2.0, 1e-12);
  EXPECT_NEAR(film_ratio(f.experiment, f.bank) * solid_thickness_um(f.experiment, 6.0), 14.0, 1e-9);
  f.bank.spec.full_cell.other_electrode = false;
  EXPECT_EQ(OtherFilm(f.bank)(f.bank.rows[0].run).porosity_after, 0.48);
}

// A condition that the full cell was not run for has no value: as it is, it would be another film's.
TEST(FullCell, WhatTheFullCellWasNotRunForIsNotKnown) {
  std::vector<std::string> reported;
  Films f(18.0);
  f.covered.push_back(f.covered[0]);
  f.covered[1].pressure = 300.0;
  f.covered[1].runs = {300.0};
  for (const int point : {0, 1}) {
    BankRow row = f.bank.rows[std::size_t(point)];
    row.run.target = 300.0;
    f.bank.rows.push_back(row);
  }
  const FullCellChange t = full_cell_change(f.experiment, f.bank, f.covered, reported);
  EXPECT_NEAR(t.change[0], -0.05, 1e-15);
  EXPECT_NEAR(t.covariance(0, 0), 3e-4, 1e-15);
  EXPECT_TRUE(std::isnan(t.change[1]));
  const Films own(6.0);
  EXPECT_EQ(full_cell_change(own.experiment, f.bank, f.covered, reported).change[1], 0.0);
}

// Wherever the condition's own runs went: between those of the full cell.
TEST(FullCell, BetweenItsPressuresTheShiftIsInterpolated) {
  std::vector<std::string> reported;
  Films f(18.0);
  for (const BankRow &at_150 : std::vector<BankRow>(f.bank.rows)) {
    BankRow row = at_150;
    row.run.target = 300.0;
    row.run.porosity_after -= row.point.effect == kFullCell ? 0.02 : 0.0;
    f.bank.rows.push_back(row);
  }
  f.covered[0].pressure = std::sqrt(150.0 * 300.0); // half-way in ln p
  f.covered[0].runs = {f.covered[0].pressure};
  const FullCellChange t = full_cell_change(f.experiment, f.bank, f.covered, reported);
  EXPECT_NEAR(t.change[0], -0.06, 1e-12);
}

TEST(FullCell, OnePointIsTooFew) {
  std::vector<std::string> reported;
  Films f(18.0);
  f.bank.rows.pop_back();
  EXPECT_EQ(full_cell_change(f.experiment, f.bank, f.covered, reported).change.size(), 0);
}

} // namespace
