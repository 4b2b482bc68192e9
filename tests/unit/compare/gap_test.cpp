// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/gap.h"
#include "compare/observables.h"
#include "pressed.h"
#include "support/page.h"
#include "support/test_folder.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <gtest/gtest.h>
#include <random>

namespace calendem {
namespace {

TEST(FindGap, OneRunIsTheResidualOverTheMeasurementsDeviation) {
  const Gap gap = find_gap(paper(), {pressed_to(150, 0.2997, "a")});
  ASSERT_EQ(gap.rows.size(), 1u);
  EXPECT_NEAR(gap.rows[0].residual, 29.97 - 25.17, 1e-9);
  EXPECT_NEAR(gap.rows[0].z, 4.8 / 1.2, 1e-9);
  EXPECT_NEAR(gap.threshold, 1.959964, 1e-6); // one row: the normal's 97.5 % point
  EXPECT_NEAR(gap.p_value, std::erfc(4.0 / std::sqrt(2.0)), 1e-9);
  EXPECT_TRUE(gap.rows[0].significant);
  EXPECT_TRUE(std::isnan(gap.rows[0].sd_seeds));
}

// A value without a deviation, of one packing, cannot be judged, and takes nothing from the others.
TEST(FindGap, WithoutAnyDeviationThereIsNoZ) {
  Experiment e = paper();
  e.conditions[1].cracked_bodies_fraction = Measured{0.0, 0.0};
  SimulatedRun r = pressed_to(150, 0.2997, "a");
  for (const double cracked : {0.0, 0.1}) {
    r.cracked_fraction = cracked;
    const Gap gap = find_gap(e, {r});
    ASSERT_EQ(gap.rows.size(), 2u);
    EXPECT_EQ(gap.rows[0].observable, "total porosity");
    EXPECT_NEAR(gap.rows[0].share, 1.0, 1e-12);
    EXPECT_NEAR(gap.p_value, std::erfc(4.0 / std::sqrt(2.0)), 1e-9);
    EXPECT_TRUE(std::isnan(gap.rows[1].z));
    EXPECT_FALSE(gap.rows[1].significant);
    EXPECT_TRUE(to_json(gap)["where"][1]["z"].is_null());
  }
  e.conditions[1].porosity_after_percent->sd = 0.0;
  const Gap gap = find_gap(e, {r});
  EXPECT_EQ(gap.p_value, 1.0);
  EXPECT_EQ(gap.rows[0].share, 0.0);
}

TEST(FindGap, AnotherElectrodeIsReported) {
  SimulatedRun r = pressed_to(150, 0.28, "a");
  const auto reported = [&r] {
    const std::vector<std::string> texts = find_gap(paper(), {r}).not_said;
    return texts[0].find("its electrode is not the experiment's; density.am_g_cm3: 2.2 instead of "
                         "4.65") != std::string::npos;
  };
  r.recipe = paper().recipe.settings.all();
  r.recipe["coating.loading_mg_cm2"] = "8"; // that may differ
  EXPECT_FALSE(reported());
  r.recipe["density.am_g_cm3"] = "2.2";
  EXPECT_TRUE(reported());
  r.recipe["particles.median_um"] = "9";
  r.recipe["structure.file"] = "film.data"; // has a density, too; its sizes are not the recipe's
  EXPECT_TRUE(reported());
  EXPECT_EQ(find_gap(paper(), {r}).not_said[0].find("particles.median_um"), std::string::npos);
}

// Requirement: an electrode cut out of an image is another one, whatever its recipe's numbers are;
// beside an experiment that names the same image it is none, though numbers of its recipe are not the
// image's.
TEST(FindGap, AnImagesParticlesAreAnotherElectrode) {
  Experiment e = paper();
  SimulatedRun r = pressed_to(150, 0.28, "a");
  r.recipe = e.recipe.settings.all();
  r.recipe["shapes.image"] = "there/film.tif";
  r.recipe["shapes.places"] = "image";
  const auto says = [&](const std::string &text) {
    const std::vector<std::string> texts = find_gap(e, {r}).not_said;
    return !texts.empty() && texts[0].find(text) != std::string::npos;
  };
  EXPECT_TRUE(says("its particles are those of film.tif instead of the recipe's"));
  e.recipe.settings.set("shapes.image", "film.tif");
  e.recipe.settings.set("shapes.places", "image");
  r.recipe["coating.porosity_total_percent"] = "40";
  EXPECT_FALSE(says("its electrode is not"));
  r.recipe["shapes.image"] = "other.tif";
  EXPECT_TRUE(says("its particles are those of other.tif instead of those of film.tif"));
}

// A film of 40 um of solids and a cell of 10: the thickness counts by what each is made of.
TEST(FindGap, AThicknessIsNotThatOfACellOfAnotherLoading) {
  Experiment e = paper();
  e.conditions[1].mass_mg.reset();
  e.conditions[1].porosity_after_percent.reset();
  SimulatedRun r = pressed_to(150, 0.28, "a");
  const double film = solid_thickness_um(e, e.recipe.loading) / (1.0 - 0.28);
  r.solid_column = 10.0;
  r.thickness_after = 10.0 / (1.0 - 0.28);
  e.conditions[1].thickness_after_um = Measured{film, 0.5};
  const Gap gap = find_gap(e, {r});
  ASSERT_EQ(gap.rows.size(), 1u);
  EXPECT_NEAR(gap.rows[0].residual, 0.0, 1e-9);
  EXPECT_NE(fmt::format("{}", fmt::join(gap.not_said, "; ")).find("taken is the recipe's 17.46"),
            std::string::npos);
}

TEST(FindGap, NothingToCompareSaysWhy) {
  try {
    find_gap(paper(), {pressed_to(120, 0.3, "a")});
    FAIL();
  } catch (const Failure &f) {
    EXPECT_NE(std::string(f.what()).find("p150: no run has its pressure of 150 MPa"),
              std::string::npos)
        << f.what();
  }
}

TEST(FindGap, WhatWasImposedIsReported) {
  SimulatedRun r = pressed_to(150, 0.28, "a");
  const auto reported = [&r] {
    const Gap gap = find_gap(paper(), {r});
    return std::any_of(gap.not_said.begin(), gap.not_said.end(), [&r](const std::string &text) {
      return text.find(r.folder + ": the nanoporosity of CBD is imposed, not") == 0;
    });
  };
  EXPECT_FALSE(reported());
  r.imposed = "imposed, not predicted: from 50 to 27 % at 150 MPa";
  EXPECT_TRUE(reported());
}

TEST(FindGap, PressureCountsByTheSlopeOfTheRun) {
  SimulatedRun r = pressed_to(150, 0.2997, "a");
  r.porosity_slope = -2e-4; // per MPa; the pressure is known within 15 MPa
  const Gap gap = find_gap(paper(), {r});
  EXPECT_NEAR(gap.rows[0].sd_pressure, 0.3, 1e-9);
  EXPECT_NEAR(gap.rows[0].sd, std::hypot(1.2, 0.3), 1e-9);
}

// A film pressed once and one pressed twice are no two packings of one condition.
TEST(FindGap, RunsPressedInDifferentWaysAreNotAveraged) {
  std::vector<SimulatedRun> runs = {pressed_to(150, 0.31, "a"), pressed_to(150, 0.29, "b"),
                                    pressed_to(80, 0.34, "a")};
  EXPECT_EQ(find_gap(paper(), runs).rows.size(), 2u);
  runs[1].way = "platen.presses = 2";
  const Gap gap = find_gap(paper(), runs);
  EXPECT_EQ(gap.rows.size(), 1u);
  EXPECT_TRUE(std::any_of(gap.not_said.begin(), gap.not_said.end(), [](const std::string &s) {
    return s.find("pressed in different ways") != std::string::npos;
  }));
}

TEST(FindGap, ScatterIsPooledOverConditionsAndRunsOfOnePackingAreOne) {
  const Gap gap = find_gap(paper(), {pressed_to(150, 0.31, "a"), pressed_to(150, 0.33, "b"),
                                     pressed_to(150, 0.33, "b"), pressed_to(80, 0.34, "a"),
                                     pressed_to(80, 0.36, "b")});
  ASSERT_EQ(gap.rows.size(), 2u);
  EXPECT_EQ(gap.degrees_of_freedom, 2);
  for (const Residual &r : gap.rows) { // deviations of 1 point twice, 2 degrees, mean of two
    EXPECT_EQ(r.packings, 2);
    EXPECT_NEAR(r.sd_seeds, std::sqrt(4.0 / 2.0 / 2.0), 1e-9) << r.condition;
  }
  EXPECT_NEAR(gap.rows[0].share + gap.rows[1].share, 1.0, 1e-12);
}

TEST(FindGap, NoRunOfAnyConditionIsBadInput) {
  EXPECT_THROW(find_gap(paper(), {pressed_to(120, 0.3, "a")}), Failure);
}

// 4000 experiments without a gap, four independent rows each: 5 % of the tables cry wolf, within
// 3 standard deviations of a binomial count.
TEST(FindGap, FalseAlarmsOfATableWithoutAGap) {
  Experiment e = paper();
  e.conditions.resize(1);
  e.conditions[0] = {};
  const int kTables = 4000, kRows = 4;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  int alarms = 0;
  for (int n = 0; n < kTables; ++n) {
    e.conditions.clear();
    std::vector<SimulatedRun> runs;
    for (int k = 0; k < kRows; ++k) {
      Condition c;
      c.id = std::string(1, char('a' + k));
      c.control = "pressure";
      c.max_pressure_MPa = Measured{20.0 * (k + 1), 0.0};
      c.porosity_after_percent = Measured{30.0 + noise(random), 1.0};
      e.conditions.push_back(c);
      runs.push_back(pressed_to(20.0 * (k + 1), 0.30, "a"));
    }
    bool alarm = false;
    for (const Residual &r : find_gap(e, runs).rows)
      alarm |= r.significant;
    alarms += alarm;
  }
  EXPECT_NEAR(alarms / double(kTables), 0.05, 3.0 * std::sqrt(0.05 * 0.95 / kTables));
}

// Where the platen first touched is an error of every displacement.
TEST(FindGap, TheFirstTouchCounts) {
  const auto file = calendem_test::test_folder() / "curve.csv";
  std::ofstream(file) << "displacement_um,pressure_MPa\n0,0\n10,50\n20,100\n";
  Experiment e = paper();
  Condition &c = e.conditions[1];
  c.porosity_after_percent.reset();
  c.mass_mg.reset();
  c.thickness_after_um.reset();
  c.curve = file.string();
  c.curve_sd_um = 0.02;
  c.curve_zero_um = 1.0;
  const Gap gap = find_gap(e, {pressed_to(150, 0.3, "a")});
  ASSERT_FALSE(gap.rows.empty());
  for (const Residual &r : gap.rows)
    EXPECT_NEAR(r.sd_measurement, std::hypot(0.02, 1.0), 1e-9) << r.observable;
}

// A roll beside a platen is not passed over in silence.
TEST(FindGap, SaysThatAPlatenStandsForARoll) {
  const auto says = [](const Gap &gap) {
    return std::any_of(gap.not_said.begin(), gap.not_said.end(), [](const std::string &text) {
      return text.find("pressed under a roll, the runs under a platen") != std::string::npos;
    });
  };
  Experiment e = paper();
  EXPECT_FALSE(says(find_gap(e, {pressed_to(150, 0.3, "a")})));
  e.conditions[1].control = "roll_gap";
  EXPECT_TRUE(says(find_gap(e, {pressed_to(150, 0.3, "a")})));
}

TEST(HeatMap, ConditionsStandOnceInTheOrderGiven) {
  const auto row = [](const char *observable, const char *condition, double z) {
    return nlohmann::json{{"observable", observable},
                          {"stage", "relaxation"},
                          {"condition", condition},
                          {"residual", 0.5 * z},
                          {"z", z},
                          {"unit", "%"}};
  };
  const nlohmann::json map = heat_map(
      {row("a", "p50", 7.0), row("a", "p150", -4.0), row("b", "p50", 2.0)}, 3.0, {"p50", "p150"});
  EXPECT_EQ(map["conditions"], (std::vector<std::string>{"p50", "p150"}));
  ASSERT_EQ(map["rows"].size(), 2u);
  const nlohmann::json &first = map["rows"][0]["cells"], &second = map["rows"][1]["cells"];
  EXPECT_EQ(first[0]["text"], "+3.5\u00a0points (z\u00a0+7.0)");
  EXPECT_NE(first[0]["colour"], second[0]["colour"]); // beyond twice the threshold, within
  EXPECT_NE(first[0]["colour"], first[1]["colour"]);  // too high, too low
  EXPECT_EQ(second[1]["text"], "–");
}

bool has(const std::vector<std::string> &texts, const std::string &part) {
  return std::any_of(texts.begin(), texts.end(), [&part](const std::string &text) {
    return text.find(part) != std::string::npos;
  });
}

// Without a mass a thickness beside a porosity is no second measurement; it is not passed over in
// silence.
TEST(FindGap, SaysThatAThicknessBesideAPorosityIsNotCompared) {
  Experiment e = paper();
  Condition &c = e.conditions[1];
  const std::vector<SimulatedRun> runs = {pressed_to(150, 0.2997, "a")};
  const auto loading = c.mass_mg;
  c.mass_mg.reset();
  c.loading_mg_cm2.reset();
  const Gap gap = find_gap(e, runs);
  EXPECT_EQ(gap.rows.size(), 1u);
  // 52.9 um of coating, of which 74.83 % are solid
  const double expected = 52.9 * 0.7483 / solid_thickness_um(e, 1.0);
  EXPECT_TRUE(has(gap.not_said, fmt::format("p150: thickness_after_um is not compared, because the "
                                            "porosity is stated too. Together they mean a loading "
                                            "of {:.3g} mg/cm²",
                                            expected)));
  c.mass_mg = loading;
  EXPECT_FALSE(has(find_gap(e, runs).not_said, "thickness_after_um is not compared"));
  EXPECT_TRUE(has(find_gap(e, runs).not_said, "mass and thickness give a porosity of"));
}

TEST(FindGap, SentencesHaveUnitsAndSignsForPeople) {
  Experiment e = paper();
  for (Condition &c : e.conditions) {
    c.porosity_after_percent.reset();
    c.mass_mg.reset();
  }
  const Gap gap = find_gap(e, {pressed_to(80, 0.2, "a"), pressed_to(150, 0.17, "a")});
  EXPECT_TRUE(has(gap.said, "µm too low (z = −"));
  EXPECT_TRUE(has(gap.said, "p080 → p150, thickness: measured −"));
  EXPECT_TRUE(has(gap.not_said, "its thickness is compared in µm"));
  for (const auto *texts : {&gap.said, &gap.not_said}) {
    EXPECT_FALSE(has(*texts, " um"));
    EXPECT_FALSE(has(*texts, " -"));
  }
}

TEST(GapPage, HoldsItsNumbers) {
  const nlohmann::json j = to_json(find_gap(paper(), {pressed_to(150, 0.2997, "a")}));
  const std::string page = gap_page(j);
  for (const char *text : {"p150", "+4.8", "beyond noise", "no run has its pressure of 80 MPa"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(calendem_test::without_scripts(page).find("{{"), std::string::npos);
  EXPECT_EQ(calendem_test::data_in(page), j);
  EXPECT_NE(page.find("<td>hashes</td><td class=\"file\">64-bit FNV-1a</td>"), std::string::npos);
}

} // namespace
// A film pressed twice is read in its second dwell: 80 and 70 of 100 MPa are its last quarter.
TEST(PressureLeft, IsThatOfTheLastQuarterOfTheLastDwell) {
  std::vector<std::string> stage = {"compression", "compression", "dwell",
                                    "relaxation",  "compression", "compression"};
  std::vector<double> pressure = {50, 90, 10, 1, 60, 100};
  EXPECT_TRUE(std::isnan(pressure_left(stage, pressure)));
  for (const double p : {95.0, 93.0, 92.0, 90.0, 85.0, 82.0, 80.0, 70.0}) {
    stage.push_back("dwell");
    pressure.push_back(p);
  }
  stage.push_back("relaxation");
  pressure.push_back(5);
  EXPECT_DOUBLE_EQ(pressure_left(stage, pressure), 0.75);
}

} // namespace calendem
