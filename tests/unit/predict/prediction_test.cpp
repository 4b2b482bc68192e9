// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "predict/own_runs.h"
#include "support/made_coatings.h"
#include "support/test_folder.h"
#include <fstream>
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;

Calibration exact() {
  Calibration c;
  c.error = {0.0, 0.001, 0.002};
  c.draws = {{{{{190.0, 2.4, 480.0}, {}}}, {0.001, 0.5}}};
  return c;
}

TEST(Mixture, QuantilesOfANormalAndOfTwo) {
  const Mixture one = {{{0.3, 0.0004}}};
  EXPECT_NEAR(one.quantile(0.95), 0.3 + 1.644854 * 0.02, 1e-6);
  const Mixture two = {{{0.0, 1e-6}, {1.0, 1e-6}}};
  EXPECT_NEAR(two.probability_below(0.5), 0.5, 1e-12);
  EXPECT_NEAR(two.quantile(0.25), 0.0, 1e-3);
  EXPECT_NEAR(two.quantile(0.75), 1.0, 1e-3);
}

TEST(Predicted, PorosityUnderLoadIsThatBeforeTheSpringback) {
  const Film film = made_film("x", 46.0, 2.0);
  const PredictedFilm p = predicted(made_film_bank(), exact(), film, {80.0, 150.0}, 0.0);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::vector<double> all = {190.0, 2.4, 480.0, 46.0, 2.0};
    const double after = made_porosity(all, 0.0, p.pressures[k]);
    EXPECT_NEAR(p.after[k].median, after, 0.005);
    EXPECT_NEAR(p.under_load[k].median,
                1.0 - (1.0 - after) * (1.0 + made_springback(all, p.pressures[k])), 0.008);
    EXPECT_NEAR(p.modulus[k].median, made_modulus(all), 0.02);
    EXPECT_LT(p.after[k].low90, p.after[k].low50);
    EXPECT_LT(p.after[k].high50, p.after[k].high90);
  }
}

TEST(Predicted, APressOfUncertainPressureWidens) {
  const Film film = made_film("x", 46.0, 2.0);
  const auto width = [&](double pressure_sd) {
    const Band b = predicted(made_film_bank(), exact(), film, {80.0}, pressure_sd).after[0];
    return b.high90 - b.low90;
  };
  EXPECT_GT(width(0.2), 1.5 * width(0.0));
}

TEST(AddPressError, IsTheSlopeTimesTheErrorOfTheLogarithm) {
  // Two draws of one slope, 0.04 to a factor of e below 50 MPa and 0.02 above.
  const double e = std::exp(1.0);
  const std::vector<double> pressures = {50.0 / e, 50.0, 50.0 * e};
  Predictions draws = {{{0.34, 0.0}, {0.30, 1e-4}, {0.28, 0.0}},
                       {{0.36, 0.0}, {0.32, 1e-4}, {0.30, 0.0}}};
  add_press_error(draws, pressures, 0.1);
  for (const std::vector<MeanVariance> &d : draws) {
    EXPECT_NEAR(d[0].variance, 16e-6, 1e-12);
    EXPECT_NEAR(d[1].variance, 1e-4 + 9e-6, 1e-12); // the mean of both slopes
    EXPECT_NEAR(d[2].variance, 4e-6, 1e-12);
  }
}

// What an emulator says and what a run gives are corrected alike, but for the emulator's own error.
TEST(GivenData, IsTheEmulatorAndWhatTheModelMisses) {
  Calibration c = exact();
  const Film film = made_film("measured", 46.0, 2.0);
  c.films = {film};
  const Material &material = c.draws.front().materials[0];
  const FilmBank &bank = made_film_bank();
  const double expected =
      bank.at(bank.at_pressures(FilmNumber::PorosityAfter, film, material), 80.0).mean;
  c.data = {{0, "p080", FilmNumber::PorosityAfter, 80.0, 0.02, expected + 0.015, 0.003}};
  c.draws.front().missed = {0.02, 0.5};
  const Query query = {made_film("other", 44.0, 2.5), FilmNumber::PorosityAfter, {80.0, 300.0}};
  const auto all = given_data(made_film_bank(), c, c.draws, query).front();
  const auto missed = missed_given_data(made_film_bank(), c, c.draws, query).front();
  const auto curve =
      made_film_bank().at_pressures(query.number, query.film, c.draws.front().materials[0]);
  for (std::size_t k = 0; k < 2; ++k) {
    const MeanVariance g = made_film_bank().at(curve, query.pressures[k]);
    const double sd = std::sqrt(g.variance);
    EXPECT_NEAR(all[k].mean, g.mean + missed[k].mean, sd); // the data miss by less than its error
    EXPECT_LE(all[k].variance, g.variance + missed[k].variance);
    EXPECT_GE(all[k].variance, missed[k].variance - g.variance);
  }
  // half of what the model misses is shared by all films, and most of it is known
  EXPECT_GT(missed[0].mean, 0.25 * 0.015);
  EXPECT_LT(missed[0].mean, 0.5 * 0.015);
  EXPECT_LT(missed[1].mean, missed[0].mean); // a factor 3.75 of pressure away
}

