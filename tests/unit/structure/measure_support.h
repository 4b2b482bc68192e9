// SPDX-License-Identifier: GPL-2.0-or-later
// Structures whose measures are known.
#ifndef CALENDEM_TESTS_UNIT_STRUCTURE_MEASURE_SUPPORT_H
#define CALENDEM_TESTS_UNIT_STRUCTURE_MEASURE_SUPPORT_H

#include "measure/phases.h"
#include "support.h"
#include <Eigen/Geometry>
#include <algorithm>

namespace calendem_test {

constexpr double kLattice = 1.28, kPrimary = 0.795, kCbd = 0.658; // um

/// Voxels of side 1 whose label `label(centre)` says.
template <class Label>
calendem::PhaseImage phases(const std::array<int, 3> &n, bool periodic, Label label,
                            double voxel = 1.0) {
  calendem::PhaseImage image =
      calendem::empty_phases(n, Eigen::Vector3d::Constant(voxel), periodic);
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        image.label[image.index(i, j, k)] =
            label(Eigen::Vector3d(voxel * (i + 0.5), voxel * (j + 0.5), voxel * (k + 0.5)));
  return image;
}

/// Primaries of a cubic lattice about `centre`, turned, whose centres lie within `radius`.
inline void add_ball(std::vector<calendem::Sphere> &spheres, const Eigen::Vector3d &centre,
                     double radius, int body,
                     const Eigen::Quaterniond &turn = Eigen::Quaterniond::Identity()) {
  const int n = int(radius / kLattice);
  for (int c = -n; c <= n; ++c)
    for (int b = -n; b <= n; ++b)
      for (int a = -n; a <= n; ++a)
        if (const Eigen::Vector3d x = kLattice * Eigen::Vector3d(a, b, c); x.norm() <= radius)
          spheres.push_back({centre + turn * x, kPrimary, body});
}

} // namespace calendem_test

#endif
