// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/placement.h"
#include "physics/pi.h"
#include <cmath>

namespace calendem {
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
  SphereBins bins(recipe, 1.05 * std::max(recipe.primary_diameter, recipe.cbd_diameter));
  const auto anywhere = [&](double reach) {
    const Eigen::Vector3d u = random.uniform3();
    return Eigen::Vector3d(recipe.cell_x * u.x(), recipe.cell_y * u.y(),
                           reach + (out.height - 2.0 * reach) * u.z());
  };
  int number = 0;
  for (const Body &b : bodies) {
    ++number;
    Eigen::Vector3d at = anywhere(b.reach);
    for (int tries = 1; bins.hits(b, at, 1.02 * R); ++tries, at = anywhere(b.reach))
      if (tries % 20000 == 0)
        out.height *= 1.1; // no room: a taller cell
    for (const Eigen::Vector3d &p : b.primaries) {
      bins.add(at + p, R);
      out.particles.push_back({static_cast<int>(out.particles.size()) + 1, 1,
                               recipe.primary_diameter, primary_density(recipe), at + p, number});
    }
  }
  Random choice(recipe.seed, 4);
  for (int n = cbd_count(recipe); n > 0;) {
    Eigen::Vector3d at = anywhere(Rc);
    for (int tries = 1; bins.hits(at, Rc); ++tries, at = anywhere(Rc))
      if (tries % 20000 == 0)
        out.height *= 1.1;
    bins.add(at,
             Rc); // also if it is not kept: the next ones then find the room of all heights alike
    if (choice.uniform() >= recipe.cbd_gradient.kept((at.z() - Rc) / (out.height - 2.0 * Rc)))
      continue;
    --n;
    out.particles.push_back({static_cast<int>(out.particles.size()) + 1, 2, recipe.cbd_diameter,
                             cbd_density(recipe), at, 0});
  }
  for (Particle &p : out.particles)
    p.x = in_cell(recipe, p.x);
  return out;
}

} // namespace calendem
