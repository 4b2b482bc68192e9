// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies whose fragments are known by hand.
#include "simulate/fracture.h"
#include <gtest/gtest.h>

namespace calendem {
namespace {

// Four primaries in a row; the middle bond breaks at 2 us, the last at 3 us.
BodyBonds chain() { return {1, 4, {{0, 1}, {1, 2, 2.0}, {2, 3, 3.0}}}; }
// Four in a square: one broken bond does not part it, two do.
BodyBonds ring(double first, double second) {
  return {2, 4, {{0, 1, first}, {1, 2}, {2, 3, second}, {3, 0}}};
}
BodyBonds single() { return {3, 1, {}}; }

TEST(Fracture, ChainComesApartBondByBond) {
  FractureState s = state_at(chain(), 1.9);
  EXPECT_EQ(s.broken, 0);
  EXPECT_EQ(s.fragments, 1);
  EXPECT_FALSE(s.apart());
  s = state_at(chain(), 2.0);
  EXPECT_EQ(s.broken, 1);
  EXPECT_EQ(s.fragments, 2);
  EXPECT_DOUBLE_EQ(s.largest, 0.5);
  EXPECT_EQ(s.parting, 1);
  s = state_at(chain(), 9.0);
  EXPECT_EQ(s.fragments, 3);
  EXPECT_DOUBLE_EQ(s.broken_fraction(), 2.0 / 3.0);
}

TEST(Fracture, RingNeedsTwo) {
  const FractureState one = state_at(ring(1.0, 5.0), 4.0);
  EXPECT_EQ(one.broken, 1);
  EXPECT_EQ(one.fragments, 1); // 25 % broken, whole
  EXPECT_EQ(one.parting, 0);
  EXPECT_FALSE(is_cracked(one));
  const FractureState two = state_at(ring(1.0, 5.0), 5.0);
  EXPECT_EQ(two.fragments, 2);
  EXPECT_EQ(two.parting, 2);
  EXPECT_TRUE(is_cracked(two));
  EXPECT_DOUBLE_EQ(cracked_since(ring(1.0, 5.0)), 5.0);
  EXPECT_DOUBLE_EQ(apart_since(chain()), 2.0);
  EXPECT_EQ(apart_since(ring(1.0, HUGE_VAL)), HUGE_VAL);
}

TEST(Fracture, APrimaryWithoutBondsIsWhole) {
  const FractureState s = state_at(single(), 1.0);
  EXPECT_EQ(s.fragments, 1);
  EXPECT_DOUBLE_EQ(s.largest, 1.0);
  EXPECT_DOUBLE_EQ(s.broken_fraction(), 0.0);
  EXPECT_FALSE(is_cracked(s));
}

// A long chain that loses an end: apart, but with 5 % of its bonds broken not cracked by 8 %.
TEST(Fracture, AChipIsNoCrack) {
  BodyBonds body{4, 21, {}};
  for (int i = 0; i < 20; ++i)
    body.bonds.push_back({i, i + 1});
  body.bonds.back().broken_us = 1.0;
  const FractureState s = state_at(body, 1.0);
  EXPECT_TRUE(s.apart());
  EXPECT_FALSE(is_cracked(s));
  EXPECT_FALSE(is_split(s)); // 20 of 21 together
}

TEST(Fracture, TableFollowsTheRun) {
  const std::string table = cracks_table(
      {chain(), ring(1.0, 5.0), single()},
      {{0.0, 0.0, "compression"}, {2.5, 40.0, "compression"}, {6.0, 20.0, "relaxation"}}, 1.6384);
  EXPECT_EQ(table, "time_us,stage,pressure_MPa,bodies_with_bonds,bodies_apart,bodies_cracked,"
                   "bodies_split,cracked_fraction,crack_surface_um2,parted_surface_um2\n"
                   "0.000000,compression,0,2,0,0,0,0.000000,0,0\n"
                   "2.500000,compression,40,2,1,1,1,0.500000,3.2768,1.6384\n"
                   "6.000000,relaxation,20,2,2,2,2,1.000000,6.5536,6.5536\n");
  // what breaks at the time of a row counts in it
  EXPECT_NE(cracks_table({ring(1.0, 5.0)}, {{5.0, 50.0, "compression"}}, 1.0)
                .find("\n5.000000,compression,50,1,1,1,1,1.000000,2,2\n"),
            std::string::npos);
}

// chain: 2 of 3 broken, apart. ring: 1 of 4 broken, whole: a false positive up to 20 %. The chip: 1
// of 20 broken, apart: at 5 % found, from 6 % a false negative. A body without bonds is not
// counted.
TEST(Fracture, ThresholdsAgainstConnectivity) {
  BodyBonds chip{4, 21, {}};
  for (int i = 0; i < 20; ++i)
    chip.bonds.push_back({i, i + 1});
  chip.bonds.back().broken_us = 1.0;
  const auto rows = test_thresholds({chain(), ring(1.0, 5.0), single(), chip}, 4.0);
  ASSERT_EQ(rows.size(), 16u);
  EXPECT_EQ(rows[0].percent, 5);
  EXPECT_EQ(rows[0].above_apart, 2);
  EXPECT_EQ(rows[0].above_whole, 1);
  EXPECT_EQ(rows[0].below_apart, 0);
  EXPECT_EQ(rows[1].above_apart, 1);
  EXPECT_EQ(rows[1].below_apart, 1);
  EXPECT_EQ(rows[15].percent, 20);
  EXPECT_EQ(rows[15].above_whole, 1);
  EXPECT_EQ(rows[15].below_whole, 0);
  EXPECT_EQ(rows[15].above_split, 1);
  EXPECT_NE(thresholds_table(rows).find("\n6,1,1,1,0,1,0,0.333333,0.666667\n"), std::string::npos);
}

} // namespace
} // namespace calendem
