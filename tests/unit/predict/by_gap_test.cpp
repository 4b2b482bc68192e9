// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "predict/by_gap.h"
#include "predict/own_runs.h"
#include "support/made_coatings.h"
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;

const std::vector<double> kMaterial = {190.0, 2.4, 480.0};

Calibration exact_calibration() {
  Calibration c;
  c.error = {0.0, 0.001, 0.002};
  c.draws = {{{{kMaterial, {}}}, {0.001, 0.5}}};
  return c;
}

// 6 mg/cm2 of 96 % NMC (4.65 g/cm3) and 4 % carbon and binder (1.83): 12.39 + 1.31 um.
TEST(ByGap, TheFilmsSolidIsThatOfItsComposition) {
  EXPECT_NEAR(made_film_bank().solid_column(made_film("x", 46.0, 2.0)),
              60.0 * (0.96 / 4.65 + 0.04 / 1.83), 1e-9);
  EXPECT_NEAR(made_film_bank().solid_column(made_film("x", 46.0, 3.0)),
              60.0 * (0.94 / 4.65 + 0.06 / 1.83), 1e-9);
}

// The gap of a film under 80 MPa takes 80 MPa, and leaves what these leave.
TEST(ByGap, AGapTakesThePressureThatLeadsToIt) {
  const Film film = made_film("x", 46.0, 2.0);
  const std::vector<double> all = {190.0, 2.4, 480.0, 46.0, 2.0};
  const double after = made_porosity(all, 0.0, 80.0), springback = made_springback(all, 80.0),
               solid = made_film_bank().solid_column(film);
  const double gap = solid / ((1.0 - after) * (1.0 + springback));
  const AtGap at = at_gaps(under_gaps(made_film_bank(), exact_calibration(), film, {gap}))[0];
  EXPECT_NEAR(std::log(at.pressure.median / 80.0), 0.0, 0.1);
  EXPECT_NEAR(at.after.median, after, 0.003);
  EXPECT_NEAR(at.thickness_after.median, gap * (1.0 + springback), 0.05);
  EXPECT_NEAR(at.cracked.median, made_cracked(all, 80.0), 0.03);
  EXPECT_LT(at.pressure.low90, at.pressure.median);
  EXPECT_GT(at.pressure.high90, at.pressure.median);
  EXPECT_EQ(at.below + at.above, 0.0);
}

// Two materials that need 60 and 120 MPa for a gap: the pressure is either, the porosity after release nearly the same.
TEST(ByGap, MaterialsDifferInPressureNotInPorosity) {
  const Film film = made_film("x", 46.0, 2.0);
  Calibration c = exact_calibration();
  Draw stiff = c.draws[0];
  stiff.materials[0].parameters = {190.0, 2.4 * 1.5, 480.0}; // the scale of pressure by half more
  c.draws.push_back(stiff);
  const double gap = made_film_bank().solid_column(film) / (1.0 - 0.30);
  const AtGap at = at_gaps(under_gaps(made_film_bank(), c, film, {gap}))[0];
  EXPECT_NEAR(at.pressure.high90 / at.pressure.low90, 1.5, 0.35);
  EXPECT_LT(at.after.high90 - at.after.low90, 0.02);
}

// Where an emulated curve is flat, the pressure is as uncertain as the slope about the flat piece says; a curve that does not
// fall at all leaves any pressure of the curve: a uniform's variance.
TEST(ByGap, AFlatPieceOfACurveLeavesThePressureUncertainNotUnknown) {
  FilmCurves curves;
  curves.pressures = {10.0, 20.0, 40.0, 80.0, 160.0, 320.0};
  const double octave = std::log(2.0), sd = 0.01;
  Predictions load(2);
  for (const double mean : {0.50, 0.45, 0.40, 0.40, 0.30, 0.25})
    load[0].push_back({mean, sd * sd});
  load[1].assign(6, {0.40, sd * sd});
  curves.load = curves.springback = curves.cracked = load;
  GapDraws draws;
  draws.gaps = {10.0};
  add_met(curves, {{0.40}, {0.40}}, draws);
  EXPECT_NEAR(std::sqrt(draws.log_pressure[0][0].variance), sd / (0.25 / (5.0 * octave)), 1e-9);
  EXPECT_NEAR(draws.log_pressure[1][0].variance, std::pow(5.0 * octave, 2) / 12.0, 1e-9);
}

// A share of 0.3 of pores left, with the springback's error: its interval holds a target as often as its band says.
TEST(ByGap, ATargetIsMetAsOftenAsTheBandSays) {
  const Film film = made_film("x", 46.0, 2.0);
  const double solid = made_film_bank().solid_column(film), gap = solid / (1.0 - 0.28);
  const GapDraws draws = under_gaps(made_film_bank(), exact_calibration(), film, {gap, 1.2 * gap});
  const AtGap at = at_gaps(draws)[0];
  const Target target = {0.5 * (at.after.low90 + at.after.high90),
                         0.5 * (at.after.high90 - at.after.low90)};
  const auto c = chances_from(draws.gaps, numbers_at_gaps(draws), target);
  EXPECT_EQ(c[0].at, gap);
  EXPECT_NEAR(c[0].porosity, 0.9, 0.005);
  EXPECT_LT(c[1].porosity, 1e-3);
  Target whole = target;
  whole.cracked_below = at.cracked.median;
  EXPECT_NEAR(chances_from(draws.gaps, numbers_at_gaps(draws), whole)[0].all, 0.45, 0.01);
  const PredictedFilm as_film = film_at_gaps(made_film_bank(), draws);
  EXPECT_EQ(as_film.after[0].median, at.after.median);
  EXPECT_NEAR(as_film.under_load[0].median, 0.28, 1e-12);
  EXPECT_EQ(as_film.pressures[0], at.pressure.median);
}

