// SPDX-License-Identifier: GPL-2.0-or-later
// From labels to volumes, surfaces and distances of single particles.
#include "electrode/structure/measured_shape.h"
#include "support.h"

namespace {
using namespace calendem;
using namespace calendem_test;

TEST(FindRegions, ReportsWhatTheBorderCuts) {
  LabelImage image = empty_image(30, 30, 30, 0.3);
  add_sphere(image, {8, 8, 8}, 5, 3);
  add_sphere(image, {26, 15, 15}, 5, 9);
  const std::vector<Region> regions = find_regions(image, 0);
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_EQ(regions[0].label, 3);
  EXPECT_FALSE(regions[0].cut);
  EXPECT_TRUE(regions[1].cut);
  EXPECT_EQ(regions[0].low, (std::array<int, 3>{3, 3, 3}));
  EXPECT_EQ(regions[0].high, (std::array<int, 3>{12, 12, 12}));
  EXPECT_EQ(find_regions(image, 3).size(), 2u); // another background
}

TEST(ExtractParticle, ClosesPoresAndDropsWhatIsNotConnected) {
  LabelImage image = empty_image(40, 40, 40, 0.1);
  add_sphere(image, {20, 20, 20}, 12, 5);
  const long whole = find_regions(image, 0)[0].voxels;
  add_sphere(image, {21, 19, 20}, 4, 0); // a pore
  const long solid = find_regions(image, 0)[0].voxels;
  image.label[image.index(2, 2, 2)] = 5; // a speck
  const ParticleMask m = extract_particle(image, find_regions(image, 0)[0]);
  EXPECT_EQ(m.solid_voxels, solid);
  EXPECT_EQ(m.pore_voxels, whole - solid);
  EXPECT_EQ(m.loose_voxels, 1);
  EXPECT_NEAR(m.volume(), double(whole) * 1e-3, 1e-9);
}

// A pore that reaches the surface is no closed pore.
TEST(ExtractParticle, LeavesAnOpenPoreOpen) {
  LabelImage image = empty_image(40, 40, 40, 0.1);
  add_sphere(image, {20, 20, 20}, 12, 5);
  for (int k = 20; k < 40; ++k)
    image.label[image.index(20, 20, k)] = 0;
  EXPECT_EQ(extract_particle(image, find_regions(image, 0)[0]).pore_voxels, 0);
}

TEST(SmoothSurface, VoxelisedSpheresHaveSphericityOne) {
  for (const double radius : {4.0, 5.3, 7.0, 10.4, 15.0, 24.7})
    for (const double offset : {0.0, 0.31, 0.5}) {
      const int n = int(2 * radius) + 6;
      LabelImage image = empty_image(n, n, n, 0.2);
      add_sphere(image, Eigen::Vector3d::Constant(0.5 * n + offset), radius, 1);
      const SurfaceMeasures s = measure_surface(extract_particle(image, find_regions(image, 0)[0]));
      EXPECT_NEAR(s.sphericity, 1.0, 0.02) << radius << " " << offset;
      EXPECT_NEAR(s.area / (4 * kPi * radius * radius * 0.04), 1.0, 0.06) << radius;
    }
}

// A cube's sphericity is (pi/6)^(1/3) = 0.806; its edges are rounded by the filter.
TEST(SmoothSurface, ACubeIsLessRound) {
  LabelImage image = empty_image(36, 36, 36, 0.2);
  for (int k = 3; k < 33; ++k)
    for (int j = 3; j < 33; ++j)
      for (int i = 3; i < 33; ++i)
        image.label[image.index(i, j, k)] = 1;
  const ParticleMask m = extract_particle(image, find_regions(image, 0)[0]);
  EXPECT_NEAR(measure_surface(m).sphericity, 0.806, 0.04);
}

TEST(SignedDistance, IsTheDistanceToAPlaneAndToASphere) {
  std::vector<char> half(20 * 4 * 4, 0);
  for (size_t v = 0; v < half.size(); ++v)
    half[v] = v % 20 < 8;
  const std::vector<float> d = signed_distance(half, {20, 4, 4}, 0.5);
  for (int i = 0; i < 20; ++i)
    EXPECT_NEAR(d[i], 0.5 * (i + 0.5 - 8), 1e-6) << i;
  LabelImage image = empty_image(40, 40, 40, 1.0);
  add_sphere(image, {20, 20, 20}, 12, 1);
  const std::vector<char> inside(image.label.begin(), image.label.end());
  const std::vector<float> r = signed_distance(inside, {40, 40, 40}, 1.0);
  for (int i = 0; i < 40; ++i) // half a voxel's diagonal
    EXPECT_NEAR(r[image.index(i, 19, 24)],
                (Eigen::Vector3d(i + 0.5, 19.5, 24.5) - Eigen::Vector3d::Constant(20)).norm() - 12,
                0.87);
}

} // namespace
