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

namespace {

class Placer {
public:
  explicit Placer(const Recipe &r)
      : recipe_(r), random_(r.seed, 3), choice_(r.seed, 4),
        bins_(r, 1.05 * std::max(r.primary_diameter, r.cbd_diameter)) {
    out_.height = 3.0 * (r.am_column() + r.cbd_solid_column() / (1.0 - r.nanoporosity));
  }

  void place_body(const Body &b, int number) {
    const double R = 0.5 * recipe_.primary_diameter;
    const Eigen::Vector3d at =
        find(b.reach, [&](const Eigen::Vector3d &to) { return bins_.hits(b, to, 1.02 * R); });
    for (const Eigen::Vector3d &p : b.primaries)
      add(1, R, primary_density(recipe_), at + p, number);
  }

  /// False if the gradient does not keep it. Its place stays taken, or the next ones would find
  /// more room there than elsewhere.
  bool place_cbd() {
    const double R = 0.5 * recipe_.cbd_diameter;
    const Eigen::Vector3d at =
        find(R, [&](const Eigen::Vector3d &to) { return bins_.hits(to, R); });
    const double z = (at.z() - R) / (out_.height - 2.0 * R);
    const bool kept = choice_.uniform() < recipe_.cbd_gradient.kept(z);
    if (kept)
      add(2, R, cbd_density(recipe_), at, 0);
    else
      bins_.add(at, R);
    return kept;
  }

  Placement finish() {
    for (Particle &p : out_.particles)
      p.x = in_cell(recipe_, p.x);
    return std::move(out_);
  }

private:
  const Recipe &recipe_;
  Random random_, choice_;
  SphereBins bins_;
  Placement out_;

  Eigen::Vector3d anywhere(double reach) {
    const Eigen::Vector3d u = random_.uniform3();
    return {recipe_.cell_x * u.x(), recipe_.cell_y * u.y(),
            reach + (out_.height - 2.0 * reach) * u.z()};
  }

  template <class Hits> Eigen::Vector3d find(double reach, Hits hits) {
    Eigen::Vector3d at = anywhere(reach);
    for (int tries = 1; hits(at); ++tries, at = anywhere(reach))
      if (tries % 20000 == 0)
        out_.height *= 1.1; // no room: a taller cell
    return at;
  }

  void add(int type, double radius, double density, const Eigen::Vector3d &x, int body) {
    bins_.add(x, radius);
    const int tag = static_cast<int>(out_.particles.size()) + 1;
    out_.particles.push_back({tag, type, 2.0 * radius, density, x, body});
  }
};

} // namespace

Placement place(const Recipe &recipe, const std::vector<Body> &bodies) {
  Placer placer(recipe);
  int number = 0;
  for (const Body &b : bodies)
    placer.place_body(b, ++number);
  for (int n = cbd_count(recipe); n > 0;)
    n -= placer.place_cbd();
  return placer.finish();
}

} // namespace calendem
