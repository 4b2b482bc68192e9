// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated frame as voxels: volumes, pores inside bodies, cracks, periodic faces, platens.
#include "measure/structure.h"
#include "measure_support.h"

namespace {
using namespace calendem;
using namespace calendem_test;

double volume(const PhaseImage &image, std::int32_t label) {
  return image.voxel.prod() * double(std::count(image.label.begin(), image.label.end(), label));
}

const Eigen::Quaterniond kTurn(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));

// Requirement: the envelope of a body holds its lattice volume N s^3, at any size and voxel.
TEST(Voxelise, ABodyHoldsItsLatticeVolume) {
  for (const double radius : {0.0, 1.3, 3.0, 4.6})
    for (const double voxel : {0.3, 0.15}) {
      std::vector<Sphere> spheres;
      add_ball(spheres, {6.1, 5.9, 6.2}, radius, 1, kTurn);
      const PhaseImage image = voxelise(spheres, {12, 12, 12}, kLattice, voxel);
      EXPECT_NEAR(volume(image, 1), double(spheres.size()) * std::pow(kLattice, 3),
                  image.voxel.prod())
          << radius << " " << voxel;
      EXPECT_LE(image.voxel.maxCoeff(), voxel + 1e-12);
    }
}

// Requirement: the gaps between the primaries of a body are no pores, and nothing far from them is
// AM: all within 2.4 um of the centre of a ball of 3.84 um and nothing beyond 4.9 um.
TEST(Voxelise, ABodyHasNoPoresInside) {
  std::vector<Sphere> spheres;
  const Eigen::Vector3d centre(6.03, 6.11, 6.07);
  add_ball(spheres, centre, 3 * kLattice, 1, kTurn);
  const PhaseImage image = voxelise(spheres, {12, 12, 12}, kLattice, 0.1);
  size_t v = 0;
  for (int k = 0; k < image.n[2]; ++k)
    for (int j = 0; j < image.n[1]; ++j)
      for (int i = 0; i < image.n[0]; ++i, ++v) {
        const double r =
            (Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(image.voxel) - centre).norm();
        if (r < 2.4)
          ASSERT_EQ(image.label[v], 1) << r;
        else if (r > 4.9)
          ASSERT_EQ(image.label[v], 0) << r;
      }
}

// Requirement: a crack is a pore once it is wide enough: closed at 0.4 s, open at 0.8 s.
TEST(Voxelise, ACrackOpensWithItsWidth) {
  for (const auto &[gap, open] : {std::pair{0.4, false}, std::pair{0.8, true}}) {
    std::vector<Sphere> spheres;
    add_ball(spheres, {6, 6, 6}, 3 * kLattice, 1);
    for (Sphere &s : spheres)
      if (s.x.x() > 6.1)
        s.x.x() += gap * kLattice;
    const PhaseImage image = voxelise(spheres, {12, 12, 12}, kLattice, 0.1);
    const double middle = 6 + 0.5 * (1 + gap) * kLattice;
    EXPECT_EQ(image.at(int(middle / 0.1), 60, 60), open ? 0 : 1) << gap;
    const VoxelBodies seen = bodies_on_voxels(image);
    EXPECT_EQ(seen.whole, 1);
    EXPECT_EQ(seen.in_pieces, open ? 1 : 0) << gap;
  }
}

// Requirement: a body across the periodic faces is the same body.
TEST(Voxelise, PeriodicFacesDoNotMatter) {
  std::vector<Sphere> middle, edge;
  add_ball(middle, {6, 6, 6}, 3.0, 1, kTurn);
  for (Sphere s : middle) {
    s.x -= Eigen::Vector3d(6, 6, 0);
    for (int axis = 0; axis < 2; ++axis)
      s.x[axis] += s.x[axis] < 0 ? 12 : 0;
    edge.push_back(s);
  }
  const PhaseImage a = voxelise(middle, {12, 12, 12}, kLattice, 0.2);
  const PhaseImage b = voxelise(edge, {12, 12, 12}, kLattice, 0.2);
  EXPECT_NEAR(volume(a, 1), volume(b, 1), 2 * a.voxel.prod());
  const VoxelBodies seen = bodies_on_voxels(b);
  EXPECT_EQ(seen.whole, 1);
  EXPECT_EQ(seen.in_pieces, 0);
}

// Requirement: CBD is the part of its spheres outside the envelopes; a body keeps its voxels.
TEST(Voxelise, CbdLiesOutsideTheEnvelopes) {
  const double sphere = 4.0 / 3.0 * kPi * std::pow(kCbd, 3);
  std::vector<Sphere> spheres = {{{2, 2, 2}, kCbd, 0}};
  const PhaseImage free = voxelise(spheres, {8, 8, 8}, kLattice, 0.05);
  EXPECT_NEAR(volume(free, kCbdLabel), sphere, 0.01 * sphere);
  spheres = {{{4, 4, 4}, kPrimary, 1}, {{4, 4, 4}, kCbd, 0}}; // its middle is full
  const PhaseImage hidden = voxelise(spheres, {8, 8, 8}, kLattice, 0.05);
  EXPECT_NEAR(volume(hidden, 1), std::pow(kLattice, 3), 2e-4);
  EXPECT_LT(volume(hidden, kCbdLabel), 0.01 * sphere);
}

// Requirement: what lies beyond collector and platen is cut off: half of a CBD sphere is left.
TEST(Voxelise, ThePlatensCut) {
  const double sphere = 4.0 / 3.0 * kPi * std::pow(kCbd, 3);
  for (const double z : {0.0, 5.0}) {
    const PhaseImage image = voxelise({{{3, 3, z}, kCbd, 0}}, {6, 6, 5}, kLattice, 0.05);
    EXPECT_NEAR(volume(image, kCbdLabel), 0.5 * sphere, 0.01 * sphere);
  }
}

// Requirement: an image that no memory holds is refused with what to do.
TEST(Voxelise, RefusesTooManyVoxels) {
  expect_parts(refusal([] {
                 voxelise({}, {100, 100, 100}, kLattice, 0.01);
               }),
               {"voxels", "4e+08", "larger voxels"});
}

} // namespace
