// SPDX-License-Identifier: GPL-2.0-or-later
// What is said of films, given data of others: the model's error, rules of thumb, films left out.
#include "predict/prediction.h"
#include "support/made_coatings.h"
#include "support/with_all.h"
#include <cmath>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;

// A datum pulls the prediction of its own film more than that of another, and none far away in pressure as much.
TEST(GivenData, APartOfTheModelsErrorIsSharedBetweenFilms) {
  Calibration c;
  c.error = {0.0, 0.02, 0.0201};
  c.films = {made_film("a", 48.0, 2.0)};
  const Draw draw = {{{{190.0, 2.4, 480.0}, {}}}, {0.02, 0.5}};
  const double expected = made_porosity({190.0, 2.4, 480.0, 48.0, 2.0}, 0.0, 80.0);
  c.data = {{0, "p", FilmNumber::PorosityAfter, 80.0, 0.0, expected + 0.02, 1e-4}};
  const FilmBank &bank = made_film_bank();
  const auto pulled = [&](const Film &film, double pressure) {
    Calibration without = c;
    without.data.clear();
    const Query query = {film, FilmNumber::PorosityAfter, {pressure}};
    return given_data(bank, c, {draw}, query)[0][0].mean -
           given_data(bank, without, {draw}, query)[0][0].mean;
  };
  EXPECT_NEAR(pulled(c.films[0], 80.0), 0.02, 0.004);
  EXPECT_NEAR(pulled(made_film("b", 48.1, 2.0), 80.0), 0.01, 0.002);
  EXPECT_DOUBLE_EQ(pulled(made_film("b", 48.0, 2.0), 80.0), pulled(c.films[0], 80.0));
  EXPECT_NEAR(pulled(c.films[0], 80.0 * std::exp(1.0)), 0.02 * std::exp(-0.5), 0.004);
}

// Particles a tenth larger than the bank's: 0.7 points, one slope for all films of such particles.
TEST(GivenData, OtherParticlesAreAnErrorThatFilmsOfThemShare) {
  Calibration c;
  c.error = {0.0, 0.001, 0.002};
  const Draw draw = {{{{190.0, 2.4, 480.0}, {}}}, {1e-6, 0.0}};
  const FilmBank &bank = made_film_bank();
  const auto at = [&](double sizes) {
    Film film = made_film("b", 44.0, 2.5);
    film.sizes = sizes;
    const Query query = {film, FilmNumber::PorosityAfter, {80.0}};
    const MeanVariance emulated =
        bank.at(bank.at_pressures(query.number, film, draw.materials[0]), 80.0);
    const MeanVariance given = given_data(bank, c, {draw}, query)[0][0];
    return MeanVariance{given.mean - emulated.mean, given.variance - emulated.variance};
  };
  EXPECT_NEAR(std::sqrt(at(0.1).variance), 0.007, 1e-5);
  EXPECT_NEAR(at(0.0).variance, 0.0, 1e-10);
  c.films = {made_film("a", 48.0, 2.0)};
  c.films[0].sizes = 0.1;
  const double expected =
      bank.at(bank.at_pressures(FilmNumber::PorosityAfter, c.films[0], draw.materials[0]), 80.0)
          .mean;
  c.data = {{0, "p", FilmNumber::PorosityAfter, 80.0, 0.0, expected - 0.01, 1e-4}};
  EXPECT_LT(at(0.2).mean, 1.9 * at(0.1).mean);
  EXPECT_LT(at(0.1).mean, -0.005);
  EXPECT_GT(at(-0.1).mean, 0.005);
  EXPECT_LT(std::fabs(at(0.0).mean), 0.02 * std::fabs(at(0.1).mean)); // the emulator's error
}

// Without an error of the model the emulator's own is left: a film that was measured has it no more at this pressure, one
// that is nearly the same hardly, one from the other end of the bank almost as before.
TEST(GivenData, TheEmulatorsErrorIsCommonToFilmsThatAreAlike) {
  Calibration c;
  c.error = {0.0, 1e-7, 2e-7};
  const Draw draw = {{{{240.0, 3.9, 1400.0}, {}}}, {1e-7, 0.0}};
  const FilmBank &bank = made_film_bank();
  const Film measured = made_film("a", 56.5, 5.2);
  const auto emulated = [&](const Film &film) {
    return bank.at(bank.at_pressures(FilmNumber::PorosityAfter, film, draw.materials[0]), 80.0);
  };
  const double sd = std::sqrt(emulated(measured).variance);
  c.films = {measured};
  c.data = {
      {0, "p", FilmNumber::PorosityAfter, 80.0, 0.0, emulated(measured).mean + sd, 0.01 * sd}};
  const auto left = [&](const Film &film) {
    const MeanVariance g =
        given_data(bank, c, {draw}, {film, FilmNumber::PorosityAfter, {80.0}})[0][0];
    return std::sqrt(g.variance / emulated(film).variance);
  };
  EXPECT_NEAR(left(measured), 0.01, 0.001);
  EXPECT_LT(left(made_film("b", 56.3, 5.15)), 0.3);
  EXPECT_GT(left(made_film("c", 41.0, 1.6)), 0.8);
}

