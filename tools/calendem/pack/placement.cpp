// SPDX-License-Identifier: GPL-2.0-or-later
#include "pack/placement.h"
#include <cmath>
#include <fmt/format.h>
#include <unordered_map>

namespace calendem {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Spheres in bins of a cell that is periodic in x and y.
class Bins {
public:
  Bins(const Recipe &r, double width)
      : recipe_(r), nx_(std::max(1, int(r.cell_x / width))),
        ny_(std::max(1, int(r.cell_y / width))), width_(width) {}

  void add(const Eigen::Vector3d &x, double radius) { bins_[key(index(x))].push_back({x, radius}); }

  // True if a sphere overlaps one that is there. Radii must not exceed width/2.
  bool hits(const Eigen::Vector3d &x, double radius) const {
    const std::array<int, 3> c = index(x);
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) {
          const auto bin = bins_.find(key({c[0] + i, c[1] + j, c[2] + k}));
          if (bin == bins_.end())
            continue;
          for (const Sphere &s : bin->second)
            if (periodic_difference(recipe_, x, s.x).squaredNorm() <
                (radius + s.radius) * (radius + s.radius))
              return true;
        }
    return false;
  }

private:
  struct Sphere {
    Eigen::Vector3d x;
    double radius;
  };
  const Recipe &recipe_;
  int nx_, ny_;
  double width_;
  std::unordered_map<long, std::vector<Sphere>> bins_;

  std::array<int, 3> index(const Eigen::Vector3d &x) const {
    const Eigen::Vector3d p = in_cell(recipe_, x);
    return {int(p.x() / recipe_.cell_x * nx_), int(p.y() / recipe_.cell_y * ny_),
            int(std::floor(p.z() / width_))};
  }
  long key(const std::array<int, 3> &c) const {
    const long i = (c[0] + nx_) % nx_, j = (c[1] + ny_) % ny_;
    return (long(c[2]) * ny_ + j) * nx_ + i;
  }
};

bool body_hits(const Bins &bins, const Body &b, const Eigen::Vector3d &at, double radius) {
  for (const Eigen::Vector3d &p : b.primaries)
    if (bins.hits(at + p, radius))
      return true;
  return false;
}

} // namespace

Eigen::Vector3d periodic_difference(const Recipe &r, const Eigen::Vector3d &a,
                                    const Eigen::Vector3d &b) {
  Eigen::Vector3d d = a - b;
  d.x() -= r.cell_x * std::round(d.x() / r.cell_x);
  d.y() -= r.cell_y * std::round(d.y() / r.cell_y);
  return d;
}

Eigen::Vector3d in_cell(const Recipe &r, Eigen::Vector3d x) {
  x.x() -= r.cell_x * std::floor(x.x() / r.cell_x);
  x.y() -= r.cell_y * std::floor(x.y() / r.cell_y);
  return x;
}

double primary_density(const Recipe &r) {
  return r.am_density * std::pow(r.lattice, 3) / (kPi / 6.0 * std::pow(r.primary_diameter, 3));
}

double cbd_density(const Recipe &r) { return r.cbd_solid_density * (1.0 - r.nanoporosity); }

int cbd_count(const Recipe &r) {
  const double sphere = kPi / 6.0 * std::pow(r.cbd_diameter, 3) * (1.0 - r.nanoporosity);
  return static_cast<int>(std::lround(r.cbd_solid_column() * r.area() / sphere));
}

Placement place(const Recipe &recipe, const std::vector<Body> &bodies) {
  Random random(recipe.seed, 3);
  const double R = 0.5 * recipe.primary_diameter, Rc = 0.5 * recipe.cbd_diameter;
  const double envelope =
      recipe.am_column() + recipe.cbd_solid_column() / (1.0 - recipe.nanoporosity);
  Placement out;
  out.height = 3.0 * envelope;
  Bins bins(recipe, 1.05 * std::max(recipe.primary_diameter, recipe.cbd_diameter));
  const auto anywhere = [&](double reach) {
    const Eigen::Vector3d u = random.uniform3();
    return Eigen::Vector3d(recipe.cell_x * u.x(), recipe.cell_y * u.y(),
                           reach + (out.height - 2.0 * reach) * u.z());
  };
  int number = 0;
  for (const Body &b : bodies) {
    ++number;
    Eigen::Vector3d at = anywhere(b.reach);
    for (int tries = 1; body_hits(bins, b, at, 1.02 * R); ++tries, at = anywhere(b.reach))
      if (tries % 20000 == 0)
        out.height *= 1.1; // no room: a taller cell
    for (const Eigen::Vector3d &p : b.primaries) {
      bins.add(at + p, R);
      out.particles.push_back({static_cast<int>(out.particles.size()) + 1, 1,
                               recipe.primary_diameter, primary_density(recipe), at + p, number});
    }
  }
  for (int n = cbd_count(recipe); n > 0; --n) {
    Eigen::Vector3d at = anywhere(Rc);
    for (int tries = 1; bins.hits(at, Rc); ++tries, at = anywhere(Rc))
      if (tries % 20000 == 0)
        out.height *= 1.1;
    bins.add(at, Rc);
    out.particles.push_back({static_cast<int>(out.particles.size()) + 1, 2, recipe.cbd_diameter,
                             cbd_density(recipe), at, 0});
  }
  for (Particle &p : out.particles)
    p.x = in_cell(recipe, p.x);
  return out;
}

} // namespace calendem