TEST(OwnRuns, ADrawThatCannotBeRunMakesWayForTheNext) {
  const auto odd = [](std::size_t k) { return k % 2 == 1; };
  EXPECT_EQ(spread_draws(8, 2, odd), (std::vector<std::size_t>{3, 7}));
  EXPECT_EQ(spread_draws(8, 2, [](std::size_t k) { return k == 0; }),
            (std::vector<std::size_t>{0, 0}));
  EXPECT_EQ(spread_draws(8, 2, [](std::size_t) { return false; }),
            (std::vector<std::size_t>{2, 6}));
}

TEST(OwnRuns, EveryDrawHasItsMaterialItsPackingAndThePressures) {
  Calibration c = exact();
  c.draws.clear();
  for (int k = 0; k < 100; ++k)
    c.draws.push_back(
        {{{{150.0 + k, 2.0, 400.0},
           k < 50 ? std::vector<ActiveEffect>() : std::vector<ActiveEffect>{{0, 0.4}}}},
         {0.001, 0.5}});
  const auto file = calendem_test::test_folder() / "other.toml";
  std::ofstream(file) << "name = \"other\"\n[particles]\nsigma_ln = "
                         "0.3\n[cell]\nx_um = 7\ny_um = 7\n";
  const Recipe recipe = read_recipe(file.string());
  const FilmBank &bank = made_film_bank();
  EXPECT_THROW(bank.film_of(recipe), Failure);
  const std::vector<Draw> draws = some_draws(bank, c, recipe, 0, 4);
  ASSERT_EQ(draws.size(), 4u);
  EXPECT_EQ(draws[0].materials[0].parameters[0], 162.0);
  EXPECT_EQ(draws[3].materials[0].parameters[0], 237.0);
  EXPECT_EQ(bank.described(recipe).recipe.front(), 47.97);
  const Study study = own_runs(bank, draws, recipe, 0, {10.0, 400.0});
  ASSERT_EQ(study.runs.size(), 8u);
  const StudyRun &last = study.runs.back();
  EXPECT_EQ(last.recipe.seed, 4u);
  EXPECT_EQ(last.recipe.cell_x, 7.0);
  EXPECT_EQ(last.settings.number("platen.max_pressure_MPa"), 400.0);
  EXPECT_EQ(last.settings.number("material.am.youngs_modulus_GPa"), 237.0);
  EXPECT_EQ(last.settings.number("bond.shear_strength_MPa"), 400.0);
  EXPECT_NEAR(last.settings.number("effects.nmc_plasticity.yield_pressure_GPa"),
              key_value(bank, draws[3].materials[0].effects[0]), 1e-3);
  EXPECT_EQ(study.runs.front().settings.number("effects.nmc_plasticity.yield_pressure_GPa"), 0.0);
}

// A material whose CBD has 3 points more nanopores than recipes say is packed and collapses so.
TEST(OwnRuns, HaveTheNanoporesOfTheirMaterial) {
  bank::Runs runs = made_coatings();
  runs.bank.nanoporosity_within = 10.0;
  const FilmBank bank = film_bank_of(runs);
  std::vector<Draw> draws(4);
  for (Draw &d : draws)
    d.materials = {{{190.0, 2.4, 480.0, 3.0}, {{kCollapses, 0.4}}}};
  const auto file = calendem_test::test_folder() / "film.toml";
  std::ofstream(file) << "name = \"film\"\n[cbd]\nnanoporosity_percent = 45\n";
  const Study study = own_runs(bank, draws, read_recipe(file.string()), 0, {50.0});
  EXPECT_NEAR(study.runs.front().recipe.nanoporosity, 0.48, 1e-12);
  EXPECT_NEAR(study.runs.front().settings.number("effects.cbd_collapse.initial_nanoporosity"), 0.48,
              1e-12);
  EXPECT_EQ(study.runs.front().settings.number("material.am.youngs_modulus_GPa"), 190.0);
}

