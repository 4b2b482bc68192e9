// SPDX-License-Identifier: GPL-2.0-or-later
// Further measurements, before they are simulated.
#include "diagnose/next_runs.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace calendem;
namespace {

BankSpec shipped() {
  return read_bank_spec(CALENDEM_SOURCE_DIR "/input_scripts/cases/bank/bank.toml");
}

RerunModel model(const std::string &hypothesis, std::map<std::string, double> effect) {
  return {"40 %", hypothesis, {200.0, 2.4, 500.0, 6.0}, std::move(effect), {}};
}

TEST(NextRuns, EveryModelHasTheUsualRunAndOneOfEachMeasurementOnEveryPacking) {
  const BankSpec bank = shipped();
  const auto next = next_runs(bank, 150.0);
  const auto own =
      std::count_if(next.begin(), next.end(), [](const NextRun &n) { return !n.changed.empty(); });
  const Study study = next_study(bank, {model("none", {}), model("friction", {{"friction", 0.25}})},
                                 next, 150.0, 3, 1.0);
  ASSERT_EQ(study.runs.size(), std::size_t(2 * 3 * (1 + own)));
  const auto count = [&](const char *key, double value) {
    return std::count_if(study.runs.begin(), study.runs.end(), [&](const StudyRun &r) {
      return std::fabs(r.settings.number(key) - value) < 1e-9;
    });
  };
  EXPECT_EQ(count("platen.max_pressure_MPa", 300.0), 6);
  EXPECT_EQ(count("platen.dwell_us", 3.0), 6);
  EXPECT_EQ(count("platen.speed_m_s", 1.0), 6);
  EXPECT_EQ(count("material.am.friction", 0.25), 15);
  EXPECT_EQ(std::count_if(study.runs.begin(), study.runs.end(),
                          [](const StudyRun &r) { return r.recipe.loading == 9.0; }),
            6); // the bank varies the loading: the models' own counts elsewhere
}

// A micrometre of an instrument is another strain of another film.
TEST(NextRuns, AnInstrumentsErrorGrowsWithTheFilm) {
  const BankSpec bank = shipped();
  const auto next = next_runs(bank, 80.0);
  const Study study =
      next_study(bank, {model("thickness_zero", {{"thickness_zero", 1.0}})}, next, 80.0, 2, 0.5);
  EXPECT_EQ(study.runs[0].settings.number("effects.thickness_zero.offset_um"), 0.5);
}

TEST(NextRuns, ReadingsAreApartByTheirErrorAndThatOfTheMeans) {
  EXPECT_NEAR(apart({30.0, 0.0}, {33.0, 0.0}, 0.5), 6.0, 1e-12);
  EXPECT_NEAR(apart({30.0, 0.3}, {33.0, 0.4}, 0.0), 6.0, 1e-12);
  EXPECT_TRUE(std::isnan(apart({NAN, 0.3}, {33.0, 0.4}, 0.5)));
}

} // namespace
