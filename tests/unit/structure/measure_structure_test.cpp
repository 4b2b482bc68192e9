// SPDX-License-Identifier: GPL-2.0-or-later
// Images of experiments and simulated structures through the same code; files.
#include "measure/structure.h"
#include "measure_support.h"
#include <nlohmann/json.hpp>

namespace {
using namespace calendem;
using namespace calendem_test;

SimulatedStructure small_structure() {
  SimulatedStructure s;
  s.cell = {9, 9, 12};
  s.lattice = kLattice;
  add_ball(s.spheres, {3, 3, 4}, 2.0, 1);
  add_ball(s.spheres, {6.5, 6, 8}, 2.7, 2);
  for (const double z : {1.0, 2.2, 9.0, 11.0})
    s.spheres.push_back({{7.5, 1.5, z}, kCbd, 0});
  s.cbd_solid = 2.4;
  s.bonds = {{4.0, false}, {8.0, true}};
  return s;
}

// Requirement: a simulated structure written as a label image and read as an experiment's gives the
// same numbers, to the bit where the periodic sides do not enter.
TEST(MeasureImage, IsMeasuredLikeASimulatedStructure) {
  const SimulatedStructure s = small_structure();
  PhaseImage image = voxelise(s.spheres, s.cell, s.lattice, 0.25);
  LabelImage labels = image;
  for (std::int32_t &label : labels.label)
    label = label == kCbdLabel ? 99 : label == kPoreLabel ? 5 : label + 20; // as others number them
  const std::string file = (test_folder() / "after.mha").string();
  write_label_image(labels, file);
  MeasureOptions options;
  options.background = 5;
  options.cbd_label = 99;
  options.nanoporosity = 0.5;
  const StructureMeasures seen = measure_image(file, options);
  image.periodic = false;
  const StructureMeasures known = measure_phases(image, {1.0, 0.5}, options);
  EXPECT_DOUBLE_EQ(seen.porosity.macro, known.fraction.pore);
  EXPECT_NEAR(seen.porosity.total, known.fraction.pore + 0.5 * known.fraction.cbd, 1e-12);
  EXPECT_NEAR(seen.porosity.nano, 0.5 * known.fraction.cbd, 1e-12);
  ASSERT_EQ(seen.slices.size(), known.slices.size());
  for (size_t m = 0; m < seen.slices.size(); ++m) {
    EXPECT_DOUBLE_EQ(seen.slices[m].fraction.am, known.slices[m].fraction.am);
    EXPECT_DOUBLE_EQ(seen.slices[m].porosity_total, known.slices[m].porosity_total);
  }
  EXPECT_NEAR(seen.surface.pore_am, known.surface.pore_am, 1e-6);
  EXPECT_NEAR(seen.surface.am_cbd, known.surface.am_cbd, 1e-6);
  EXPECT_EQ(seen.bodies.bodies, 2);
  for (size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(seen.tortuosity[axis].tau, known.tortuosity[axis].tau, 1e-6);
  EXPECT_FALSE(seen.coordination.has_value());
}

// Requirement: without CBD's nanoporosity there is no total porosity, and no number stands for it.
TEST(MeasureImage, WithoutNanoporosityTheTotalIsNotKnown) {
  LabelImage image = empty_image(20, 20, 20, 0.5);
  add_sphere(image, {10, 10, 10}, 6, 4);
  const std::string file = (test_folder() / "a.vti").string();
  write_label_image(image, file);
  MeasureOptions options;
  options.tortuosity = false;
  const StructureMeasures m = measure_image(file, options);
  EXPECT_TRUE(std::isnan(m.porosity.total));
  const nlohmann::json j = to_json(m);
  EXPECT_TRUE(j["porosity_total"].is_null());
  EXPECT_TRUE(j["tortuosity"].is_null());
  EXPECT_NEAR(j["porosity_macro"].get<double>(), 1 - 4 * kPi * 216 / 3 / 8000, 0.002);
  EXPECT_FALSE(j.contains("coordination"));
  const std::string table = profile_table({m});
  EXPECT_NE(table.find("image,0.0000,1.0000,0.050000,0.000000,0.000000,1.000000,,,\n"),
            std::string::npos)
      << table;
}

// Requirement: a pore space without a path is stated in words; there is no number.
TEST(MeasureImage, ClosedPoresAreStated) {
  PhaseImage image = phases(
      {8, 8, 8}, true, [](const Eigen::Vector3d &x) { return x.z() < 2 || x.z() > 4 ? 0 : 1; });
  const nlohmann::json j = to_json(measure_phases(image, {}, {}))["tortuosity"];
  EXPECT_TRUE(j["tau_through_plane"].is_null());
  EXPECT_NEAR(j["tau_in_plane"].get<double>(), 1.0, 1e-9);
  expect_parts(j["through_plane"]["statement"], {"no path", "infinite"});
}

// Requirement: the table has the same columns for every moment, bonds only where they are known.
TEST(ProfileTable, HasOneRowPerMomentAndSlice) {
  MeasureOptions options;
  options.tortuosity = false;
  options.slice_um = 6.0;
  StructureMeasures m = measure_spheres(small_structure(), options);
  m.moment = "max";
  const std::string table = profile_table({m});
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  const std::string header = "moment,z_from_um,z_to_um,z_over_thickness,am_fraction,cbd_fraction,"
                             "porosity_macro,porosity_total,bonds,bonds_broken\n";
  EXPECT_EQ(table.substr(0, header.size()), header);
  expect_parts(table,
               {"max,0.0000,6.0000,0.250000,", ",1,0\n", "max,6.0000,12.0000,0.750000,", ",1,1\n"});
}

// Requirement: every number of structure.json that is not plain has its definition there.
TEST(StructureJson, ExplainsItsNumbers) {
  const nlohmann::json d = structure_definitions();
  for (const char *key : {"porosity_total", "porosity_macro", "porosity_nano", "thickness_um",
                          "area_per_volume_1_um", "coordination", "bodies_on_voxels", "tau"})
    EXPECT_TRUE(d.contains(key)) << key;
}

} // namespace
