// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/slurry/spheres.h"
#include "base/pi.h"
#include "base/random.h"
#include "electrode/pack/sphere_bins.h"
#include <cmath>

namespace calendem {

Placement place_spheres(const FilmRecipe &film, const std::vector<int> &counts) {
  const Recipe &r = film.recipe;
  const auto diameter = [&](int count) { return r.lattice * std::cbrt(6.0 / kPi * count); };
  Random random(r.seed, 5);
  Placement out;
  out.height = 1.5 * film.slurry_thickness();
  SphereBins bins(r, 1.02 * std::max(diameter(counts.front()), r.cbd_diameter));
  const auto add = [&](int type, double d, double density) {
    Eigen::Vector3d x;
    int tries = 0;
    do {
      const Eigen::Vector3d u = random.uniform3();
      x = {r.cell_x * u.x(), r.cell_y * u.y(), 0.5 * d + (out.height - d) * u.z()};
      if (++tries % 20000 == 0)
        out.height *= 1.1; // no room: a taller cell
    } while (bins.hits(x, 0.5 * d));
    bins.add(x, 0.5 * d);
    out.particles.push_back({int(out.particles.size()) + 1, type, d, density, x, 0});
  };
  for (const int count : counts)
    add(1, diameter(count), r.am_density);
  for (int n = cbd_count(r); n > 0; --n)
    add(2, r.cbd_diameter, cbd_density(r));
  return out;
}

double mixing_index(const std::vector<Particle> &particles, double height, int slabs) {
  std::vector<double> all(slabs, 0.0), cbd(slabs, 0.0);
  double total = 0.0, total_cbd = 0.0;
  for (const Particle &p : particles) {
    const int k = std::min(slabs - 1, std::max(0, int(slabs * p.x.z() / height)));
    all[k] += 1.0;
    total += 1.0;
    if (p.type == 2) {
      cbd[k] += 1.0;
      total_cbd += 1.0;
    }
  }
  const double share = total_cbd / total, separated = share * (1.0 - share);
  const double random = separated * slabs / total;
  double variance = 0.0;
  for (int k = 0; k < slabs; ++k)
    if (all[k] > 0.0)
      variance += all[k] / total * std::pow(cbd[k] / all[k] - share, 2);
  return (separated - variance) / (separated - random);
}

} // namespace calendem