// Runs that give what the emulators say change nothing; a run that springs back by 0.01 more,
// with 0.1 more of its particles cracked, adds that.
TEST(ByGap, RunsToAGapAddWhatTheyDifferBy) {
  const FilmBank &bank = made_film_bank();
  const Film film = made_film("x", 46.0, 2.0);
  const Calibration c = exact_calibration();
  const double gap = bank.solid_column(film) / (1.0 - 0.28);
  const auto at = [&](FilmNumber number, double pressure) {
    return bank.at(bank.at_pressures(number, film, c.draws[0].materials[0]), pressure).mean;
  };
  const auto load = [&](double p) {
    return 1.0 - (1.0 - at(FilmNumber::PorosityAfter, p)) * (1.0 + at(FilmNumber::Springback, p));
  };
  bank::PressedFilm run; // where the emulated film reaches the gap
  double low = 20.0, high = 300.0;
  while (high - low > 1e-9)
    (load(0.5 * (low + high)) > 0.28 ? low : high) = 0.5 * (low + high);
  run.pressure = low;
  run.porosity_after = at(FilmNumber::PorosityAfter, low);
  run.porosity_at_max = 0.28;
  run.cracked = at(FilmNumber::Cracked, low);
  const GapDraws same = from_runs_at_gaps(bank, c, gaps_of(bank, film, {gap}), c.draws, {{run}}),
                 emulated = under_gaps(bank, c, film, {gap});
  EXPECT_NEAR(same.log_pressure[0][0].mean, emulated.log_pressure[0][0].mean, 1e-3);
  EXPECT_NEAR(same.springback[0][0].mean, emulated.springback[0][0].mean, 1e-4);
  EXPECT_NEAR(same.cracked[0][0].mean, emulated.cracked[0][0].mean, 1e-3);
  EXPECT_LT(same.springback[0][0].variance, emulated.springback[0][0].variance); // no emulator's
  run.porosity_after = 1.0 - 0.72 / (1.01 + at(FilmNumber::Springback, low));
  run.cracked += 0.1;
  const GapDraws more = from_runs_at_gaps(bank, c, gaps_of(bank, film, {gap}), c.draws, {{run}});
  EXPECT_NEAR(more.springback[0][0].mean, same.springback[0][0].mean + 0.01, 1e-6);
  EXPECT_NEAR(more.cracked[0][0].mean, same.cracked[0][0].mean + 0.1, 1e-9);
  EXPECT_EQ(more.log_pressure[0][0].mean, same.log_pressure[0][0].mean);
}

TEST(ByGap, PressuresBeyondTheBanksAreReported) {
  const Film film = made_film("x", 46.0, 2.0);
  const double solid = made_film_bank().solid_column(film);
  const auto at = at_gaps(
      under_gaps(made_film_bank(), exact_calibration(), film, {solid / 0.92, solid / 0.56}));
  EXPECT_EQ(at[0].above, 1.0);
  EXPECT_NEAR(at[0].pressure.median, 300.0, 1e-6);
  EXPECT_EQ(at[1].below, 1.0);
  EXPECT_NEAR(at[1].pressure.median, 10.0, 1e-6);
}

TEST(ByGap, WhereNoDrawIsWithinTheBanksPressuresNothingIsSaid) {
  const Film film = made_film("x", 46.0, 2.0);
  const double solid = made_film_bank().solid_column(film);
  const auto refused = [&](double gap) {
    try {
      check_reached(under_gaps(made_film_bank(), exact_calibration(), film, {gap}));
    } catch (const Failure &e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(refused(solid / 0.92).find("more than 300 MPa"), std::string::npos);
  EXPECT_NE(refused(solid / 0.56).find("less than 10 MPa"), std::string::npos);
  EXPECT_EQ(refused(solid / 0.7), "");
}

TEST(ByGap, AGapWithoutPoresOrWithoutTouchIsRefused) {
  const Film film = made_film("x", 46.0, 2.0);
  const double solid = made_film_bank().solid_column(film);
  EXPECT_THROW(under_gaps(made_film_bank(), exact_calibration(), film, {0.99 * solid}), Failure);
  EXPECT_THROW(under_gaps(made_film_bank(), exact_calibration(), film, {1.01 * solid / 0.54}),
               Failure);
  EXPECT_THROW(under_gaps(made_film_bank(), exact_calibration(), film, {std::nan("")}), Failure);
}

} // namespace
