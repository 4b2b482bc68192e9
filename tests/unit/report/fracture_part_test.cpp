// SPDX-License-Identifier: GPL-2.0-or-later
// Fracture in the report: tables of a made-up run, stages of the paper's Figure 3, the studied
// body.
#include "report/plots.h"

#include <fstream>

#include <gtest/gtest.h>

#include "report/pictures.h"
#include "support/make_run.h"
#include "support/test_folder.h"

namespace fs = std::filesystem;
using namespace calendem::report;
using calendem::Column;
using calendem::Mistakes;
using ReportRun = calendem::Run; // a test has a Run of its own

namespace {

class FracturePart : public ::testing::Test {
protected:
  void TearDown() override { fs::remove_all(folder_); }

  ReportRun made(double max_pressure, bool frames) const {
    calendem::tests::MadeRun small;
    small.bodies = 4;
    small.rows = 80;
    small.frames = frames;
    small.max_pressure_MPa = max_pressure;
    calendem::tests::make_run(folder_, small);
    return read();
  }
  ReportRun read() const {
    Mistakes mistakes;
    ReportRun run = read_run(folder_.string(), mistakes);
    EXPECT_TRUE(mistakes.empty());
    return run;
  }
  void write(const char *name, const char *text) const { std::ofstream(folder_ / name) << text; }

