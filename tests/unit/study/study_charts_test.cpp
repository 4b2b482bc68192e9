// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "base/provenance.h"
#include "report/study_page.h"
#include "support/page.h"
#include "support/test_folder.h"
#include <cmath>
#include <filesystem>
#include <set>

namespace {

using namespace calendem;

const std::vector<std::string> kVaried = {"case.bond.tensile_strength_MPa",
                                          "case.bond.shear_strength_MPa", "recipe.seed"};
// Two strengths on two packings; the fifth run has failed.
const std::string kTable =
    "status,run,case.bond.tensile_strength_MPa,case.bond.shear_strength_MPa,recipe.seed,"
    "max_pressure_MPa,porosity_after_relaxation,broken_fraction_at_max,broken_fraction_at_20_MPa,"
    "broken_fraction_at_90_MPa,springback,porosity_at_max,pressure_difference_max_above_5_MPa\n"
    "done,a,200,200,1,80.1,0.30,0.3,0.10,0.20,0.1,0.2,0.01\n"
    "done,b,200,200,2,79.9,0.32,0.3,0.12,0.22,0.1,0.2,0.01\n"
    "done,c,400,400,1,80,0.28,0.1,0.01,0.05,0.1,0.2,0.01\n"
    "done,d,400,400,2,80,0.28,0.1,0.01,,0.1,0.2,0.01\n"
    "failed,e,400,400,3,80,0.99,0.9,0.9,0.9,0.1,0.2,0.01\n";

StudyTable table(bool of_paper = true) { return {CsvTable::parse(kTable), kVaried, of_paper}; }

TEST(Groups, PackingsOfASettingAreOneGroupAndRunsThatFailedAreNone) {
  const std::vector<StudyGroup> groups = table().groups();
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(StudyTable::label(groups[0]), "tensile strength = 200 MPa");
  EXPECT_EQ(groups[1].rows, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(table().finished(), 4u);
}

TEST(Groups, AnEffectThatDoesNotActIsOff) {
  const std::string column = "case.effects.nmc_plasticity.yield_pressure_GPa";
  StudyGroup group;
  group.settings[column] = "0";
  EXPECT_EQ(StudyTable::label(group), "yield pressure off");
  group.settings[column] = "3";
  EXPECT_EQ(StudyTable::label(group), "yield pressure = 3 GPa");
}

TEST(Groups, SpreadIsOfTheValuesThatThereAre) {
  const StudyGroup low = table().groups()[0], high = table().groups()[1];
  const MeanAndSd s = table().mean_and_sd(low, "porosity_after_relaxation");
  EXPECT_NEAR(s.mean, 0.31, 1e-15);
  EXPECT_NEAR(s.sd, 0.02 / std::sqrt(2.0), 1e-15);
  EXPECT_EQ(table().mean_and_sd(high, "broken_fraction_at_90_MPa").n, 1);
  EXPECT_EQ(table().mean_and_sd(high, "broken_fraction_at_90_MPa").sd, 0.0);
}

TEST(Groups, PressuresAreThoseOfTheColumns) {
  EXPECT_EQ(table().pressures("broken_fraction"), (std::vector<double>{20, 90}));
}

TEST(Groups, DistanceToThePapersBreaksIsARootMeanSquare) {
  // The paper: 6.8 % at 20 MPa, 17.8 % at 90 MPa.
  const double expected = std::sqrt((std::pow(11.0 - 6.8, 2) + std::pow(21.0 - 17.8, 2)) / 2.0);
  EXPECT_NEAR(distance_to_paper(table(), table().groups()[0]), expected, 1e-12);
}

TEST(Charts, PorosityHasAPointForEachMaximumAndTableOneBeside) {
  const auto none = [](const std::string &) { return CsvTable::parse(""); };
  const report::Chart chart = study_charts(table(), none).front();
  ASSERT_EQ(chart.series.size(), 3u); // two strengths, measured
  EXPECT_EQ(chart.series[0].x, std::vector<double>{80});
  EXPECT_NEAR(chart.series[0].y[0], 31.0, 1e-12);
  EXPECT_EQ(chart.series[2].y[1], 27.75);
}

TEST(Charts, OnlyThePapersFilmIsComparedWithThePaper) {
  const auto none = [](const std::string &) { return CsvTable::parse(""); };
  std::size_t others = 0;
  for (const report::Chart &chart : study_charts(table(false), none)) {
    for (const report::Series &s : chart.series)
      others += s.name.find("paper") != std::string::npos;
    others += chart.limits.size();
  }
  EXPECT_EQ(others, 0u);
}

TEST(Charts, CurvesAreOfTheFirstPackingOfEachSetting) {
  std::vector<std::string> asked;
  study_charts(table(), [&](const std::string &run) {
    asked.push_back(run);
    return CsvTable::parse("displacement_um,pressure_MPa,broken_fraction\n1,2,0.5\n");
  });
  EXPECT_EQ(asked, (std::vector<std::string>{"a", "c"}));
}

TEST(Charts, SettingsAreWrittenInWords) {
  EXPECT_EQ(setting_in_words("case.bond.tensile_strength_MPa"), "bond tensile strength (MPa)");
  EXPECT_EQ(setting_in_words("case.effects.nmc_plasticity.yield_pressure_GPa"),
            "nmc plasticity yield pressure (GPa)");
  EXPECT_EQ(setting_in_words("recipe.seed"), "seed");
}

// A yield pressure of 0 GPa is none at all: it lies beyond the highest one, not below the lowest.
TEST(Charts, OffIsALevelWhereTheAxisHasNoPlaceForIt) {
  const std::string key = "case.effects.nmc_plasticity.yield_pressure_GPa";
  const StudyTable two(CsvTable::parse("status,run," + key +
                                       ",max_pressure_MPa,porosity_after_relaxation,springback\n"
                                       "done,a,0,80,0.4,0.1\ndone,b,3,80,0.3,0.1\n"),
                       {key}, true);
  for (const auto &chart : study_charts(two, [](const auto &) { return CsvTable::parse(""); }))
    if (chart.id == key + "-porosity_after_relaxation") {
      EXPECT_EQ(chart.series[0].x, std::vector<double>{3});
      ASSERT_EQ(chart.limits.size(), 1u);
      EXPECT_DOUBLE_EQ(chart.limits[0].y, 40);
      EXPECT_EQ(chart.limits[0].label, "off");
      return;
    }
  FAIL() << "no such chart";
}

// The strengths of two kinds of bonds have one short name.
TEST(Charts, EachHasAnIdOfItsOwn) {
  const std::vector<std::string> varied = {"case.bond.tensile_strength_MPa",
                                           "case.bridge.tensile_strength_MPa"};
  const StudyTable two(
      CsvTable::parse("status,run,case.bond.tensile_strength_MPa,case.bridge.tensile_strength_MPa,"
                      "max_pressure_MPa,porosity_after_relaxation,springback\n"
                      "done,a,200,1,80,0.3,0.1\ndone,b,400,1,80,0.3,0.1\n"
                      "done,c,200,2,80,0.3,0.1\n"),
      varied, true);
  std::multiset<std::string> ids;
  for (const auto &chart : study_charts(two, [](const auto &) { return CsvTable::parse(""); }))
    ids.insert(chart.id);
  for (const std::string &setting : varied)
    EXPECT_EQ(ids.count(setting + "-springback"), 1u);
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
}

TEST(StudyPage, IsDrawnFromTheTableAndSaysWhatIsMissing) {
  const std::string folder = calendem_test::test_folder().string();
  EXPECT_THROW(draw_study(kVaried, folder), Failure);
  write_file(folder + "/study.csv", kTable);
  EXPECT_THROW(draw_study(kVaried, folder), Failure);
  write_file(folder + "/study.json", R"({"name": "a < b</script>", "runs": 5, "provenance": {}})");
  draw_study(kVaried, folder);
  const std::string page = text_of_file(folder + "/study.html");
  EXPECT_NE(page.find("Study: a &lt; b"), std::string::npos);
  EXPECT_NE(page.find("4 of 5 runs"), std::string::npos);
  EXPECT_NE(page.find("31.0 ± 1.4"), std::string::npos);
  const nlohmann::json data = calendem_test::data_in(page);
  EXPECT_EQ(data["name"], "a < b</script>");
  EXPECT_EQ(data["charts"][0]["id"], "porosity");
  EXPECT_EQ(data["table"]["rows"].size(), 2u);
  EXPECT_NE(page.find("minus Table 1"), std::string::npos);
  std::filesystem::create_directories(folder + "/runs/a");
  write_file(folder + "/runs/a/electrode.json",
             R"({"recipe": {"composition.am_weight_percent": "90"}})");
  draw_study(kVaried, folder);
  EXPECT_EQ(text_of_file(folder + "/study.html").find("minus Table 1"), std::string::npos);
}

} // namespace
