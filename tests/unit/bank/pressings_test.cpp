// SPDX-License-Identifier: GPL-2.0-or-later
#include "bank_file.h"
#include "base/messages.h"
#include "base/provenance.h"
#include <cmath>
#include <map>

namespace {

using namespace calendem;
using namespace calendem_test;

// The first points to a further pressure, and pressed in another way; the full cell to all pressures
// of the usual way. The table reads back with its ways of pressing.
TEST(BankPressings, SomePointsArePressedFurtherOrInAnotherWay) {
  const BankSpec spec =
      spec_of(kBank + "effects = [\"friction\"]\n" + kParameters +
              "[full_cell]\nrecipe = \"electrode.toml\"\ncase = \"case.toml\"\npoints = 2\n"
              "[[pressing]]\npressures_MPa = [40]\nbase_points = 6\neffect_points = 3\n"
              "[[pressing]]\nname = \"again\"\nwhat = \"pressed twice\"\npressures_MPa = [80]\n"
              "base_points = 5\neffect_points = 2\nsettings = { \"platen.presses\" = 2 }\n");
  const std::vector<PressedPoint> runs = bank_runs(spec);
  const Study study = pressed_study(spec, runs);
  ASSERT_EQ(study.runs.size(), 2u * 12 + 9 + 7);
  BankTable table = {spec, {}};
  std::map<std::pair<std::string, double>, int> count;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Settings &s = study.runs[k].settings;
    const double target = s.number("platen.max_pressure_MPa");
    ++count[{runs[k].name, target}];
    EXPECT_EQ(s.number("platen.presses"), runs[k].name == "again" ? 2.0 : 1.0);
    table.rows.push_back({runs[k].point, {}});
    table.rows.back().run.target = target;
    table.rows.back().run.pressing = runs[k].name;
    table.rows.back().run.pressure_left = runs[k].name == "again" ? 0.9 : NAN;
  }
  EXPECT_EQ(count,
            (std::map<std::pair<std::string, double>, int>{
                {{"", 40.0}, 9}, {{"", 80.0}, 12}, {{"", 150.0}, 12}, {{"again", 80.0}, 7}}));
  EXPECT_EQ(full_cell_runs(spec).size(), 2u * 3u);
  const std::string file = spec.file + ".csv";
  write_file(file, write_bank_table(table));
  const BankTable read = read_bank_table(spec, file);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    EXPECT_EQ(read.rows[k].run.pressing, runs[k].name);
    EXPECT_EQ(std::isfinite(read.rows[k].run.pressure_left), runs[k].name == "again");
  }
  BankSpec other = spec;
  other.pressings.pop_back();
  try {
    read_bank_table(other, file);
    FAIL();
  } catch (const Failure &e) {
    EXPECT_NE(std::string(e.what()).find("pressing 'again' is no [[pressing]] of"),
              std::string::npos);
  }
}

TEST(BankPressings, MistakesAreReported) {
  const std::string some = "pressures_MPa = [80]\nbase_points = 5\neffect_points = 2\n";
  const auto way = [&](const std::string &name, const std::string &settings) {
    return "[[pressing]]\nname = \"" + name + "\"\nwhat = \"in words\"\nsettings = " + settings +
           "\n" + some;
  };
  const std::string twice = "{ \"platen.presses\" = 2 }";
  for (const auto &[text, part] : std::vector<std::pair<std::string, std::string>>{
           {"[[pressing]]\nname = \"again\"\n" + some, "a way of pressing has a 'name', 'what'"},
           {way("a", "{ platen.presses = 2 }"), "Write the whole key in quotes"},
           {way("a", "2"), "write settings as"},
           {way("a", "{ \"platen.press\" = 2 }"), "platen.press"},
           {way("a", "{ \"platen.max_pressure_MPa\" = 2 }"), "is set by a pressure"},
           {way("a", "{ \"bond.tensile_strength_MPa\" = 2 }"), "is set by a pressure"},
           {way("a, b", twice), "letters, digits and _ only"},
           {way("pressing", twice), "is not 'pressing'"},
           {way("a", twice) + way("b", twice), "two ways of pressing"},
           {"[[pressing]]\n" + some, "80 MPa is there already"},
           {"[[pressing]]\npressures_MPa = [0]\nbase_points = 99\n", "base_points is 99"}})
    try {
      spec_of(std::string(kBank).append(kParameters).append(text));
      FAIL() << text;
    } catch (const Failure &e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << part << "\nis not in\n"
                                                                     << e.what();
    }
}

} // namespace
