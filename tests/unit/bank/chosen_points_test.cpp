// SPDX-License-Identifier: GPL-2.0-or-later
// Points of effects that a bank's file adds to those of its design.
#include "bank_file.h"
#include "base/messages.h"
#include "base/provenance.h"
#include <filesystem>

namespace {

using namespace calendem;
using namespace calendem_test;

/// A bank with these lines as its chosen points.
BankSpec with_chosen(const std::string &lines) {
  const std::string file =
      write_bank(kBank +
                 "effects = [\"friction\", \"thickness_zero\"]\nchosen_points = "
                 "\"chosen.csv\"\n" +
                 kParameters);
  write_file((std::filesystem::path(file).parent_path() / "chosen.csv").string(), lines);
  return read_bank_spec(file);
}

TEST(ChosenPoints, ComeLastBesideTheirBasePoints) {
  const std::string lines = "effect,base_point,value\nfriction,7,0.25\nfriction,4,0.1\n";
  const BankSpec spec = with_chosen(lines);
  EXPECT_EQ(write_chosen(spec.chosen), lines);
  const std::vector<BankPoint> points = bank_points(spec);
  ASSERT_EQ(points.size(), 8u + 4u + 2u);
  for (const auto &[place, base, value] : {std::tuple(12u, 7u, 0.25), std::tuple(13u, 4u, 0.1)}) {
    EXPECT_EQ(points[place].effect, "friction");
    EXPECT_EQ(points[place].value, value);
    EXPECT_EQ(points[place].base_point, int(base));
    EXPECT_EQ(points[place].base, points[base].base);
    EXPECT_EQ(points[place].packing, points[base].packing);
  }
  EXPECT_EQ(bank_runs(spec).size(), 2u * points.size());
}

// In the usual way only, last of all runs, whatever the numbers of the base points are.
TEST(ChosenPoints, AreRunAfterAllOthers) {
  BankSpec spec = with_chosen("effect,base_point,value\nfriction,4,0.1\n");
  spec.pressings = {{"", "", {}, {40.0}, 8, 8}};
  const std::vector<PressedPoint> runs = bank_runs(spec);
  ASSERT_EQ(runs.size(), 2u * 13 + 12); // 13 points; to 40 MPa those that were not chosen
  EXPECT_EQ(runs[runs.size() - 3].pressing.back().second, "40");
  EXPECT_EQ(runs.back().point.base_point, 4);
  EXPECT_EQ(runs.back().pressing.back().second, "150");
}

TEST(ChosenPoints, StandBesideNumberedBasePoints) {
  const std::string file =
      write_bank(kBank + "first_point = 100\nchosen_points = \"chosen.csv\"\n" +
                 "effects = [\"friction\"]\n" + kParameters);
  write_file((std::filesystem::path(file).parent_path() / "chosen.csv").string(),
             "# by hand\r\neffect,base_point,value\r\n\r\nfriction,105,0.1\r\n");
  const std::vector<BankPoint> points = bank_points(read_bank_spec(file));
  EXPECT_EQ(points.back().base_point, 105);
  EXPECT_EQ(points.back().base, points[5].base);
}

// What a table has of a bank is not run again; another bank's table is no table of it.
TEST(RunsBeside, AreThoseThatTheTableHasNot) {
  const BankSpec spec = with_chosen("effect,base_point,value\nfriction,4,0.1\n");
  const std::vector<PressedPoint> runs = bank_runs(spec);
  std::vector<BankRow> rows;
  for (std::size_t k = 0; k + 2 < runs.size(); ++k) {
    rows.push_back({runs[k].point, {}});
    rows.back().run.target = k % 2 ? 150.0 : 80.0;
  }
  const std::vector<PressedPoint> left = runs_beside(spec, runs, rows);
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].point.base_point, 4);
  EXPECT_EQ(left[0].point.effect, "friction");
  rows[3].point.base[0] *= 1.01;
  try {
    runs_beside(spec, runs, rows);
    FAIL();
  } catch (const Failure &e) {
    EXPECT_NE(std::string(e.what()).find("the base model beside base point 1 has other parameters"),
              std::string::npos)
        << e.what();
  }
}

TEST(ChosenPoints, MistakesAreReported) {
  const std::string head = "effect,base_point,value\n";
  for (const auto &[lines, part] : std::vector<std::pair<std::string, std::string>>{
           {"effect,value\nfriction,0.1\n", "column 'base_point' is missing"},
           {head + "friction,4\n", "chosen.csv:2: the row has another number of cells"},
           {head + "fric,4,0.1\n", "'fric' is no simulated effect of the bank"},
           {head + "thickness_zero,4,1\n", "no simulated effect"},
           {head + "pre_cracks,4,0.1\n", "no simulated effect"},
           {head + "friction,3,0.1\n",
            "beside the first 4; a chosen one stands beside one of 4 to 7"},
           {head + "friction,8,0.1\n", "beside one of 4 to 7"},
           {head + "friction,4.5,0.1\n", "beside one of 4 to 7"},
           {head + "friction,nan,0.1\n", "beside one of 4 to 7"},
           {head + "friction,4,0.7\n", "value is 0.7; friction goes from 0.05 to 0.6"},
           {head + "friction,4,\n", "value is nan"},
           {head + "\n# twice\nfriction,4,0.1\nfriction,4,0.2\n",
            "chosen.csv:5: friction has two points"}})
    try {
      with_chosen(lines);
      FAIL() << lines;
    } catch (const Failure &e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << part << "\nis not in\n"
                                                                     << e.what();
    }
  try {
    spec_of(kBank + "chosen_points = \"none.csv\"\n" + kParameters);
    FAIL();
  } catch (const Failure &e) {
    EXPECT_NE(std::string(e.what()).find("none.csv"), std::string::npos) << e.what();
  }
}

} // namespace
