// SPDX-License-Identifier: GPL-2.0-or-later
// A bank asked about itself.
#include "base/csv_table.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "diagnose/bank/bank_table.h"
#include "diagnose/bank_check.h"
#include "support/test_folder.h"
#include "support/with_all.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace calendem;

const std::string kShippedBank = CALENDEM_SOURCE_DIR "/input_scripts/cases/bank/bank.toml";

/// Takes the shipped bank's first 48 base points, three to a packing, and its first 16 runs of
/// friction, one to a packing, those of packings 1 to `packings`.
BankCheckOptions part_of_shipped(int packings, const std::filesystem::path &folder) {
  BankTable table = read_bank_table(read_bank_spec(kShippedBank),
                                    CALENDEM_SOURCE_DIR "/input_scripts/cases/bank/bank.csv");
  table.rows.erase(std::remove_if(table.rows.begin(), table.rows.end(),
                                  [&](const BankRow &row) {
                                    const bool on = !row.point.effect.empty();
                                    return row.point.packing > packings ||
                                           row.point.base_point >= (on ? 16 : 48) ||
                                           (on && row.point.effect != "friction");
                                  }),
                   table.rows.end());
  const BankCheckOptions o = {kShippedBank, (folder / "part.csv").string(),
                              (folder / "one").string()};
  write_file(o.table, write_bank_table(table));
  return o;
}

// Seven packings with three base points and one run of friction each; friction is what shows most
// in a bank. Strong enough to be distinguished from none it is the most probable, or something
// unknown is that acts like it; at three times that strength it is the most probable.
TEST(BankCheck, EveryPackingIsLeftOutOnce) {
  CALENDEM_RUNS_WITH_ALL();
  const auto folder = calendem_test::test_folder();
  BankCheckOptions o = part_of_shipped(7, folder);
  check_bank(o);
  const CsvTable t = CsvTable::parse(text_of_file(o.folder + "/diagnoses.csv"));
  ASSERT_EQ(t.rows(), 21u + 2u * 7u);
  const auto effect = t.texts("effect"), first = t.texts("most_probable");
  const auto left_out = t.numbers("left_out"), amplitude = t.numbers("amplitude"),
             limit = t.numbers("limit_against_none"), truths = t.numbers("truths_probability"),
             unknowns = t.numbers("unknowns_probability");
  int strong = 0;
  for (std::size_t k = 0; k < t.rows(); ++k) {
    if (left_out[k] == 1.0) {
      EXPECT_EQ(truths[k], unknowns[k]);
      EXPECT_NE(first[k], "friction");
    } else if (effect[k] == "friction" && amplitude[k] >= limit[k]) {
      ++strong;
      EXPECT_TRUE(first[k] == "friction" ||
                  (first[k] == "unknown" && amplitude[k] < 3.0 * limit[k]))
          << first[k] << " instead of a friction of " << amplitude[k];
    }
  }
  EXPECT_GE(strong, 5);
  // Killed after two packings it goes on with the third; a table of another bank is not taken.
  const std::string whole = text_of_file(o.folder + "/diagnoses.csv");
  std::size_t end = 0; // of the first two packings' rows: five each, two lines of head
  for (int line = 0; line < 12; ++line)
    end = whole.find('\n', end) + 1;
  const std::string marked = whole.substr(0, end).replace(whole.find(",1,0,"), 5, ",1,0,7"),
                    shared = (folder / "two").string();
  o.folder = shared;
  o.jobs = 2;
  std::filesystem::create_directories(o.folder);
  write_file(o.folder + "/diagnoses.csv", marked);
  testing::internal::CaptureStdout();
  check_bank(o);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("2 of 7 are in"), std::string::npos);
  EXPECT_EQ(text_of_file(o.folder + "/diagnoses.csv"), marked + whole.substr(end));
}

