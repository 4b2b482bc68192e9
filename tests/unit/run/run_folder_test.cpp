// SPDX-License-Identifier: GPL-2.0-or-later
// What is wrong with a run's folder is reported in one way, whoever reads it.
#include "base/provenance.h"
#include "base/run_folder.h"
#include "support/test_folder.h"
#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace calendem;

class ARunFolder : public testing::Test {
protected:
  const std::string folder_ = calendem_test::test_folder().string();

  void write(const std::string &name, const std::string &text) {
    write_file(folder_ + "/" + name, text);
  }
  void finish() { write("summary.json", "{\"finished\": true, \"bodies\": 3}"); }
  /// What is said of curve.csv with this text, of which `pressure_MPa` is needed.
  std::string said_of_curve(const std::string &text) {
    write("curve.csv", text);
    Mistakes mistakes, notes;
    rows_ = RunFolder(folder_).curve({"pressure_MPa"}, mistakes, notes).rows();
    return mistakes.text() + notes.text();
  }
  static void expect_parts(const std::string &text, const std::vector<std::string> &parts) {
    for (const std::string &part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << part << " is not in: " << text;
  }

  std::size_t rows_ = 0;
};

const std::string kWhole = "stage,pressure_MPa\ncompression,1\nrelaxation,0\n";

TEST_F(ARunFolder, AWholeCurveIsReadWithoutAWord) {
  finish();
  EXPECT_EQ(said_of_curve(kWhole), "");
  EXPECT_EQ(rows_, 2u);
}

TEST_F(ARunFolder, EveryMistakeNamesTheFileAndWhatToDo) {
  finish();
  Mistakes mistakes;
  RunFolder(folder_).curve({}, mistakes, mistakes);
  RunFolder(folder_).object("electrode.json", mistakes);
  expect_parts(mistakes.text(), {"curve.csv: missing. What to do: give a folder made by",
                                 "electrode.json: missing. What to do:"});
  expect_parts(said_of_curve("stage,pressure_GPa\ncompression,1\n"),
               {"curve.csv: columns missing: pressure_MPa (there is 'pressure_GPa', of another "
                "unit). What to do: collect"});
  expect_parts(said_of_curve(kWhole + "relaxation"), {"line 4 is cut short", "What to do: run"});
  EXPECT_EQ(rows_, 0u);
  expect_parts(said_of_curve("stage,pressure_MPa\ncompression,1\nrelaxation,nan\n"),
               {"column pressure_MPa, row 2: not a number. What to do: see log.liggghts"});
  expect_parts(said_of_curve("stage,pressure_MPa\ncompression,1\n"), {"1 rows, at least 2"});
  EXPECT_EQ(rows_, 0u);
}

TEST_F(ARunFolder, TheLastRowOfARunThatGoesOnMayBeCut) {
  write("summary.json", "{\"finished\": false, \"stopped_because\": \"still running\"}");
  expect_parts(said_of_curve(kWhole + "relaxation"), {"line 4 is cut short", "is left out"});
  EXPECT_EQ(rows_, 2u);
  Mistakes mistakes;
  RunFolder(folder_).must_be_finished(mistakes);
  expect_parts(mistakes.text(), {"the run is not finished (still running). What to do: continue"});
}

TEST_F(ARunFolder, ACutSummaryIsNoFinishedRun) {
  write("summary.json", "{\"finished\": true");
  RunFolder run(folder_);
  EXPECT_TRUE(run.object("summary.json").is_null());
  EXPECT_EQ(run.unfinished(), "summary.json is cut or damaged");
  Mistakes mistakes;
  run.must_be_finished(mistakes);
  EXPECT_EQ(mistakes.count(), 1);
  EXPECT_EQ(run.number("bodies", mistakes), 0.0);
  EXPECT_EQ(mistakes.count(), 2);
}

// Mistakes of several files stay together file by file, in the order of their lines.
// Two releases of one run are no line between them.
TEST(Picked, ALineEndsWhereRowsAreLeftOut) {
  const Column of = picked({1.0, 2.0, 3.0, 4.0, 5.0}, {0, 1, 3, 4}, 10.0);
  ASSERT_EQ(of.size(), 5u);
  EXPECT_EQ(of[1], 20.0);
  EXPECT_TRUE(std::isnan(of[2]));
  EXPECT_EQ(of[3], 40.0);
}

TEST(MistakesOfFiles, AreListedFileByFile) {
  Mistakes one("a.toml", 1), all;
  one.add(0, "last.");
  one.add(7, "first.");
  one.add(8, "not listed.");
  all.add("b.csv", "missing", "make it");
  all.add(one);
  all.add("b.csv", "cut", "make it again");
  EXPECT_EQ(all.text(), "b.csv: missing. What to do: make it.\nb.csv: cut. What to do: make it "
                        "again.\na.toml:7: first.\na.toml: ... and 1 more\na.toml: last.");
  EXPECT_EQ(all.count(), 5);
  EXPECT_THROW(all.stop_if_any(kCheckFailed), Failure);
}

} // namespace
