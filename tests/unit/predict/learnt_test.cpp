// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/learnt.h"
#include "support/made_coatings.h"
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;

Calibration measured(const std::vector<double> &pressures) {
  Random random(3, 21);
  Calibration c;
  c.error = {0.0, 0.001, 0.02};
  measure({}, made_film("a", 48.0, 2.0), pressures, 0.002, random, c);
  CalibrationSettings s;
  s.samples = 2048;
  s.draws = 400;
  calibrate(made_film_bank(), s, c);
  return c;
}

// Porosities that need no effect, and a domain of carbon and binder with half of its nanopores or with fewer.
TEST(Calibrate, LearnsFromNanopores) {
  const auto collapses = [&](double nanoporosity) {
    Random random(7, 1);
    Calibration c;
    c.error = {0.0, 0.003, 0.04};
    measure({}, made_film("a", 46.0, 2.0), {50.0, 150.0}, 0.02, random, c);
    c.data.push_back({0, "p", FilmNumber::CbdNanoporosity, 150.0, 0.0, nanoporosity, 0.05});
    CalibrationSettings s;
    s.samples = 1024;
    s.draws = 200;
    calibrate(made_film_bank(), s, c);
    return acting(c, kCollapses, 0);
  };
  EXPECT_GT(collapses(0.3), 0.95);
  EXPECT_LT(collapses(0.5), 0.3);
}

// What the others predict is what a calibration without the datum predicts.
TEST(LeftOutData, AreThoseOfACalibrationWithoutTheDatum) {
  const Calibration all = measured({30.0, 60.0, 120.0, 240.0});
  const auto lessons = left_out_data_of(made_film_bank(), all);
  ASSERT_EQ(lessons.size(), 4u);
  for (const std::size_t k : {1, 3}) {
    Calibration without = all;
    without.data.erase(without.data.begin() + std::ptrdiff_t(k));
    CalibrationSettings s;
    s.samples = 2048;
    s.draws = 400;
    calibrate(made_film_bank(), s, without);
    const Datum &d = all.data[k];
    const Band expected = band_of_reading(made_film_bank(), without, all.films[0], d);
    const double width = expected.high90 - expected.low90;
    EXPECT_NEAR(lessons[k].without.median, expected.median, 0.15 * width);
    EXPECT_NEAR(lessons[k].without.high90 - lessons[k].without.low90, width, 0.3 * width);
  }
}

// A value that is read again teaches less than the first; one that contradicts the others moves
// parameters.
TEST(LeftOutData, ARepeatTeachesLittle) {
  Calibration c = measured({30.0, 100.0});
  c.data.push_back(c.data[1]);
  c.data.push_back(c.data[1]);
  CalibrationSettings s;
  calibrate(made_film_bank(), s, c);
  const auto lessons = left_out_data_of(made_film_bank(), c);
  EXPECT_LT(lessons[3].gain, 0.5 * lessons[0].gain);
  EXPECT_GE(lessons[3].gain, 0.0);
}

TEST(LeftOutData, OneDatumHasNone) {
  EXPECT_TRUE(left_out_data_of(made_film_bank(), measured({80.0})).empty());
}

// Porosity shows the product of the binder's stiffness and the root of the strength: one makes up for the other.
TEST(TradeOffs, AreThoseOfTheFormula) {
  const auto found = trade_offs_of(made_film_bank(), measured({30.0, 60.0, 120.0, 240.0}));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].first, "E_cbd_GPa");
  EXPECT_EQ(found[0].second, "strength_MPa");
  EXPECT_LT(found[0].correlation, -0.5);
}

} // namespace
