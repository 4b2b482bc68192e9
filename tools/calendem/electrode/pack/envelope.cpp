// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/envelope.h"
#include <cmath>
#include <functional>

namespace calendem {
namespace {

// Voxels of a cell that is periodic in x and y and as high as its particles.
class Grid {
public:
  Grid(const Recipe &r, double height, double voxel)
      : n_{std::max(1, int(std::ceil(r.cell_x / voxel))),
           std::max(1, int(std::ceil(r.cell_y / voxel))),
           std::max(1, int(std::ceil(height / voxel)))},
        step_(r.cell_x / n_[0], r.cell_y / n_[1], height / n_[2]),
        mark_(size_t(n_[0]) * n_[1] * n_[2], 0) {}

  // Marks the voxels within `reach` of x whose centre is inside and that bear no mark yet.
  void fill(const Eigen::Vector3d &x, double reach, char mark,
            const std::function<bool(const Eigen::Vector3d &)> &inside) {
    const Eigen::Array3d lo = ((x.array() - reach) / step_.array()).floor();
    const Eigen::Array3d hi = ((x.array() + reach) / step_.array()).ceil();
    for (int k = std::max(0, int(lo[2])); k <= std::min(n_[2] - 1, int(hi[2])); ++k)
      for (int j = int(lo[1]); j <= int(hi[1]); ++j)
        for (int i = int(lo[0]); i <= int(hi[0]); ++i) {
          char &m = mark_[(size_t(k) * n_[1] + wrap(j, n_[1])) * n_[0] + wrap(i, n_[0])];
          const Eigen::Vector3d centre =
              (Eigen::Array3d(i, j, k) + 0.5).matrix().cwiseProduct(step_);
          if (!m && inside(centre - x))
            m = mark;
        }
  }
  double volume(char mark) const {
    return step_.prod() * double(std::count(mark_.begin(), mark_.end(), mark));
  }

private:
  static int wrap(int i, int n) { return ((i % n) + n) % n; }
  int n_[3];
  Eigen::Vector3d step_;
  std::vector<char> mark_;
};

} // namespace

Envelope measure_envelope(const Recipe &recipe, const std::vector<Particle> &particles,
                          const std::vector<Pose> &poses, double voxel) {
  double height = 0.0;
  for (const Particle &p : particles)
    height = std::max(height, p.x.z() + 0.5 * p.diameter + recipe.lattice);
  Grid grid(recipe, height, voxel);
  const double half = 0.5 * recipe.lattice;
  for (const Particle &p : particles)
    if (p.body > 0) {
      const Eigen::Matrix3d back = poses[p.body - 1].turn.toRotationMatrix().transpose();
      grid.fill(p.x, std::sqrt(3.0) * half, 1,
                [&](const Eigen::Vector3d &d) { return (back * d).cwiseAbs().maxCoeff() <= half; });
    }
  for (const Particle &p : particles)
    if (p.body == 0)
      grid.fill(p.x, 0.5 * p.diameter, 2, [&](const Eigen::Vector3d &d) {
        return d.squaredNorm() <= 0.25 * p.diameter * p.diameter;
      });
  return {grid.volume(1), grid.volume(1) + grid.volume(2)};
}

} // namespace calendem
