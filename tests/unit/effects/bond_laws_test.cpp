// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement: the rows of laws of bond strength and the keywords of fix bond/bpm are the same,
// with the same numbers in the same ranges.
#include "base/registry.h"
#include "laws/bond_laws.h"
#include <algorithm>
#include <gtest/gtest.h>

namespace {

using namespace calendem;

TEST(BondLaws, RowsAreKeywordsOfTheFix) {
  std::size_t rows = 0;
  for (const Effect &e : effects()) {
    if (e.bond_law.empty())
      continue;
    ++rows;
    const auto &all = bond_strength_laws();
    const auto law = std::find_if(
        all.begin(), all.end(), [&](const BondStrengthLaw &k) { return e.bond_law == k.keyword; });
    ASSERT_NE(law, all.end()) << e.name;
    ASSERT_EQ(law->numbers.size(), e.settings.size()) << e.name;
    for (std::size_t k = 0; k < e.settings.size(); ++k) {
      EXPECT_EQ(script_units(e.settings[k].unit), 1.0) << e.settings[k].name;
      EXPECT_EQ(law->numbers[k].least, e.settings[k].low) << e.settings[k].name;
      EXPECT_EQ(law->numbers[k].most, e.settings[k].high) << e.settings[k].name;
    }
  }
  EXPECT_EQ(rows, bond_strength_laws().size());
}

} // namespace