// Nothing is left out: one sample of the base model in each draw, two diagnoses of every effect's
// (friction, and two faults of measurements that no bank needs runs of). The larger the sample,
// the less packings scatter, the smaller what can be seen.
TEST(BankCheck, DrawnSamplesAreWhatTheBankPredicts) {
  const auto folder = calendem_test::test_folder();
  BankCheckOptions o = part_of_shipped(7, folder);
  o.draws = 2;
  check_bank(o);
  const CsvTable one = CsvTable::parse(text_of_file(o.folder + "/diagnoses.csv"));
  ASSERT_EQ(one.rows(), 2u * 7u);
  const auto effect = one.texts("effect");
  const auto left_out = one.numbers("left_out"), amplitude = one.numbers("amplitude");
  for (std::size_t k = 0; k < one.rows(); ++k) {
    const std::size_t draw = k / 7 + 1;
    EXPECT_EQ(one.numbers("packing")[k], double(draw));
    EXPECT_EQ(effect[k].empty(), k % 7 == 0);
    EXPECT_EQ(left_out[k], k % 7 != 0 && k % 7 % 2 == 0 ? 1.0 : 0.0);
    if (left_out[k] == 1.0) {
      EXPECT_EQ(effect[k], effect[k - 1]);
      EXPECT_EQ(amplitude[k], amplitude[k - 1]);
    }
  }
  EXPECT_NE(amplitude[1], amplitude[8]);
  o.folder = (folder / "two").string();
  o.jobs = 2;
  check_bank(o);
  EXPECT_EQ(text_of_file(o.folder + "/diagnoses.csv"),
            text_of_file((folder / "one/diagnoses.csv").string()));
  if (!calendem_test::with_all(1, 0))
    return;
  o.draws = 1;
  const auto drawn_of = [&](double cells) { // of its rows
    o.cells = cells;
    check_bank(o);
    return CsvTable::parse(text_of_file(o.folder + "/diagnoses.csv"));
  };
  const CsvTable large = drawn_of(100.0), small = drawn_of(0.02); // its packings dominate
  ASSERT_EQ(large.rows(), 7u);
  for (std::size_t k = 0; k < large.rows(); ++k)
    if (effect[k] == "thickness_zero") // the others' are below their priors in both
      EXPECT_LT(large.numbers("limit_against_none")[k], small.numbers("limit_against_none")[k]);
}

void expect_refused(const BankCheckOptions &o, const std::string &text) {
  try {
    check_bank(o);
    FAIL();
  } catch (const Failure &f) {
    EXPECT_EQ(f.exit_status(), kBadInput);
    EXPECT_NE(std::string(f.what()).find(text), std::string::npos) << f.what();
  }
}

TEST(BankCheck, TwoPackingsAreTooFew) {
  const auto folder = calendem_test::test_folder();
  expect_refused(part_of_shipped(2, folder), "has 2 packings");
}

// Each writes the whole table: of two at a time one would lose its rows.
TEST(BankCheck, TwoAtATimeNeedTwoFolders) {
  const auto folder = calendem_test::test_folder();
  const BankCheckOptions o = part_of_shipped(7, folder);
  std::filesystem::create_directories(o.folder);
  const FolderLock other(o.folder);
  expect_refused(o, "another run is writing");
}

// One of two nulls is claimed; of three effects two are above their limit and one of these is named
// first; of the two claimed one is right.
TEST(BankCheck, TheSummaryCounts) {
  std::vector<CheckedDiagnosis> cases(5);
  for (int k = 0; k < 5; ++k) {
    cases[std::size_t(k)].packing = k;
    cases[std::size_t(k)].claim = cases[std::size_t(k)].most_probable = "none";
  }
  cases[1].claim = "friction";
  for (int k = 2; k < 5; ++k) {
    cases[std::size_t(k)].effect = "pre_cracks";
    cases[std::size_t(k)].limit = 0.5;
    cases[std::size_t(k)].amplitude = k == 4 ? -0.4 : -0.6; // beyond the limit either way
    cases[std::size_t(k)].of_truth = std::exp(-1.0);
  }
  cases[2].claim = cases[2].most_probable = "pre_cracks";
  cases[3].claim = "friction";
  for (int k = 0; k < 5; ++k)
    cases[std::size_t(k)].held = {true, k == 2 || k == 3};
  const std::vector<std::string> lines = summary_of(cases);
  ASSERT_EQ(lines.size(), 6u);
  const auto has = [&](int line, const std::string &part) {
    EXPECT_NE(lines[std::size_t(line)].find(part), std::string::npos) << lines[std::size_t(line)];
  };
  has(0, "2 samples of the base model: claimed to be none 0.50");
  has(0, "to have an effect 0.50");
  has(1, "3 samples with an effect, 2 above its limit: of these named first 0.50");
  has(2, "effects claimed in 2 of them: right 0.50");
  has(2, "probability 1.00");
  has(3, "claimed to be unknown not known");
  has(5, "90 % intervals of base parameters hold 0.70");
  has(5, "where an effect is claimed 0.83");
  EXPECT_EQ(diagnoses_in(table_of(cases))[2].held, cases[2].held);
  EXPECT_EQ(diagnoses_in(table_of(cases))[4].held, cases[4].held);
}

} // namespace
