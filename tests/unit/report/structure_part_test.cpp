// SPDX-License-Identifier: GPL-2.0-or-later
// What `calendem measure` left in a run's directory, in the report.
#include "report/plots.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/provenance.h"
#include "support/make_run.h"
#include "support/test_folder.h"

namespace fs = std::filesystem;
using namespace calendem::report;
using calendem::Mistakes;
using nlohmann::json;
using ReportRun = calendem::Run; // a test has a Run of its own

namespace {

class StructurePart : public ::testing::Test {
protected:
  void SetUp() override {
    calendem::tests::MadeRun small;
    small.bodies = 3;
    small.rows = 40;
    small.frames = false;
    calendem::tests::make_run(folder_, small);
    std::ofstream(folder_ / "structure.csv")
        << "moment,z_from_um,z_to_um,z_over_thickness,am_fraction,cbd_fraction,porosity_macro,"
           "porosity_total,bonds,bonds_broken\n"
           "before,0,1,0.25,0.5,0.1,0.4,0.45,10,0\nbefore,1,2,0.75,0.4,0.1,0.5,0.55,8,0\n"
           "max,0,1,0.25,0.7,0.1,0.2,0.25,10,4\nmax,1,2,0.75,0.6,0.1,0.3,0.35,0,0\n";
    write(calendem::hash_of_file((folder_ / "curve.csv").string()));
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string &curve) const {
    const json before = {
        {"moment", "before"},
        {"porosity_macro", 0.45},
        {"tortuosity",
         {{"tau_through_plane", 1.75}, {"through_plane", {{"extrapolated", false}}}}}};
    const json max = {{"moment", "max"},
                      {"porosity_macro", 0.25},
                      {"tortuosity", {{"tau_through_plane", nullptr}}}};
    std::ofstream(folder_ / "structure.json")
        << json{{"moments", {before, max}}, {"provenance", {{"curve", curve}}}};
  }
  ReportRun read() const {
    Mistakes mistakes;
    ReportRun run = read_run(folder_.string(), mistakes);
    EXPECT_TRUE(mistakes.empty());
    return run;
  }
  static std::string notes(const ReportRun &run) {
    std::string text;
    for (const auto &note : run.notes.list())
      text += text_of(note) + "\n";
    return text;
  }

  const fs::path folder_ = calendem_test::test_folder();
};

} // namespace

// Requirement: the profiles are charts in percent, a moment a series; a slice without bonds has no
// broken share.
TEST_F(StructurePart, ProfilesAreCharts) {
  const std::vector<ReportRun> runs = {read()};
  const Chart porosity = porosity_profiles(runs);
  ASSERT_EQ(porosity.series.size(), 2u);
  EXPECT_EQ(porosity.series[0].name, "before");
  EXPECT_EQ(porosity.series[0].x, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(porosity.series[0].y, (std::vector<double>{40, 50}));
  EXPECT_EQ(porosity.series[1].y, (std::vector<double>{20, 30}));
  EXPECT_NE(porosity.series[0].dash, porosity.series[1].dash);
  const Chart broken = broken_profiles(runs);
  ASSERT_EQ(broken.series.size(), 1u);
  EXPECT_EQ(broken.series[0].x, std::vector<double>{0.25});
  EXPECT_EQ(broken.series[0].y, std::vector<double>{40});
}

// Requirement: the table has a column per moment, percent for fractions, a dash for what is not
// known, a sign for what is a bound, and no row that nobody measured.
TEST_F(StructurePart, TableOfMoments) {
  const json table = structure_table(read());
  EXPECT_EQ(table["moments"], (json{"before", "at maximum pressure"}));
  ASSERT_EQ(table["rows"].size(), 2u);
  EXPECT_EQ(table["rows"][0]["quantity"], "Porosity macro, %");
  EXPECT_EQ(table["rows"][0]["cells"][1]["text"], "25.00");
  EXPECT_EQ(table["rows"][1]["quantity"], "Tortuosity factor through the plane");
  EXPECT_EQ(table["rows"][1]["cells"][0]["text"], "≤ 1.75");
  EXPECT_EQ(table["rows"][1]["cells"][1]["text"], "–");
}

// Requirement: a run that was not measured has neither charts nor table nor note.
TEST_F(StructurePart, NothingWhereNothingWasMeasured) {
  const std::string before = notes(read());
  fs::remove(folder_ / "structure.json");
  const ReportRun run = read();
  EXPECT_EQ(notes(run), before);
  EXPECT_TRUE(structure_table(run).is_null());
  EXPECT_TRUE(porosity_profiles({run}).series.empty());
  EXPECT_TRUE(broken_profiles({run}).series.empty());
}

// Requirement: what was measured of another run, or is cut, is left out with a note.
TEST_F(StructurePart, WhatIsStaleOrCutIsLeftOut) {
  write("0123456789abcdef");
  ReportRun run = read();
  EXPECT_NE(notes(run).find("measured of another curve.csv"), std::string::npos);
  EXPECT_TRUE(structure_table(run).is_null());
  fs::resize_file(folder_ / "structure.json", 30);
  run = read();
  EXPECT_NE(notes(run).find("structure.json: it or structure.csv is cut"), std::string::npos);
  EXPECT_TRUE(run.profile.empty());
}
