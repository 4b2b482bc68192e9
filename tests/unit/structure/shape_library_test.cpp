// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/measured_shape.h"
#include "support.h"
#include <nlohmann/json.hpp>

namespace {
using namespace calendem;
using namespace calendem_test;
namespace fs = std::filesystem;

// Two whole spheres of 4 and 6 um, one that is cut, one of few voxels.
LabelImage two_spheres() {
  LabelImage image = empty_image(60, 40, 40, 0.25);
  add_sphere(image, {14, 20, 20}, 12, 2);
  add_sphere(image, {38, 20, 20}, 8, 1);
  add_sphere(image, {58, 20, 20}, 8, 3);
  add_sphere(image, {50, 5, 5}, 3, 4);
  return image;
}

TEST(ShapeLibrary, HoldsTheWholeParticlesBySizeAndNamesTheOthers) {
  const ShapeLibrary l = make_library(two_spheres(), 0, "some/where/image.mhd");
  EXPECT_EQ(l.source, "image.mhd");
  EXPECT_EQ(l.labels, 4);
  EXPECT_EQ(l.cut, std::vector<std::int32_t>{3});
  EXPECT_EQ(l.coarse, std::vector<std::int32_t>{4});
  ASSERT_EQ(l.shapes.size(), 2u);
  EXPECT_NEAR(l.shapes[0].equivalent_diameter, 4.0, 0.03);
  EXPECT_NEAR(l.shapes[1].equivalent_diameter, 6.0, 0.03);
  EXPECT_NEAR(l.shapes[1].reach, 3.0, 0.3);
  // Miles & Lantuejoul: 16 and 24 voxels have n - w - 1 of n places clear of the border
  EXPECT_NEAR(l.shapes[0].weight, 1.0 / (43.0 / 60 * 23.0 / 40 * 23.0 / 40), 1e-9);
  EXPECT_NEAR(l.shapes[1].weight, 1.0 / (35.0 / 60 * 15.0 / 40 * 15.0 / 40), 1e-9);
}

TEST(ShapeLibrary, QuantilesRunBetweenTheSmallestAndTheLargest) {
  const ShapeLibrary l = make_library(two_spheres(), 0, "image");
  EXPECT_EQ(l.quantile(0.0), l.shapes[0].equivalent_diameter);
  EXPECT_EQ(l.quantile(1.0), l.shapes[1].equivalent_diameter);
  double before = 0.0;
  for (double q = 0.0; q <= 1.0; q += 0.05) {
    EXPECT_GE(l.quantile(q), before);
    before = l.quantile(q);
  }
  EXPECT_NEAR(l.number_below(l.quantile(0.4)), 0.4, 1e-9);
  EXPECT_EQ(l.number_below(3.0), 0.0);
  EXPECT_EQ(l.number_below(9.0), 1.0);
  EXPECT_EQ(l.volume_above(9.0), 0.0);
  const double w = l.shapes[1].weight * l.shapes[1].volume;
  EXPECT_NEAR(l.volume_above(5.0), w / (w + l.shapes[0].weight * l.shapes[0].volume), 1e-12);
}

TEST(ShapeLibrary, AFolderReadsBackTheSame) {
  const std::string folder = (test_folder() / "shapes").string();
  const ShapeLibrary made = make_library(two_spheres(), 0, "image");
  write_library(made, folder);
  EXPECT_LT(fs::file_size(folder + "/shape_00002.json"), 20000u);
  const ShapeLibrary read = read_library(folder);
  ASSERT_EQ(read.shapes.size(), 2u);
  for (int k : {0, 1}) {
    EXPECT_EQ(read.shapes[k].inside, made.shapes[k].inside);
    EXPECT_EQ(read.shapes[k].depth, made.shapes[k].depth);
    EXPECT_EQ(read.shapes[k].volume, made.shapes[k].volume);
    EXPECT_EQ(read.shapes[k].weight, made.shapes[k].weight);
  }
}

TEST(ShapeLibrary, EveryBadFileIsNamedAtOnce) {
  const std::string folder = (test_folder() / "shapes").string();
  expect_parts(refusal([&] { read_library(folder); }), {"holds no shapes", "calendem pack"});
  write_library(make_library(two_spheres(), 0, "image"), folder);
  nlohmann::json j = nlohmann::json::parse(bytes_of(folder + "/shape_00001.json"));
  fs::resize_file(folder + "/shape_00001.json", 100);
  j["runs_outside_inside"] = {5, 5};
  std::ofstream(folder + "/shape_00007.json") << j;
  j.erase("cell_um");
  std::ofstream(folder + "/shape_00008.json") << j;
  expect_parts(refusal([&] { read_library(folder); }),
               {"shape_00001.json", "shape_00007.json", "fill 10 of", "shape_00008.json", "cell_um",
                "Make the library again"});
}

TEST(ShapeLibrary, AnImageWithoutWholeParticlesIsRefused) {
  LabelImage image = empty_image(20, 20, 20, 0.25);
  for (int label = 1; label <= 6; ++label)
    add_sphere(image, {0.0, 3.0 * label - 1.0, 10.0}, 1.4, label);
  expect_parts(refusal([&] { make_library(image, 0, "image"); }),
               {"of 6 labels 6 are cut", "larger or finer image"});
}

TEST(ShapeLibrary, AnImageOfPhasesIsNamedAsSuch) {
  LabelImage image = empty_image(20, 20, 20, 0.25);
  add_sphere(image, {2, 10, 10}, 6, 1);
  expect_parts(refusal([&] { make_library(image, 0, "image"); }),
               {"these look like phases", "shapes.phases = { pore = 0, am = 1, cbd = 2 }"});
}

TEST(MeasuredShape, DepthIsTheDistanceToTheSurface) {
  LabelImage image = empty_image(60, 60, 60, 0.1);
  add_sphere(image, {30, 30, 30}, 25, 1);
  const MeasuredShape s = make_shape(extract_particle(image, find_regions(image, 0)[0]));
  for (const double r : {0.0, 1.0, 2.0, 2.5, 3.0, 5.0})
    EXPECT_NEAR(s.depth_at({r / std::sqrt(3.0), r / std::sqrt(3.0), r / std::sqrt(3.0)}), r - 2.5,
                r < 2.3 ? 0.21 : 0.105) // two cells: the nearest of many faces; one
        << r;
}

} // namespace