TEST(RulesOfThumb, FindTheirOwnConstants) {
  std::vector<Pressed> heckel, meyer;
  for (const double before : {0.42, 0.48})
    for (const double p : {20.0, 60.0, 150.0}) {
      heckel.push_back({before, p, before * std::exp(-p / 350.0 - 0.25)});
      meyer.push_back({before, p, 0.18 + (before - 0.18) * std::exp(-p / 70.0)});
    }
  const auto of_heckel = rules_of_thumb(heckel)[0].constants;
  EXPECT_NEAR(of_heckel[0], 350.0, 1.0);
  EXPECT_NEAR(of_heckel[1], 0.25, 0.001);
  const auto of_meyer = rules_of_thumb(meyer)[1].constants;
  EXPECT_NEAR(of_meyer[0], 0.18, 0.001);
  EXPECT_NEAR(of_meyer[1], 70.0, 0.5);
}

// Two measured numbers of each truth, drawn from the priors: each film predicted from the other. 90 % are expected
// inside; the two of a truth miss together at the worst, which doubles the deviation of the binomial law. Two of those
// below are allowed.
TEST(LeftOut, IntervalsHoldWhatTheyPromise) {
  Random random(5, 3);
  const int truths = with_all(20, 10);
  int inside = 0, all = 0;
  CalibrationSettings settings;
  settings.samples = 512;
  settings.draws = 100;
  for (int k = 0; k < truths; ++k) {
    Truth truth;
    truth.material = {120.0 * std::pow(2.5, random.uniform()),
                      1.6 * std::pow(2.5, random.uniform()),
                      250.0 * std::pow(4.0, random.uniform())};
    Calibration c;
    c.error = {0.0, 0.001, 0.02};
    measure(truth, made_film("a", 42.0 + 9.0 * random.uniform(), 2.0), {60.0}, 0.003, random, c);
    measure(truth, made_film("b", 42.0 + 9.0 * random.uniform(), 2.5), {120.0}, 0.003, random, c);
    for (const LeftOut &row : left_out(made_film_bank(), c, settings)) {
      ++all;
      inside += row.measured >= row.predicted.low90 && row.measured <= row.predicted.high90;
    }
  }
  EXPECT_EQ(all, 2 * truths);
  EXPECT_GE(inside, 0.9 * all - 2.0 * 2.0 * std::sqrt(0.9 * 0.1 * truths));
}

// A reading that is no porosity of the film is predicted as well; no rule of thumb has it.
TEST(LeftOut, HoldsEveryReading) {
  Random random(4, 1);
  Calibration c;
  c.error = {0.0, 0.0199, 0.02}; // of cracked particles five times as much
  measure({}, made_film("a", 48.0, 2.0), {60.0}, 0.003, random, c);
  measure({}, made_film("b", 43.0, 2.5), {120.0}, 0.003, random, c);
  Datum cracked = c.data.back();
  cracked.number = FilmNumber::Cracked;
  cracked.measured = 0.3;
  cracked.sd = 0.05;
  c.data.push_back(cracked);
  CalibrationSettings settings;
  settings.samples = 256;
  settings.draws = 100;
  const auto rows = left_out(made_film_bank(), c, settings);
  ASSERT_EQ(rows.size(), 3u);
  for (const LeftOut &row : rows) {
    const bool porosity = row.number == FilmNumber::PorosityAfter;
    EXPECT_EQ(row.rules.size(), porosity ? 2u : 0u);
    EXPECT_EQ(row.measured == 0.3, !porosity);
  }
  // Its own error and that of the model, 0.1, are the least that it may be off by.
  EXPECT_GT(rows.back().predicted.high90 - rows.back().predicted.low90, 2.0 * 1.6 * 0.11);
}

// A film of a material that was not measured, predicted from two that were: materials are as alike as the model takes them
// to be, from not at all to fully. 90 % of the values are expected inside; three standard deviations below are allowed.
TEST(LeftOut, IntervalsHoldForAMaterialThatWasNotMeasured) {
  const FilmBank &bank = made_film_bank();
  Random random(6, 3);
  const int worlds = with_all(24, 10);
  int inside = 0;
  for (int k = 0; k < worlds; ++k) {
    const double alike = random.uniform();
    Truth truths[3];
    for (Truth &t : truths)
      t.material.clear();
    for (const inference::Parameter &p : bank.material()) {
      const double common = random.normal();
      for (Truth &t : truths)
        t.material.push_back(
            p.prior.value(std::sqrt(alike) * common + std::sqrt(1.0 - alike) * random.normal()));
    }
    Calibration c;
    c.error = {0.0, 0.001, 0.02};
    c.materials = {"a", "b"};
    for (int m = 0; m < 2; ++m) {
      Film film = made_film("measured", 46.0, 2.0);
      film.material = m;
      measure(truths[m], film, {60.0, 120.0}, 0.003, random, c);
    }
    CalibrationSettings settings;
    settings.samples = 512;
    settings.draws = 100;
    calibrate(bank, settings, c);
    Film film = made_film("new", 44.0, 2.5);
    film.material = 2;
    const Band band = predicted(bank, c, film, {100.0}, 0.0).after[0];
    const double after = made_porosity(all_parameters(truths[2], film), 0.0, 100.0);
    inside += after >= band.low90 && after <= band.high90;
  }
  EXPECT_GE(inside, 0.9 * worlds - 3.0 * std::sqrt(0.9 * 0.1 * worlds));
}

} // namespace