// Passes take the same thickness each: 6 mg/cm2 of 47.97 % are 26.3 um; to 20 um in three passes the first goes to 24.2.
TEST(OwnRuns, UnderARollEveryPassTakesTheSame) {
  std::vector<Draw> draws(4);
  for (Draw &d : draws)
    d.materials = {{{190.0, 2.4, 480.0}, {}}};
  const auto file = calendem_test::test_folder() / "film.toml";
  std::ofstream(file) << "name = \"film\"\n[coating]\nloading_mg_cm2 = 6\n";
  const Recipe recipe = read_recipe(file.string());
  const FilmBank &bank = made_film_bank();
  const double before = bank.solid_column(bank.described(recipe)) / (1.0 - 0.4797);
  const Study once = own_runs_at_gaps(bank, draws, recipe, 0, {20.0, 22.0}, 1),
              thrice = own_runs_at_gaps(bank, draws, recipe, 0, {20.0, 22.0}, 3);
  ASSERT_EQ(thrice.runs.size(), 8u);
  const Settings &first = thrice.runs[0].settings;
  EXPECT_EQ(first.text("platen.control"), "roll_gap");
  EXPECT_EQ(first.number("platen.roll_gap_um"), 20.0);
  EXPECT_EQ(first.number("roll.passes"), 3.0);
  EXPECT_NEAR(first.number("roll.first_gap_um"), before - (before - 20.0) / 3.0,
              0.005); // four digits
  EXPECT_EQ(thrice.runs[1].settings.number("platen.roll_gap_um"), 22.0);
  EXPECT_EQ(once.runs[0].settings.number("roll.passes"), 1.0);
  EXPECT_EQ(once.runs[0].settings.number("roll.first_gap_um"), 0.0);
}

// Two materials: one meets the target for sure at 50 MPa, the other never; at 100 MPa both do with 40 %.
TEST(Chances, AnAssuredProbabilityHoldsForFourOfFiveMaterials) {
  const Target target = {0.3, 0.01, 1.0};
  const auto of = [](FilmNumber number) {
    Predictions draws;
    for (int k = 0; k < 100; ++k)
      draws.push_back(number == FilmNumber::Cracked
                          ? std::vector<MeanVariance>(2, MeanVariance{0.1, 0.0})
                      : k < 70 ? std::vector<MeanVariance>{{0.3, 1e-12}, {0.3, 3.64e-4}}
                               : std::vector<MeanVariance>{{0.4, 1e-12}, {0.3, 3.64e-4}});
    return draws;
  };
  const auto c = chances_from({50.0, 100.0}, of, target);
  EXPECT_NEAR(c[0].all, 0.7, 1e-6);
  EXPECT_NEAR(c[0].assured, 0.0, 1e-6);
  EXPECT_NEAR(c[1].assured, 0.4, 0.01);
  EXPECT_EQ(best_of(c), 1u);
  EXPECT_EQ(best_of({c[0]}), 0u);
  EXPECT_EQ(best_of({{80.0, 0.1, 1.0, 1.0, 0.1, 0.0}, {90.0, 0.2, 1.0, 1.0, 0.2, 0.0}}), 1u);
}

// Runs of a film's own are few draws: of five the second lowest is assured, of ten the third.
TEST(Chances, OfFewDrawsFourOfFiveReachTheAssured) {
  for (const int n : {5, 10, 20, 400}) {
    std::vector<double> all; // of the draws, ascending
    Predictions after;
    for (int k = 0; k < n; ++k) {
      after.push_back({{0.3, std::pow(0.01 * (n - k), 2)}});
      all.push_back(std::erf(1.0 / (n - k) / std::sqrt(2.0)));
    }
    const auto c = chances_from({80.0}, [&](FilmNumber) { return after; }, {0.3, 0.01, 1.0});
    EXPECT_NEAR(c[0].assured, all[std::size_t(n / 5)], 1e-9) << n;
  }
}

