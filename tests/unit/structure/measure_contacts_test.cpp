// SPDX-License-Identifier: GPL-2.0-or-later
// Coordination numbers of lattices and of hand-made contacts.
#include "measure/structure.h"
#include "measure_support.h"

namespace {
using namespace calendem;
using namespace calendem_test;

// Bodies of one primary on a lattice that is periodic in x and y: cells^2 x layers.
std::vector<Sphere> lattice(double spacing, int cells, int layers, bool face_centred) {
  std::vector<Sphere> spheres;
  for (int c = 0; c < layers; ++c)
    for (int b = 0; b < cells; ++b)
      for (int a = 0; a < cells; ++a) {
        std::vector<Eigen::Vector3d> sites = {{0, 0, 0}};
        if (face_centred)
          sites = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
        for (const Eigen::Vector3d &site : sites)
          spheres.push_back({spacing * (Eigen::Vector3d(a, b, c + 0.1) + site), kPrimary,
                             int(spheres.size()) + 1});
      }
  return spheres;
}

// Requirement: simple cubic 6, face-centred cubic 12, less for the outermost layers, none when a
// hair apart.
TEST(Coordination, OfLattices) {
  const double touching = 2 * kPrimary - 1e-6, apart = 2 * kPrimary + 1e-6;
  for (const int layers : {2, 5}) {
    const double side = 4 * touching;
    EXPECT_DOUBLE_EQ(coordination(lattice(touching, 4, layers, false), {side, side, 99}).am_am,
                     6.0 - 2.0 / layers);
  }
  const Coordination none = coordination(lattice(apart, 4, 3, false), {4 * apart, 4 * apart, 99});
  EXPECT_EQ(none.bodies, 48);
  EXPECT_DOUBLE_EQ(none.am_am, 0.0);
  EXPECT_DOUBLE_EQ(none.am_without_am, 1.0);
  EXPECT_DOUBLE_EQ(none.am_without_any, 1.0);
  const double a = std::sqrt(2.0) * touching;
  // 2 x layers planes; each of the two outermost lacks the 4 contacts across it
  EXPECT_DOUBLE_EQ(coordination(lattice(a, 3, 4, true), {3 * a, 3 * a, 99}).am_am,
                   12.0 - 4.0 * 2.0 / 8.0);
}

// Requirement: the surface of a body lies inside the tips of its primaries, less deep where bonds are broken.
TEST(Coordination, BeginsAtTheSurfacesOfBodies) {
  ParticleFrame particles;
  particles.tag = {7, 8, 9, 10};
  particles.body = {1, 1, 2, 0};
  BondFrame bonds;
  bonds.tags = {{7, 8}, {7, 8}, {7, 8}, {7, 8}};
  bonds.intact = {true, true, true, false};
  EXPECT_EQ(surface_insets(particles, bonds, 0.1, 1.0),
            (std::vector<double>{0.05, 0.05, 0.0, 0.0}));
  EXPECT_EQ(surface_insets(particles, bonds, 0.1, 0.0), (std::vector<double>{0.1, 0.1, 0.1, 0.0}));
  for (const double inset : {0.04, 0.06}) {
    const std::vector<Sphere> two = {{{1, 5, 5}, kPrimary, 1, inset},
                                     {{1 + 2 * kPrimary - 0.1, 5, 5}, kPrimary, 2, inset}};
    EXPECT_EQ(coordination(two, {10, 10, 12}).am_am, inset < 0.05 ? 1.0 : 0.0);
  }
}

// Requirement: bodies count once whatever their primaries; CBD spheres singly; itself never.
TEST(Coordination, OfBodiesAndCbd) {
  const double d = 2 * kPrimary - 0.05;
  const std::vector<Sphere> spheres = {
      {{1, 5, 5}, kPrimary, 1},
      {{1, 5, 5 + 1.28}, kPrimary, 1},     // a body of two
      {{1 + d, 5, 5}, kPrimary, 2},        // touches the first primary of 1 ...
      {{1 + d, 5, 5 + 1.28}, kPrimary, 2}, // ... and the second: one contact of bodies
      {{1 - kPrimary - kCbd + 0.02 + 10, 5, 5}, kCbd, 0}, // touches 1 through the periodic face
      {{6, 5, 5}, kCbd, 0},
      {{6, 5, 5 + 2 * kCbd - 0.02}, kCbd, 0}, // the two touch each other only
      {{5, 1, 9}, kPrimary, 3}};              // touches nothing
  const Coordination c = coordination(spheres, {10, 10, 12});
  EXPECT_EQ(c.bodies, 3);
  EXPECT_EQ(c.cbd, 3);
  EXPECT_DOUBLE_EQ(c.am_am, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.am_cbd, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.cbd_am, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.cbd_cbd, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.am_without_am, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.am_without_any, 1.0 / 3.0);
}

// Cubes of 10 voxels in a row along x, `gap` voxels between them, labels 1 2 3 ...
PhaseImage row_of_cubes(int cubes, int gap, bool periodic) {
  return phases({cubes * (10 + gap), 30, 30}, periodic, [&](const Eigen::Vector3d &x) {
    const int cube = int(x.x()) / (10 + gap);
    const bool in =
        int(x.x()) % (10 + gap) < 10 && std::fabs(x.y() - 15) < 5 && std::fabs(x.z() - 15) < 5;
    return in ? cube + 1 : 0;
  });
}

// Requirement: neighbours on voxels share a face; a gap of one voxel parts them; periodic faces
// join the ends of the row.
TEST(VoxelBodies, Neighbours) {
  EXPECT_DOUBLE_EQ(bodies_on_voxels(row_of_cubes(5, 0, false)).am_am, 2.0 * 4 / 5);
  EXPECT_DOUBLE_EQ(bodies_on_voxels(row_of_cubes(5, 0, true)).am_am, 2.0);
  EXPECT_DOUBLE_EQ(bodies_on_voxels(row_of_cubes(5, 1, true)).am_am, 0.0);
}

// Requirement: a body in two parts is seen, a chip of 2 % is not; cut ones are not judged.
TEST(VoxelBodies, Pieces) {
  PhaseImage image = row_of_cubes(4, 2, false);
  for (int k = 0; k < 30; ++k)
    for (int j = 0; j < 30; ++j)
      image.label[image.index(12 + 4, j, k)] = 0; // the second cube, apart
  image.label[image.index(24, 10, 11)] = 0;       // a chip of the third: one voxel in its corner
  image.label[image.index(25, 10, 10)] = 0;
  image.label[image.index(24, 11, 10)] = 0;
  const VoxelBodies seen = bodies_on_voxels(image);
  EXPECT_EQ(seen.bodies, 4);
  EXPECT_EQ(seen.whole, 3); // the first touches the side of the image
  EXPECT_EQ(seen.in_pieces, 1);
  image.periodic = true;
  EXPECT_EQ(bodies_on_voxels(image).whole, 4);
}

} // namespace
