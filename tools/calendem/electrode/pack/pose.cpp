// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/pose.h"
#include <cmath>

namespace calendem {
namespace {

// Each primary touches an earlier one (bodies are grown that way): take its image next to that one.
Eigen::Matrix3Xd join(const Recipe &recipe, const Body &body, const Particle *first) {
  const Eigen::Index n = static_cast<Eigen::Index>(body.primaries.size());
  Eigen::Matrix3Xd x(3, n);
  x.col(0) = first[0].x;
  for (Eigen::Index k = 1; k < n; ++k) {
    Eigen::Index j = 0;
    while (j < k - 1 && (body.primaries[k] - body.primaries[j]).norm() >= recipe.primary_diameter)
      ++j;
    x.col(k) = x.col(j) + periodic_difference(recipe, first[k].x, x.col(j));
  }
  return x;
}

} // namespace

std::vector<Pose> find_poses(const Recipe &recipe, const std::vector<Body> &bodies,
                             const std::vector<Particle> &particles) {
  std::vector<Pose> poses;
  const Particle *first = particles.data();
  for (const Body &b : bodies) {
    const Eigen::Matrix3Xd x = join(recipe, b, first);
    const Eigen::Map<const Eigen::Matrix3Xd> shape(b.primaries.front().data(), 3, x.cols());
    first += b.primaries.size();
    const Eigen::Vector3d mean = x.rowwise().mean();
    Pose pose{in_cell(recipe, mean), b.lattice, 0.0};
    if (x.cols() > 1) {
      const Eigen::Matrix3d R = Eigen::umeyama(shape, x, false).topLeftCorner<3, 3>();
      pose.turn = (Eigen::Quaterniond(R) * b.lattice).normalized();
      pose.distortion = ((x.colwise() - mean) - R * shape).colwise().norm().maxCoeff();
    }
    poses.push_back(pose);
  }
  return poses;
}

} // namespace calendem
