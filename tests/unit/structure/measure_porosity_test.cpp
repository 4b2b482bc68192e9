// SPDX-License-Identifier: GPL-2.0-or-later
// The three porosities (docs/model/porosity.md), and profiles, on structures with a known answer.
#include "measure/structure.h"
#include "measure_support.h"

namespace {
using namespace calendem;
using namespace calendem_test;

// Requirement: each definition by hand: 1000 um3 with 400 AM, CBD 50 solid and 90 envelope.
TEST(Porosity, EachDefinitionByHand) {
  const Porosity p = porosity({1000, 400, 50, 90});
  EXPECT_DOUBLE_EQ(p.total, 0.55);
  EXPECT_DOUBLE_EQ(p.macro, 0.51);
  EXPECT_NEAR(p.nano, 0.04, 1e-15);
}

// Requirement: spheres and bodies apart from each other: total and macro follow from their volumes.
// Macro is known to the error of the voxelised CBD spheres only.
TEST(Porosity, OfSpheresThatAreApart) {
  SimulatedStructure s;
  s.cell = {8, 8, 10};
  s.lattice = kLattice;
  add_ball(s.spheres, {2.1, 2.2, 3.3}, 1.3, 1); // 7 primaries
  s.spheres.push_back({{6, 6, 6}, kPrimary, 2});
  s.spheres.push_back({{2, 6, 8}, kCbd, 0});
  s.spheres.push_back({{6, 2, 8}, kCbd, 0});
  const double sphere = 4.0 / 3.0 * kPi * std::pow(kCbd, 3), am = 8 * std::pow(kLattice, 3);
  s.cbd_solid = 2 * 0.5 * sphere; // nanoporosity 50 %
  MeasureOptions options;
  options.voxel_um = 0.1;
  options.tortuosity = false;
  const StructureMeasures m = measure_spheres(s, options);
  EXPECT_NEAR(m.porosity.total, 1 - (am + sphere) / 640, 1e-12);
  EXPECT_NEAR(m.porosity.macro, 1 - (am + 2 * sphere) / 640, 0.02 * 2 * sphere / 640);
  EXPECT_NEAR(m.porosity.nano, sphere / 640, 0.02 * 2 * sphere / 640);
  EXPECT_NEAR(m.fraction.pore, m.porosity.macro, 1e-5); // the voxels show the same
  EXPECT_NEAR(*m.am_on_voxels, 1.0, 1e-3);
}

// Requirement: what overlaps counts once in macro; in total every gram counts.
TEST(Porosity, OverlapCountsOnceInMacro) {
  SimulatedStructure s;
  s.cell = {8, 8, 10};
  s.lattice = kLattice;
  s.spheres = {{{4, 4, 5}, kPrimary, 1}, {{4, 4, 5}, kCbd, 0}};
  s.cbd_solid = 0.5;
  MeasureOptions options;
  options.voxel_um = 0.1;
  options.tortuosity = false;
  const StructureMeasures m = measure_spheres(s, options);
  EXPECT_NEAR(m.porosity.macro, 1 - std::pow(kLattice, 3) / 640, 0.02 / 640);
  EXPECT_NEAR(m.porosity.total, 1 - (std::pow(kLattice, 3) + 0.5) / 640, 1e-12);
  EXPECT_LT(m.porosity.nano, 0.0); // as the definition has it
}

// z < 4: AM; 4 to 6: CBD in half of the width; above: pore.
int layers(const Eigen::Vector3d &x) {
  return x.z() < 4 ? 1 : x.z() < 6 && x.x() < 4 ? kCbdLabel : kPoreLabel;
}

// Requirement: slices have the phases of their height, their means are those of the image.
TEST(Profile, OfLayers) {
  const PhaseImage image = phases({8, 6, 12}, true, layers);
  const std::vector<Slice> slices = profile(image, {1.0, 0.5}, 2.0);
  ASSERT_EQ(slices.size(), 6u);
  for (size_t m = 0; m < slices.size(); ++m) {
    EXPECT_DOUBLE_EQ(slices[m].fraction.am, m < 2 ? 1.0 : 0.0);
    EXPECT_DOUBLE_EQ(slices[m].fraction.cbd, m == 2 ? 0.5 : 0.0);
    EXPECT_DOUBLE_EQ(slices[m].porosity_total, m < 2 ? 0.0 : m == 2 ? 0.75 : 1.0);
    EXPECT_DOUBLE_EQ(slices[m].from, 2.0 * double(m));
    EXPECT_DOUBLE_EQ(slices[m].to, 2.0 * double(m + 1));
  }
  const PhaseFractions all = phase_fractions(image);
  for (const double thickness : {0.1, 1.0, 2.5, 5.0, 40.0}) {
    double pore = 0.0;
    for (const Slice &s : profile(image, {1.0, 0.5}, thickness))
      pore += s.fraction.pore * (s.to - s.from) / 12.0;
    EXPECT_NEAR(pore, all.pore, 1e-12) << thickness;
  }
}

// Requirement: the mean of the profile's total porosity is the total porosity of the definition.
TEST(Profile, MeanOfTheTotalPorosityIsTheDefinition) {
  SimulatedStructure s;
  s.cell = {8, 8, 9};
  s.lattice = kLattice;
  add_ball(s.spheres, {4, 4, 4}, 2.8, 1);
  for (const double z : {0.7, 2.0, 8.1})
    s.spheres.push_back({{0.4, 7.5, z}, kCbd, 0});
  s.cbd_solid = 1.5;
  MeasureOptions options;
  options.tortuosity = false;
  const StructureMeasures m = measure_spheres(s, options);
  double total = 0.0;
  for (const Slice &slice : m.slices)
    total += slice.porosity_total * (slice.to - slice.from) / 9.0;
  EXPECT_NEAR(total, m.porosity.total, 1e-12);
}

// Requirement: every bond counts in the slice that holds it, those outside in the outermost ones.
TEST(Profile, CountsBondsByHeight) {
  std::vector<Slice> slices = profile(phases({2, 2, 10}, true, layers), {}, 2.5);
  ASSERT_EQ(slices.size(), 4u);
  count_bonds({{-0.1, true}, {0.3, false}, {3.9, true}, {9.9, false}, {10.4, true}}, slices);
  const long bonds[] = {2, 1, 0, 2}, broken[] = {1, 1, 0, 1};
  for (size_t m = 0; m < 4; ++m) {
    EXPECT_EQ(slices[m].bonds, bonds[m]) << m;
    EXPECT_EQ(slices[m].broken, broken[m]) << m;
  }
}

} // namespace
