// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/csv_table.h"
#include "base/plain_text.h"

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

const char *const kPoints = "d_um,p_MPa,stage\n0.5,1200.25,loading\n1.25,0.02,loading\n";

void expect_same(const std::string &bytes, const std::string &guess) {
  const CsvTable right = CsvTable::parse(kPoints), table = CsvTable::parse(bytes);
  EXPECT_EQ(table.header(), right.header()) << bytes;
  EXPECT_EQ(table.ambiguous(), "");
  EXPECT_TRUE(table.bad_lines().empty());
  for (const char *column : {"d_um", "p_MPa"})
    EXPECT_EQ(table.numbers(column), right.numbers(column)) << bytes;
  EXPECT_EQ(table.texts("stage"), right.texts("stage"));
  EXPECT_EQ(table.guess(), guess);
}

std::string utf16(const std::string &text, bool big) {
  std::string out;
  for (const char c : text)
    out += big ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

std::string with(std::string text, const std::string &what, const std::string &other) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += other.size())
    text.replace(at, what.size(), other);
  return text;
}

// Requirement: what spreadsheets and presses write is read as the same numbers, and the guess said.
TEST(CsvTable, ReadsWhatOtherProgramsWrite) {
  const std::string points = kPoints,
                    german = "d_um;p_MPa;stage\n0,5;1.200,25;loading\n1,25;0,02;loading\n";
  expect_same(points, "");
  expect_same("\xEF\xBB\xBF" + with(points, "\n", "\r\n"), "");
  expect_same(with(points, "\n", "\r"), "");
  expect_same(with(points, ",", "\t"), "tabs between columns, decimal points");
  expect_same(with(points, ",", ";"), "semicolons between columns, decimal points");
  expect_same(german, "semicolons between columns, decimal commas");
  expect_same(with(german, "1.200,25", "1 200,25"), "semicolons between columns, decimal commas");
  expect_same("\"d_um\",\"p_MPa\",\"stage\"\n\"0,5\",\"1200,25\",\"loading\"\n"
              "\"1,25\",\"0,02\",\"loading\"\n",
              "decimal commas");
  for (const bool big : {false, true}) {
    expect_same((big ? "\xFE\xFF" : "\xFF\xFE") + utf16(points, big), "UTF-16");
    expect_same(utf16(points, big), "UTF-16");
  }
  EXPECT_EQ(CsvTable::parse("a,b\n\"x, \"\"y\"\"\nz\",2\n").texts("a")[0], "x, \"y\"\nz");
  EXPECT_EQ(CsvTable::parse("Kraft (\xB5N);b\n1,5;2\n").header()[0], "Kraft (\xC2\xB5N)");
}

// Requirement: a file that can be read in two ways is refused with both readings.
TEST(CsvTable, NamesBothReadings) {
  const auto said = [](const std::string &text) { return CsvTable::parse(text).ambiguous(); };
  EXPECT_NE(said("a;b\n1,234;2\n12,500;3\n").find("'1,234' is 1.234 or 1234"), std::string::npos);
  EXPECT_NE(said("a\tb\n1.234\t2\n").find("'1.234' is 1.234 or 1234"), std::string::npos);
  EXPECT_NE(said("a;b\n1,5;2\n2.5;3\n").find("points ('2.5') and with decimal commas ('1,5')"),
            std::string::npos);
  EXPECT_EQ(said("a;b\n1,234;2\n0,500;3\n"), ""); // no group begins with 0
  EXPECT_EQ(said("a,b\n1.234,2\n"), "");
  EXPECT_EQ(CsvTable::parse("a;b\n1,234;0,5\n1,23;4\n").numbers("a")[0], 1.234);
  EXPECT_EQ(CsvTable::parse_export("1;1,234\n2;1,235\n", ',').numbers("2")[0], 1.234);
  EXPECT_TRUE(std::isnan(CsvTable::parse("a;b\n1.23,4;0,5\n").numbers("a")[0]));
}

// Requirement: bytes that are no text are named and not shown.
TEST(CsvTable, NamesWhatIsNoText) {
  EXPECT_NE(CsvTable::parse("\x1f\x8b\x08 ...").ambiguous().find("gzip"), std::string::npos);
  EXPECT_NE(CsvTable::parse("PK\3\4").ambiguous().find(".xlsx"), std::string::npos);
  EXPECT_NE(CsvTable::parse("a,b\n1,\2\n").ambiguous().find("is no text"), std::string::npos);
}

// Requirement: lines above the header and units below it are those of a press's program.
TEST(CsvTable, ReadsExports) {
  const auto table = CsvTable::parse_export("Prüfer: Müller\n\n\"Zeit\";\"Kraft\"\n\"s\";\"kN\"\n"
                                            "0,5;1,25\n1;0,5\n");
  EXPECT_EQ(table.header(), (std::vector<std::string>{"Zeit [s]", "Kraft [kN]"}));
  EXPECT_EQ(table.numbers("Kraft [kN]"), (std::vector<double>{1.25, 0.5}));
  EXPECT_EQ(CsvTable::parse_export("1,2\n3,4\n").header(), (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(CsvTable::parse_export("force_N,x\n3,4\n").header()[0], "force_N");
}
