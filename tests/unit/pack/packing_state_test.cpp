// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/packing_state.h"
#include "support.h"

namespace {
using namespace calendem;
using calendem_test::cell;

Particle primary(int tag, int body, const Eigen::Vector3d &x) {
  return {tag, 1, 1.59, 1.0, x, body};
}
Particle cbd(int tag, const Eigen::Vector3d &x) { return {tag, 2, 1.316, 1.0, x, 0}; }

Body two_primaries() {
  Body b;
  b.primaries = {{-0.64, 0.0, 0.0}, {0.64, 0.0, 0.0}};
  b.lattice = Eigen::Quaterniond::Identity();
  b.volume = 2.0 * 1.28 * 1.28 * 1.28;
  return b;
}

TEST(Examine, CountsBondsAndTheirStrainAcrossAPeriodicFace) {
  const Recipe recipe = cell(15.0);
  const PackingState s =
      examine(recipe, {two_primaries()}, {primary(1, 1, {14.9, 5, 5}), primary(2, 1, {1.2, 5, 5})});
  EXPECT_EQ(s.bonds, 1);
  EXPECT_EQ(s.pairs_as_made, 1);
  EXPECT_EQ(s.body_bonds, std::vector<int>{1});
  EXPECT_NEAR(s.bond_strain, 0.02 / 1.28, 1e-9);
  EXPECT_EQ(s.body_force_nN, 0.0);
  EXPECT_NEAR(s.highest_um, 5.795, 1e-12);
}

TEST(Examine, MissesABondThatIsTornApart) {
  const Recipe recipe = cell(15.0);
  const PackingState s =
      examine(recipe, {two_primaries()}, {primary(1, 1, {5, 5, 5}), primary(2, 1, {6.7, 5, 5})});
  EXPECT_EQ(s.bonds, 0);
  EXPECT_EQ(s.pairs_as_made, 1);
  EXPECT_EQ(s.pairs_changed, 1);
}

// Hertz, E* = 200 GPa / (2 * 0.91), R* = 0.3975 um, overlap 0.01 um, less CED times the lens's
// area: 4/3 * 1.0989e8 * sqrt(0.3975) * 1e-3 = 92379 nN; 6e5 * pi (0.795^2 - 0.79^2) = 14938 nN.
TEST(Examine, ForceBetweenBodiesIsHertzLessCohesion) {
  const Recipe recipe = cell(15.0);
  Body one;
  one.primaries = {Eigen::Vector3d::Zero()};
  const PackingState s =
      examine(recipe, {one, one}, {primary(1, 1, {5, 5, 5}), primary(2, 2, {5, 5, 6.58})});
  EXPECT_NEAR(s.body_force_nN, 92379.0 - 14938.0, 10.0);
  EXPECT_EQ(s.bonds, 0);
}

TEST(Examine, OverlapsOfCbdAreOverItsRadius) {
  const Recipe recipe = cell(15.0);
  Body one;
  one.primaries = {Eigen::Vector3d::Zero()};
  const PackingState s = examine(recipe, {one},
                                 {primary(1, 1, {5, 5, 5}), cbd(2, {5, 5, 5 + 1.453 - 0.0329}),
                                  cbd(3, {5, 5 + 1.316 - 0.0658, 5 + 1.453 - 0.0329})});
  EXPECT_EQ(s.cbd_cbd.pairs, 1);
  EXPECT_NEAR(s.cbd_cbd.largest, 0.1, 1e-9);
  EXPECT_EQ(s.cbd_am.pairs, 1);
  EXPECT_NEAR(s.cbd_am.mean, 0.05, 1e-9);
  EXPECT_GT(s.am_cbd_force_nN, 0.0);
}

} // namespace
