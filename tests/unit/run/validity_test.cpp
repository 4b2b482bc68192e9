// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/collect.h"
#include "support/test_folder.h"
#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace calendem {
namespace {

const MeanSphere kSphere = {1.5, 4.0};

/// Two kinds of contact have contacts; 250 MPa.
RawRow pressed() {
  RawRow r = {};
  r.stage = 1.0;
  r.gap = 50.0;
  r.speed = 2.0;
  r.p_top = 250.0;
  r.kinetic = 3.0;
  r.strain = 20.0;
  r.contact_elastic = 40.0;
  r.ranges[kAmCbd] = {6.0, 30.0, 0.25, 0.67, {6.0, 4.0, 2.0, 4.0}, {30.0, 24.0, 15.0, 24.0}};
  r.ranges[kCbdCbd] = {2.0, 10.0, 0.05, 0.06, {}, {}};
  r.ranges[kInsideBodies] = {100.0, 1e5, 0.01, 0.7, {1.0, 1.0, 1.0, 1.0}, {1e4, 1e4, 1e4, 1e4}};
  return r;
}

std::vector<std::string> cells_of(const std::string &text) {
  std::vector<std::string> cells;
  std::istringstream in(text.substr(1)); // begins with a comma
  for (std::string cell; std::getline(in, cell, ',');)
    cells.push_back(cell);
  return cells;
}

TEST(Validity, ColumnsByHand) {
  const std::vector<std::string> names = cells_of(validity_columns()),
                                 cells = cells_of(validity_cells(pressed(), kSphere));
  ASSERT_EQ(names.size(), cells.size());
  const auto cell = [&](const std::string &name) {
    const auto at = std::find(names.begin(), names.end(), name);
    EXPECT_NE(at, names.end()) << name;
    return at == names.end() ? "" : cells[at - names.begin()];
  };
  EXPECT_EQ(cell("inertial_number"), "0.00024");
  EXPECT_EQ(cell("kinetic_to_elastic"), "0.05");
  EXPECT_EQ(cell("contacts_beyond_0.1_R"), "0.75");
  EXPECT_EQ(cell("contacts_beyond_0.2_R"), "0.5");
  EXPECT_EQ(cell("force_beyond_0.2_R"), "0.6");
  EXPECT_EQ(cell("force_beyond_0.3_R"), "0.375");
  EXPECT_EQ(cell("force_beyond_law"), "0.6");
  EXPECT_EQ(cell("am_cbd_overlap_mean"), "0.25");
  EXPECT_EQ(cell("am_cbd_overlap_largest"), "0.67");
  EXPECT_EQ(cell("am_cbd_force_beyond_0.2_R"), "0.8");
  EXPECT_EQ(cell("cbd_cbd_overlap_mean"), "0.05");
  EXPECT_EQ(cell("wall_contacts_beyond_0.2_R"), "0"); // there is no contact
}

TEST(Validity, SummaryAtMaximumPressureAndAlongTheRun) {
  RawRow before = pressed(), release = pressed(), soft = pressed();
  before.p_top = 10.0; // a fifth of its pressure's root: five times the inertial number
  before.kinetic = 12.0;
  before.ranges[kCbdCbd].largest = 0.9;
  soft.p_top = 4.0; // below 5 MPa: not looked at
  release.stage = 3.0;
  release.p_top = 10.0;
  release.speed = 8.0;
  release.kinetic = 60.0;
  const std::vector<RawRow> rows = {soft, before, pressed(), release};
  const nlohmann::json i = inertia(rows, rows[2], kSphere);
  EXPECT_DOUBLE_EQ(i["inertial_number_at_max_pressure"], 2.4e-4);
  EXPECT_DOUBLE_EQ(i["inertial_number_max_above_5_MPa"], 1.2e-3);
  EXPECT_DOUBLE_EQ(i["kinetic_to_elastic_at_max_pressure"], 0.05);
  EXPECT_DOUBLE_EQ(i["kinetic_to_elastic_max_above_5_MPa"], 0.2);
  const nlohmann::json range = contact_range(rows, rows[2]), &top = range["at_max_pressure"];
  EXPECT_EQ(top["all"]["contacts"], 8);
  EXPECT_DOUBLE_EQ(top["all"]["overlap_mean"], 0.2);
  EXPECT_DOUBLE_EQ(top["all"]["overlap_largest"], 0.67);
  EXPECT_DOUBLE_EQ(top["am_cbd"]["force_nN"], 30.0);
  EXPECT_DOUBLE_EQ(top["inside_bodies"]["force_beyond_0.2_R"], 0.1);
  EXPECT_DOUBLE_EQ(top["am_cbd"]["contacts_beyond_0.3_R"], 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(top["am_am"]["force_beyond_0.1_R"], 0.0);
  EXPECT_DOUBLE_EQ(range["largest_of_any_row"]["all"]["overlap_largest"], 0.9);
  EXPECT_DOUBLE_EQ(range["largest_of_any_row"]["am_cbd"]["overlap_largest"], 0.67);
}

TEST(Validity, WarnsInOneLineWithItsNumbers) {
  RawRow r = pressed();
  const std::string said = range_warning(contact_range({r}, r));
  EXPECT_NE(said.find("60 % of the contact force is carried by overlaps beyond the range"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("0.67"), std::string::npos) << said;
  r.ranges[kAmCbd].force_beyond[kRangeLimits - 1] = 4.0; // 10 %: not more than it
  EXPECT_EQ(range_warning(contact_range({r}, r)), "");
}

// A row is read as it was written, all of its columns in their order; a cut one is left out.
TEST(Validity, RawRowsInTheOrderOfTheirColumns) {
  const std::string file = (calendem_test::test_folder() / "curve_raw.csv").string();
  constexpr int kColumns = kRawColumns;
  std::ofstream out(file);
  out << "header\n";
  for (int row = 0; row < 2; ++row)
    for (int c = 0; c < (row == 0 ? kColumns : kColumns - 1); ++c)
      out << (c > 0 ? "," : "") << 100 * (row + 1) + c << (c == kColumns - 1 ? "\n" : "");
  out << "\n";
  out.close();
  const std::vector<RawRow> rows = read_raw(file);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].step, 100);
  EXPECT_EQ(rows[0].friction, 121);
  EXPECT_EQ(rows[0].speed, 122);
  EXPECT_EQ(rows[0].ranges[kWallContacts].contacts, 123);
  EXPECT_EQ(rows[0].ranges[kInsideBodies].contacts, 135);
  EXPECT_EQ(rows[0].ranges[kAmAm].mean, 149);
  EXPECT_EQ(rows[0].ranges[kCbdCbd].force_beyond[2], 181);
}

// A resumed run writes some steps again; its last row may be on its way to the disk.
TEST(Validity, OfEqualStepsTheLastCounts) {
  const std::string file = (calendem_test::test_folder() / "raw.csv").string();
  std::ofstream(file) << "step,value\n10,1\n20,2\n20,-3e-1\n30\n40,x\n50,5";
  const std::map<long, std::vector<double>> expected = {{10, {10, 1}}, {20, {20, -0.3}}};
  EXPECT_EQ(rows_by_step(file, 2), expected);
  EXPECT_TRUE(rows_by_step(file + ".missing", 2).empty());
}

} // namespace
} // namespace calendem