  const fs::path folder_ = calendem_test::test_folder();
};

const char *const kCracks = "time_us,stage,pressure_MPa,bodies_with_bonds,bodies_apart,"
                            "bodies_cracked,bodies_split,cracked_fraction,crack_surface_um2,"
                            "parted_surface_um2\n";

// Percent of bodies with bonds, up to the row of maximum pressure.
TEST_F(FracturePart, ChartsByHand) {
  made(150, false);
  write("cracks.csv", (std::string(kCracks) + "0,compression,0,8,0,0,0,0,0,0\n"
                                              "1,compression,100,8,6,4,2,0.5,30,20\n"
                                              "2,relaxation,50,8,7,5,3,0.6,40,30\n")
                          .c_str());
  write("thresholds.csv", "threshold_percent,above_apart,above_whole,below_apart,below_whole,"
                          "above_split,below_split,agreement,agreement_split\n"
                          "5,4,1,2,3,3,1,0.7,0.7\n");
  const std::vector<ReportRun> runs{read()};
  const Chart cracked = cracked_by_pressure(runs);
  ASSERT_EQ(cracked.series.size(), 3u);
  EXPECT_EQ(cracked.series[0].y, (Column{0, 75})); // apart
  EXPECT_EQ(cracked.series[1].y, (Column{0, 50})); // cracked
  EXPECT_EQ(cracked.series[2].y, (Column{0, 25})); // split
  EXPECT_EQ(crack_surface(runs).series[1].y, (Column{0, 20}));
  const Chart chart = thresholds(runs[0], true);
  ASSERT_EQ(chart.series.size(), 4u);
  EXPECT_EQ(chart.series[0].y, Column{20}); // 2 of 10 apart, but below
  EXPECT_EQ(chart.series[1].y, Column{10}); // 1 above, but whole
  EXPECT_EQ(chart.series[2].y, Column{10}); // 1 split, but below
  EXPECT_EQ(chart.series[3].y, Column{20}); // 5 above, 3 of them split
}

// The body with most broken bonds, and its breaks against the platen's way.
TEST_F(FracturePart, StudiedBody) {
  made(150, false);
  write("bodies.csv",
        "body,primaries,bonds,broken,broken_fraction,fragments,largest_fragment,"
        "shape_change,depth_um,cracked\n"
        "7,9,12,3,0.25,2,0.6,0,10,1\n9,9,12,5,0.4,3,0.5,0,20,1\n3,1,0,0,0,1,1,0,5,0\n");
  write("breaks.csv", "time_us,body\n5,9\n6,7\n8,9\n1e3,9\n");
  const ReportRun run = read();
  EXPECT_EQ(studied_body(run), 9);
  const Chart chart = one_body(run, true);
  ASSERT_EQ(chart.series.size(), 2u);
  EXPECT_EQ(chart.series[1].y.front(), 0);
  EXPECT_EQ(chart.series[1].y.back(), 2); // the third one breaks later
  const Chart depth = broken_by_depth(run, true);
  ASSERT_EQ(depth.series.size(), 1u); // both apart; the third has no bonds
  EXPECT_EQ(depth.series[0].x, (Column{10, 20}));
  EXPECT_EQ(depth.series[0].y, (Column{25, 40}));
}

// A run to 40 MPa has the paper's first three pressures; frames rise in time, the first is the
// first.
TEST_F(FracturePart, StagesUpToTheRunsPressure) {
  ReportRun run = made(40, true);
  const auto stages = stages_of(run);
  ASSERT_EQ(stages.size(), 3u);
  EXPECT_EQ(stages[0].name, "Paper: 0 MPa");
  EXPECT_EQ(stages[2].name, "Paper: 20.1 MPa");
  EXPECT_DOUBLE_EQ(stages[0].time_us, run.particles.front().time_us);
  EXPECT_LT(stages[1].time_us, stages[2].time_us);
  EXPECT_EQ(draw_stages(run).size(), 6u);
  const auto body = draw_one_body(run);
  ASSERT_EQ(body.size(), 7u);
  EXPECT_EQ(body[0].subject, "place");
  EXPECT_DOUBLE_EQ(body[1].broken_fraction, 0); // before
  EXPECT_GT(body[5].broken_fraction, 0);
  EXPECT_TRUE(run.notes.empty());
}

// A frame of a later press has the film of the press before, however near its pressure is.
TEST_F(FracturePart, StagesAreOfTheFirstPressToTheirPressure) {
  ReportRun run = made(150, true);
  const auto expected = stages_of(run);
  const double top = run.curve["time_us"][run.curve.row_of_max_pressure()];
  Column &pressure = run.curve.columns.at("pressure_MPa");
  for (std::size_t i = 0; i < pressure.size(); ++i) // released at 100 MPa, and pressed once more
    if (pressure[i] > 100 && run.curve["time_us"][i] < top)
      pressure[i] = 20.1;
  const auto stages = stages_of(run);
  ASSERT_GE(stages.size(), 3u);
  EXPECT_EQ(stages[2].name, "Paper: 20.1 MPa");
  EXPECT_DOUBLE_EQ(stages[2].time_us, expected[2].time_us);
}

// A measured porosity is one after release: every press has its own.
TEST_F(FracturePart, PorosityIsDrawnAfterEveryPress) {
  ReportRun run = made(150, false);
  run.summary["presses"] = {{{"pressure_MPa", 80}, {"porosity_released", 0.3}},
                            {{"pressure_MPa", 150}, {"porosity_released", 0.25}}};
  const std::vector<ReportRun> runs{run};
  for (const Chart &chart : plots_of(runs))
    for (const Series &s : chart.series)
      if (chart.id == "porosity-pressure" && s.name == "total after relaxation") {
        EXPECT_EQ(s.x, (Column{80, 150}));
        EXPECT_EQ(s.y, (Column{30, 25}));
        return;
      }
  FAIL() << "no such series";
}

// Bonds that will break have another colour than those that stay.
TEST_F(FracturePart, FateIsDrawn) {
  ReportRun run = made(150, true);
  const std::string before = draw_stages(run)[1].png;
  run.bonds.back() = run.bonds.front(); // as if none had broken by the end
  EXPECT_NE(before, draw_stages(run)[1].png);
}

// A run of an earlier version has no charts of fracture; damaged tables are reported.
TEST_F(FracturePart, OldAndDamagedTables) {
  made(150, false);
  write("thresholds.csv", "threshold_percent,above\n5,4\n");
  const ReportRun damaged = read();
  EXPECT_TRUE(thresholds(damaged, true).series.empty());
  EXPECT_NE(damaged.notes.list().back().remedy.find("calendem collect"), std::string::npos);
  fs::remove(folder_ / "cracks.csv");
  const ReportRun old = read();
  EXPECT_TRUE(cracked_by_pressure({old}).series.empty());
  EXPECT_EQ(studied_body(old), 0);
}

} // namespace
