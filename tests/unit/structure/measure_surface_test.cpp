// SPDX-License-Identifier: GPL-2.0-or-later
// Area of spheres and planes from voxels.
#include "electrode/structure/measured_shape.h"
#include "measure/phases.h"
#include "measure_support.h"

namespace {
using namespace calendem;
using namespace calendem_test;

// Spheres one above the other, endless in x and y: what lies beyond the upper and lower side adds
// nothing but the share of one layer.
PhaseImage spheres_in(int n, int layers, const Eigen::Vector3d &centre, double radius) {
  return phases({n, n, n * layers}, true, [&](const Eigen::Vector3d &x) {
    Eigen::Vector3d d = x - centre;
    for (int axis = 0; axis < 3; ++axis)
      d[axis] -= n * std::round(d[axis] / n);
    return d.norm() < radius ? 1 : 0;
  });
}

// Requirement: spheres within 7 % at 4 voxels radius, 2 % from 5.5 and 1 % from 12, wherever their
// centre lies.
TEST(SurfaceArea, OfSpheres) {
  for (const double radius : {4.0, 5.5, 8.0, 12.3, 20.0})
    for (const double offset : {0.0, 0.23, 0.5}) {
      const int n = 2 * int(radius) + 5;
      const PhaseImage image =
          spheres_in(n, 10, {0.5 * n + offset, 0.5 * n, 0.5 * n - offset}, radius);
      const double area = surface_area(image).pore_solid() * std::pow(n, 3);
      const double error = radius < 5 ? 0.07 : radius < 12 ? 0.021 : 0.01;
      EXPECT_NEAR(area / (4 * kPi * radius * radius), 1.0, error) << radius << " " << offset;
    }
}

// Requirement: planes within 8 %, whatever their direction: slabs of 10 voxels, 10 apart.
TEST(SurfaceArea, OfPlanes) {
  const int n = 60;
  for (const Eigen::Vector3d &normal :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 1, 1), Eigen::Vector3d(1, 1, 1),
        Eigen::Vector3d(0.2, 0.5, 1), Eigen::Vector3d(0.4, 0, 1), Eigen::Vector3d(1, 2, 2)}) {
    const Eigen::Vector3d u = normal.normalized();
    const PhaseImage image = phases({n, n, n}, false, [&](const Eigen::Vector3d &x) {
      return std::fmod(u.dot(x) + 5.0, 20.0) < 10.0 ? 1 : 0;
    });
    EXPECT_NEAR(surface_area(image).pore_am / 0.1, 1.0, 0.08) << normal.transpose();
  }
}

// Requirement: voxels need not be cubes: slices four times as thick as a pixel is wide.
TEST(SurfaceArea, OfASphereOnFlatVoxels) {
  PhaseImage image = empty_phases({60, 60, 150}, {1, 1, 4}, true);
  for (int k = 0; k < 150; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i) {
        const Eigen::Vector3d d(i - 29.3, j - 29.8, 4 * (k % 15) - 28.6);
        image.label[image.index(i, j, k)] = d.norm() < 26;
      }
  EXPECT_NEAR(surface_area(image).pore_am * 216000 / (4 * kPi * 676), 1.0, 0.03);
}

// Requirement: on slices twice as thick as a pixel is wide, planes along and across them are 12 %
// off at most: directions count by their share of all directions.
TEST(SurfaceArea, OfPlanesOnFlatVoxels) {
  for (const int axis : {0, 2}) {
    PhaseImage image = empty_phases({60, 60, 60}, {1, 1, 2}, false);
    for (size_t v = 0; v < image.label.size(); ++v)
      image.label[v] = (int(axis == 0 ? v % 60 : v / 3600) + 5) % 20 < 10;
    EXPECT_NEAR(surface_area(image).pore_am * 10 * image.voxel[axis], 1.0, 0.12) << axis;
  }
}

// Requirement: through the periodic faces there is no surface.
TEST(SurfaceArea, KnowsPeriodicFaces) {
  const PhaseImage middle = spheres_in(30, 1, {15, 15, 15}, 9);
  const PhaseImage edge = spheres_in(30, 1, {0, 30, 15}, 9);
  EXPECT_NEAR(surface_area(edge).pore_am, surface_area(middle).pore_am, 1e-12);
}

// Requirement: each pair of phases has its own area: an AM ball half sunk into CBD.
TEST(SurfaceArea, SeparatesThePhases) {
  const int n = 48;
  const double r = 14, volume = std::pow(n, 3);
  const PhaseImage image = phases({n, n, n}, true, [&](const Eigen::Vector3d &x) {
    if ((x - Eigen::Vector3d::Constant(24)).norm() < r)
      return 1;
    return x.z() < 24 ? int(kCbdLabel) : int(kPoreLabel);
  });
  const SurfaceArea s = surface_area(image);
  EXPECT_NEAR(s.pore_am * volume / (2 * kPi * r * r), 1.0, 0.02);
  EXPECT_NEAR(s.am_cbd * volume / (2 * kPi * r * r), 1.0, 0.02);
  EXPECT_NEAR(s.pore_cbd * volume / (n * n - kPi * r * r), 1.0, 0.1); // a plane
  EXPECT_DOUBLE_EQ(s.pore_solid(), s.pore_am + s.pore_cbd);
}

// Requirement: the smoothed surface of flying edges (VTK), another method, gives the same area of a
// rough body in a wide empty box.
TEST(SurfaceArea, AgreesWithTheSmoothSurface) {
  const int n = 120;
  const PhaseImage image = phases({n, n, n}, true, [&](const Eigen::Vector3d &x) {
    const Eigen::Vector3d d = x - Eigen::Vector3d::Constant(60);
    return d.norm() < 14 + 2.0 * std::sin(0.35 * d.x()) * std::cos(0.3 * d.y() + 0.2 * d.z());
  });
  const ParticleMask mask = extract_particle(image, find_regions(image, 0)[0]);
  const double area = surface_area(image).pore_am * std::pow(n, 3);
  EXPECT_NEAR(area / measure_surface(mask).area, 1.0, 0.02);
}

// Requirement: the envelope of a ball of primaries has 16 % more area than the ball that holds
// N s^3: the steps of the lattice. Gaps between primaries would show as much more.
TEST(SurfaceArea, OfABodysEnvelope) {
  std::vector<Sphere> spheres;
  add_ball(spheres, {6, 6, 20}, 3.5 * kLattice, 1);
  const PhaseImage image = voxelise(spheres, {12, 12, 40}, kLattice, 0.15);
  const double r = std::cbrt(0.75 / kPi * double(spheres.size())) * kLattice;
  EXPECT_NEAR(surface_area(image).pore_am * 5760 / (4 * kPi * r * r), 1.16, 0.02);
}

} // namespace
