// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/csv_table.h"
#include "press/press_curve.h"
#include "support/refusal.h"
#include "support/test_folder.h"
#include <cmath>
#include <fmt/format.h>
#include <fstream>

namespace {
using namespace calendem;
using namespace calendem_test;

constexpr double kArea = 100.0; // mm2, so that 100 N are 1 MPa

std::string written(const std::string &text) {
  const std::string file = (test_folder() / "raw.csv").string();
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

PressExport read(const std::string &text, PressFormat format = {}) {
  if (format.area_mm2 == 0.0 && format.columns.count("pressure") == 0)
    format.area_mm2 = kArea;
  return read_press_export(written(text), format);
}

std::string said(const std::string &text, const PressFormat &format = {}) {
  return refusal([&] { read(text, format); });
}

/// Approach, then as many cycles to 10 MPa: the film gives way by 1 um per MPa, springs back by half.
std::string cycles(int n, double machine = 0.0) {
  std::string out = "time_s,force_N,position_mm\n";
  int row = 0;
  double place = 12.5;
  const auto add = [&](double p, double um) {
    out += fmt::format("{},{},{}\n", 0.5 * row++, p * kArea, place - 1e-3 * (um + machine * p));
  };
  for (int k = 0; k < 5; ++k)
    add(0.0, k - 5.0);
  for (int c = 0; c < n; ++c) {
    for (int k = 0; k <= 20; ++k)
      add(0.5 * k, 0.5 * k);
    for (int k = 19; k >= 0; --k)
      add(0.5 * k, 5.0 + 0.25 * k);
  }
  add(0.0, -20.0);
  add(0.0, -30.0);
  return out;
}

PressCurve curve_of(const std::string &text, double contact = 0.2) {
  return make_press_curve("raw.csv", read(text), contact);
}

// Requirement: the same readings under the names, units and separators of three languages.
TEST(Press, KnowsColumnsAndUnitsOfThreeLanguages) {
  const PressExport right = read("time_s,force_N,displacement_um\n0,100,1\n1,200,3\n2,300,4\n");
  EXPECT_EQ(right.pressure, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(right.displacement, (std::vector<double>{1.0, 3.0, 4.0}));
  for (const char *text :
       {"Probe 7; Pr\xFC"
        "fer M\xFCller\n\nPr\xFC"
        "fzeit;Standardkraft;Traversenweg\ns;kN;mm\n0,0;0,1;0,001\n1,0;0,2;0,003\n2,0;0,3;0,004\n",
        "Temps (s)\tForce / N\tDéplacement (mm)\n0\t100\t0.001\n1\t200\t0.003\n2\t300\t0.004\n",
        "\"Weg [µm]\",\"Druckkraft [N]\",\"Zeit [min]\"\n\"1\",\"100,0\",\"0\"\n"
        "\"3\",\"200,0\",\"0,01666666666667\"\n\"4\",\"300,0\",\"0,03333333333333\"\n"}) {
    const PressExport export_ = read(text);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(export_.pressure[k], right.pressure[k], 1e-9) << text;
      EXPECT_NEAR(export_.displacement[k], right.displacement[k], 1e-9) << text;
      EXPECT_NEAR(export_.time[k], right.time[k], 1e-9) << text;
    }
  }
  PressFormat format;
  format.columns = {{"pressure", "2:kPa"}, {"displacement", "3:um"}};
  EXPECT_EQ(read("0;1000;1\n1;2000;3\n2;3000;4\n", format).pressure, right.pressure);
}

// Requirement: the disc's size turns a force into a pressure; a column of pressure needs none.
TEST(Press, AColumnOfPressureIsTakenBesideTheDiscsSizeToo) {
  const std::vector<double> right = {1.0, 2.0, 3.0};
  PressFormat format;
  format.area_mm2 = kArea;
  EXPECT_EQ(read("displacement_um,pressure_MPa\n0,1\n1,2\n2,3\n", format).pressure, right);
  EXPECT_EQ(
      read("um,pressure_MPa,force_N,weg_um\n0,5,100,1\n0,6,200,2\n0,7,300,3\n", format).pressure,
      right);
  EXPECT_EQ(read("weg_um,Spannung [V],Kraft [N]\n0,5,100\n1,5,200\n2,5,300\n", format).pressure,
            right);
}

TEST(Press, NamesOfStagesAreThoseOfThreeLanguages) {
  const PressExport e = read("force_N,weg_um,Phase\n1,1,Belastung\n2,2,maintien\n1,1,Entlastung\n"
                             "0,0,décharge\n");
  EXPECT_EQ(e.stage, (std::vector<std::string>{"loading", "dwell", "unloading", "unloading"}));
  EXPECT_TRUE(read("force_N,weg_um,Step\n1,1,1\n2,2,1\n1,1,2\n").stage.empty());
}

TEST(Press, RefusesWhatCanBeReadInTwoWays) {
  const std::string rows = "\n1,1,1\n2,2,2\n3,3,3\n";
  expect_parts(said("force_N,position_mm,extension_mm" + rows),
               {"'position_mm' and 'extension_mm'", "--displacement", "3 'extension_mm'"});
  expect_parts(said("force,position_mm,x" + rows), {"'force' has no unit", "--force \"force:N\""});
  expect_parts(said("a,b,c" + rows),
               {"no column looks like the force", "1 'a', 2 'b'", "--force", "(2:N)"});
  expect_parts(said("force_N,weg_um\n1,1\n2,2\n"), {"it has 2 rows below its header"});
  PressFormat format;
  format.columns = {{"force", "last:N"}};
  expect_parts(said("a,b,c" + rows, format), {"no column 'last' for --force"});
  expect_parts(said("force_N;weg_um\n1,234;1\n1,235;2\n1,236;3\n"), {"1.234 or 1234", "--decimal"});
  format = {{}, kArea, ','};
  EXPECT_NEAR(read("force_N;weg_um\n1,234;1\n1,235;2\n1,236;3\n", format).pressure[0], 0.01234,
              1e-12);
  expect_parts(said("force_N,weg_um\n1,1\n2,x\n3,3\n"), {"line 3", "'x'"});
  expect_parts(said("\x1f\x8b\x08"), {"gzip"});
}

// Requirement: contact, turns and the end are where they were put; a noisy reading is no contact.
TEST(Press, FindsContactTurnsAndEnd) {
  const PressCurve c = curve_of(cycles(2));
  EXPECT_EQ(c.contact, 6u);
  EXPECT_NEAR(c.pressure.front(), 0.5, 1e-12);
  EXPECT_EQ(c.displacement.front(), 0.0);
  EXPECT_NEAR(c.highest(), 10.0, 1e-12);
  EXPECT_NEAR(c.displacement[19], 9.5, 1e-9);
  EXPECT_EQ(c.cycle.back(), 2);
  for (std::size_t k = 0; k < c.stage.size(); ++k)
    EXPECT_EQ(c.stage[k], k <= 19 || (k >= 40 && k <= 60) ? "loading" : "unloading") << k;
  EXPECT_EQ(c.pressure.back(), 0.0); // one row without contact, no more
  EXPECT_NEAR(c.displacement.back(), 4.5, 1e-9);
  std::string noisy = cycles(1);
  noisy.insert(noisy.find('\n') + 1, "0,100,12.6\n");
  EXPECT_EQ(curve_of(noisy).contact, 7u);
  expect_parts(refusal([&] { curve_of(cycles(1), 11.0); }), {"never stays above 11 MPa", "is 10"});
}

// Requirement: a pressure that falls while the platen goes on is the film's, no turn.
TEST(Press, AFilmThatGivesWayIsNoTurn) {
  std::string rows = "force_N,weg_um\n";
  for (const auto &[p, d] : {std::pair(1, 0), {5, 4}, {8, 6}, {6, 7}, {10, 9}, {4, 8}, {0, 7}})
    rows += fmt::format("{},{}\n", p * kArea, d);
  const PressCurve c = curve_of(rows);
  EXPECT_EQ(c.cycle.back(), 1);
  EXPECT_EQ(c.stage[3], "loading");
  EXPECT_EQ(c.stage[5], "unloading");
}

// Requirement: what the press gives way in a blank run is taken off, and no more.
TEST(Press, TakesOffTheMachine) {
  PressCurve with = curve_of(cycles(1, 0.3));
  const PressCurve without = curve_of(cycles(1));
  const auto blank = [](int rows) {
    std::string text = "force_N,position_mm\n";
    for (int k = 0; k <= rows; ++k)
      text += fmt::format("{},{}\n", 50.0 * k, 3.0 - 1e-3 * 0.3 * 0.5 * k);
    return curve_of(text);
  };
  subtract_machine(with, blank(24));
  for (std::size_t k = 0; k < with.displacement.size(); ++k)
    EXPECT_NEAR(with.displacement[k], without.displacement[k], 1e-9) << k;
  PressCurve stiff = curve_of(cycles(1));
  EXPECT_NEAR(stiff.displacement_at(5.25), 4.75, 1e-9);
  expect_parts(refusal([&] { subtract_machine(stiff, blank(15)); }),
               {"blank run ends at", "Press the blank as far"});
}

// Requirement: what is written is read by the reader of experiments' curves.
TEST(Press, WritesACurve) {
  const PressCurve c = curve_of(cycles(2));
  const CsvTable t = CsvTable::parse(curve_table(c, "# [press]\n# specimen = \"1\"\n"));
  EXPECT_EQ(t.header(), (std::vector<std::string>{"displacement_um", "pressure_MPa", "stage",
                                                  "cycle", "time_s"}));
  EXPECT_EQ(t.rows(), c.pressure.size());
  EXPECT_NEAR(t.numbers("pressure_MPa")[19], 10.0, 1e-12);
  const std::string page = press_page("raw.csv", read(cycles(2)), c);
  expect_parts(page, {"2 cycles", "unloading", "</html>"});
}

} // namespace