// A run may lack a number, here its tortuosity: that draw does not count, the others stay what they are.
TEST(Chances, ADrawThatLacksANumberIsLeftOut) {
  const auto of = [](FilmNumber number) {
    if (number == FilmNumber::InverseTortuosity)
      return Predictions{{{NAN, 0.0}}, {{0.5, 0.0}}, {{0.2, 0.0}}};
    return Predictions{
        {{0.0, 0.0}}, {{0.3, 0.0}}, {{0.3, 0.0}}}; // the first would miss the porosity
  };
  const auto c = chances_from({80.0}, of, {0.3, 0.01, 1.0, 3.0});
  EXPECT_EQ(c[0].porosity, 1.0);
  EXPECT_EQ(c[0].tortuosity, 0.5);
  EXPECT_EQ(c[0].all, 0.5);
  const auto none = chances_from({80.0},
                                 [](FilmNumber number) {
                                   const double after =
                                       number == FilmNumber::PorosityAfter ? NAN : 0.3;
                                   return Predictions{{{after, 0.0}}};
                                 },
                                 {0.3, 0.01, 1.0});
  EXPECT_EQ(none[0].all, 0.0);
  EXPECT_EQ(none[0].assured, 0.0);
}

// The pressure that gives the middle of the target is the best, and a bound on cracks takes the high ones away.
TEST(Chances, ThePressureThatMeetsTheTargetIsTheBest) {
  const Film film = made_film("x", 46.0, 2.0);
  const std::vector<double> all = {190.0, 2.4, 480.0, 46.0, 2.0};
  const auto pressures = spread_pressures(20.0, 300.0, 25);
  EXPECT_EQ(pressures.front(), 20.0);
  EXPECT_NEAR(pressures.back(), 300.0, 1e-9);
  const Target target = {made_porosity(all, 0.0, 100.0), 0.01, 1.0};
  const auto c = chances(made_film_bank(), exact(), film, pressures, 0.0, target);
  std::size_t best = 0;
  for (std::size_t k = 1; k < c.size(); ++k)
    if (c[k].all > c[best].all)
      best = k;
  EXPECT_NEAR(std::log(c[best].at / 100.0), 0.0, 0.25);
  EXPECT_GT(c[best].all, 0.9);
  Target few_cracks = target;
  few_cracks.cracked_below = made_cracked(all, 30.0);
  const auto bounded = chances(made_film_bank(), exact(), film, pressures, 0.0, few_cracks);
  EXPECT_LT(bounded[best].all, 0.5 * c[best].all + 0.3);
  EXPECT_LT(bounded.back().cracked, 0.05);
}

// Pores of a third of the volume have a tortuosity factor of 2.5 here: a bound above it asks for nothing, one below it for what
// no film of that porosity has.
TEST(Chances, ABoundOnTheTortuosityCounts) {
  const Film film = made_film("x", 46.0, 2.0);
  const std::vector<double> all = {190.0, 2.4, 480.0, 46.0, 2.0};
  const double porosity = made_porosity(all, 0.0, 100.0), tau = 1.0 / made_inverse(porosity);
  const auto at = [&](double below) {
    return chances(made_film_bank(), exact(), film, {100.0}, 0.0, {porosity, 0.01, 1.0, below})[0];
  };
  EXPECT_GT(at(1.1 * tau).tortuosity, 0.95);
  EXPECT_LT(at(0.9 * tau).tortuosity, 0.05);
  EXPECT_LT(at(0.9 * tau).all, 0.05);
  EXPECT_GT(at(1.1 * tau).all, 0.9);
  EXPECT_NEAR(predicted(made_film_bank(), exact(), film, {100.0}, 0.0).tortuosity[0].median, tau,
              0.03 * tau);
}

TEST(Chances, WhatABankDoesNotHaveCannotBeAskedFor) {
  bank::Runs runs = made_coatings();
  for (bank::Run &run : runs.runs)
    for (bank::PressedFilm &press : run.presses)
      press.inverse_tortuosity = NAN;
  const FilmBank bank = film_bank_of(runs);
  EXPECT_FALSE(bank.knows(FilmNumber::InverseTortuosity));
  EXPECT_TRUE(bank.knows(FilmNumber::Broken));
  const Film film = made_film("x", 46.0, 2.0);
  EXPECT_TRUE(predicted(bank, exact(), film, {100.0}, 0.0).tortuosity.empty());
  EXPECT_THROW(chances(bank, exact(), film, {100.0}, 0.0, {0.3, 0.01, 1.0, 3.0}), Failure);
}

} // namespace
