// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/csv_table.h"

#include <cmath>

#include <gtest/gtest.h>

using calendem::CsvTable;

// Requirement: comments and empty lines are skipped, an empty cell is NaN, columns go by name.
TEST(CsvTable, ReadsColumnsByName) {
  const auto table = CsvTable::parse("# source\na,b,stage\r\n1, 2.5,compression\n\n,3e-1,x\n");
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_DOUBLE_EQ(table.numbers("b")[0], 2.5);
  EXPECT_DOUBLE_EQ(table.numbers("b")[1], 0.3);
  EXPECT_TRUE(std::isnan(table.numbers("a")[1]));
  EXPECT_EQ(table.texts("stage")[0], "compression");
  EXPECT_FALSE(table.has("c"));
  EXPECT_TRUE(table.numbers("c").empty());
}

TEST(CsvTable, NamesAColumnThatIsThereTwice) {
  EXPECT_EQ(CsvTable::parse("a,b,,\n1,2,,\n").ambiguous(), "");
  EXPECT_EQ(CsvTable::parse("t,a,t,b\n1,2,1,3\n").ambiguous({"a", "b"}), "");
  EXPECT_EQ(CsvTable::parse("a,b, a\n1,2,3\n").ambiguous(),
            "has two columns 'a'. Rename or remove one.");
}

// Requirement: a number followed by anything is no number (no unit slips through as a value).
TEST(CsvTable, NumberMustBeWhole) {
  EXPECT_TRUE(std::isnan(CsvTable::parse("a\n12MPa\n").numbers("a")[0]));
}

// Requirement: rows of another length than the header are reported by line and not kept.
TEST(CsvTable, NamesLinesOfWrongLength) {
  const auto table = CsvTable::parse("a,b\n1,2\n3\n4,5\n6,7,8");
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.bad_lines(), (std::vector<int>{3, 5}));
  EXPECT_EQ(table.last_line(), 5);
}
