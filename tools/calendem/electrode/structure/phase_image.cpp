// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/phase_image.h"
#include "base/messages.h"
#include <algorithm>
#include <climits>
#include <cmath>
#include <functional>
#include <map>

namespace calendem {

namespace {

using Spheres = std::vector<Sphere>;

constexpr double kBlur = 0.4;  // lattice spacings
constexpr double kReach = 3.0; // blurs

int wrapped(int i, int n) { return ((i % n) + n) % n; }

// Brings the spheres of a body together that lie on both sides of a periodic face: each next to
// the nearest of those that are together already (the body may be wider than half the cell).
void join(Spheres &body, const Cell &cell) {
  std::vector<double> nearest(body.size(), HUGE_VAL);
  std::vector<Eigen::Vector3d> there(body.size()); // place next to that one
  for (size_t m = 0; m + 1 < body.size(); ++m) {
    size_t next = m + 1;
    for (size_t i = m + 1; i < body.size(); ++i) {
      Eigen::Vector3d d = body[i].x - body[m].x;
      d.x() -= cell.lx * std::round(d.x() / cell.lx);
      d.y() -= cell.ly * std::round(d.y() / cell.ly);
      if (d.norm() < nearest[i]) {
        nearest[i] = d.norm();
        there[i] = body[m].x + d;
      }
      if (nearest[i] < nearest[next])
        next = i;
    }
    std::swap(body[m + 1], body[next]);
    std::swap(nearest[m + 1], nearest[next]);
    std::swap(there[m + 1], there[next]);
    body[m + 1].x = there[m + 1];
  }
}

// Voxels around some spheres, on the lattice of the image but not wrapped, with a number each.
class Box {
public:
  Box(const Spheres &spheres, const Eigen::Vector3d &voxel, double reach)
      : voxel_(voxel), reach_(reach) {
    low_.setConstant(INT_MAX);
    Eigen::Array3i high = Eigen::Array3i::Constant(INT_MIN);
    for (const Sphere &s : spheres) {
      low_ = low_.min(voxel_at(s.x.array() - reach));
      high = high.max(voxel_at(s.x.array() + reach));
    }
    n_ = high - low_ + 1;
    value.assign(size_t(n_[0]) * n_[1] * n_[2], 0.0F);
  }
  std::vector<float> value;

  /// Adds f(squared distance from x) to the voxels with their centre closer than the reach.
  void add(const Eigen::Vector3d &x, const std::function<float(double)> &f) {
    const Eigen::Array3i from = voxel_at(x.array() - reach_), to = voxel_at(x.array() + reach_);
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i) {
          const Eigen::Array3d centre = (Eigen::Array3d(i, j, k) + 0.5) * voxel_.array();
          const double d2 = (centre.matrix() - x).squaredNorm();
          if (d2 < reach_ * reach_)
            value[index({i, j, k})] += f(d2);
        }
  }
  Eigen::Array3i voxel_of(size_t index) const {
    return low_ + Eigen::Array3i(int(index % n_[0]), int(index / n_[0] % n_[1]),
                                 int(index / n_[0] / n_[1]));
  }

private:
  Eigen::Vector3d voxel_;
  double reach_;
  Eigen::Array3i low_, n_;

  Eigen::Array3i voxel_at(const Eigen::Array3d &x) const {
    return (x / voxel_.array()).floor().cast<int>();
  }
  size_t index(const Eigen::Array3i &v) const {
    return (size_t(v[2] - low_[2]) * n_[1] + (v[1] - low_[1])) * n_[0] + (v[0] - low_[0]);
  }
};

void put(PhaseImage &image, const Eigen::Array3i &v, std::int32_t label) {
  if (v[2] < 0 || v[2] >= image.n[2])
    return;
  std::int32_t &at =
      image.label[image.index(wrapped(v[0], image.n[0]), wrapped(v[1], image.n[1]), v[2])];
  if (at == kPoreLabel)
    at = label;
}

void put_body(PhaseImage &image, const Spheres &body, double lattice) {
  const double blur = kBlur * lattice;
  Box box(body, image.voxel, kReach * blur);
  for (const Sphere &s : body)
    box.add(s.x, [&](double d2) { return float(std::exp(-0.5 * d2 / (blur * blur))); });
  std::vector<size_t> order;
  for (size_t v = 0; v < box.value.size(); ++v)
    if (box.value[v] > 0.0F)
      order.push_back(v);
  const double volume = double(body.size()) * std::pow(lattice, 3);
  const size_t voxels = std::min(order.size(), size_t(std::lround(volume / image.voxel.prod())));
  const auto denser = [&](size_t a, size_t b) {
    return box.value[a] > box.value[b] || (box.value[a] == box.value[b] && a < b);
  };
  std::nth_element(order.begin(), order.begin() + long(voxels), order.end(), denser);
  for (size_t m = 0; m < voxels; ++m)
    put(image, box.voxel_of(order[m]), body[0].body);
}

void put_cbd(PhaseImage &image, const Sphere &sphere) {
  Box box({sphere}, image.voxel, sphere.radius);
  box.add(sphere.x, [](double) { return 1.0F; });
  for (size_t v = 0; v < box.value.size(); ++v)
    if (box.value[v] > 0.0F)
      put(image, box.voxel_of(v), kCbdLabel);
}

} // namespace

PhaseImage voxelise(const std::vector<Sphere> &spheres, const Cell &cell, double lattice,
                    double voxel) {
  const auto number = [&](double side) {
    return std::max(1, int(std::ceil(0.5 * side / voxel - 1e-9))) * 2;
  };
  const std::array<int, 3> n = {number(cell.lx), number(cell.ly), number(cell.height)};
  PhaseImage image =
      empty_phases(n, {cell.lx / n[0], cell.ly / n[1], cell.height / n[2]}, /*periodic=*/true);
  std::map<int, Spheres> bodies;
  for (const Sphere &s : spheres)
    bodies[s.body].push_back(s);
  for (auto &[body, members] : bodies)
    if (body > 0) {
      join(members, cell);
      put_body(image, members, lattice);
    }
  for (const Sphere &s : bodies[0])
    put_cbd(image, s);
  return image;
}

PhaseImage empty_phases(const std::array<int, 3> &n, const Eigen::Vector3d &voxel, bool periodic) {
  constexpr double kMost = 4e8; // 1.6 GB of labels
  const double voxels = double(n[0]) * n[1] * n[2];
  if (voxels > kMost)
    throw Failure(kBadInput,
                  "voxels of {:.3g} x {:.3g} x {:.3g} um make {:.3g} of them; allowed are {:.0e}. "
                  "Take larger voxels.",
                  voxel[0], voxel[1], voxel[2], voxels, kMost);
  PhaseImage image;
  image.n = n;
  image.voxel = voxel;
  image.periodic = periodic;
  image.label.assign(size_t(voxels), kPoreLabel);
  return image;
}

} // namespace calendem
