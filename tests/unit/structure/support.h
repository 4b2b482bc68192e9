// SPDX-License-Identifier: GPL-2.0-or-later
// Voxelised spheres, folders and messages for the tests of structures.
#ifndef CALENDEM_TESTS_UNIT_STRUCTURE_SUPPORT_H
#define CALENDEM_TESTS_UNIT_STRUCTURE_SUPPORT_H

#include "electrode/structure/label_image.h"
#include "physics/pi.h"
#include "support/refusal.h"
#include "support/test_folder.h"
#include <fstream>
#include <iterator>

namespace calendem_test {

using calendem::kPi;

inline calendem::LabelImage empty_image(int nx, int ny, int nz, double voxel) {
  calendem::LabelImage image;
  image.n = {nx, ny, nz};
  image.voxel.setConstant(voxel);
  image.label.assign(size_t(nx) * ny * nz, 0);
  return image;
}

/// Centre and radius in voxels.
inline void add_sphere(calendem::LabelImage &image, const Eigen::Vector3d &centre, double radius,
                       int label) {
  for (int k = 0; k < image.n[2]; ++k)
    for (int j = 0; j < image.n[1]; ++j)
      for (int i = 0; i < image.n[0]; ++i)
        if ((Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5) - centre).norm() < radius)
          image.label[image.index(i, j, k)] = label;
}

/// Where label images and data files of other software are.
const std::string kData = std::string(CALENDEM_TEST_DATA) + "/";

inline std::string replaced(std::string text, const std::string &what, const std::string &with) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

inline std::string bytes_of(const std::filesystem::path &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

} // namespace calendem_test

#endif
