// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/given_placement.h"
#include "electrode/pack/sphere_bins.h"

namespace calendem {
namespace {

void turn(Body &b, const Eigen::Quaterniond &q) {
  for (Eigen::Vector3d &p : b.primaries)
    p = q * p;
  b.lattice = (q * b.lattice).normalized();
}

class Placer {
public:
  Placer(const Recipe &recipe, double stretch, double widest)
      : recipe_(recipe), random_(recipe.seed, 3), bins_(recipe, 1.05 * widest) {
    out_.stretch = stretch;
  }

  /// `free(at)`: there is room at that place, as high as stretched; it may turn what it places.
  template <class Free> Eigen::Vector3d find(const Eigen::Vector3d &x, double reach, Free free) {
    constexpr double kStep = 0.005; // [um] farther with every try
    const Eigen::Vector3d stretched(1.0, 1.0, out_.stretch);
    for (int tries = 0;; ++tries) {
      const Eigen::Vector3d move = tries == 0
                                       ? Eigen::Vector3d::Zero()
                                       : Eigen::Vector3d(kStep * tries * random_.direction());
      Eigen::Vector3d at = (x + move).cwiseProduct(stretched);
      at.z() = std::max(at.z(), reach);
      if (!free(at, tries))
        continue;
      out_.moved += tries > 0;
      out_.largest_move_um = std::max(out_.largest_move_um, move.norm());
      out_.loose.height = std::max(out_.loose.height, at.z() + reach);
      return at;
    }
  }

  void place_body(Body &b, const Eigen::Vector3d &x, bool may_turn, int number) {
    const double R = 0.5 * recipe_.primary_diameter;
    const Eigen::Vector3d at = find(x, b.reach, [&](const Eigen::Vector3d &to, int tries) {
      if (tries > 0 && may_turn)
        turn(b, random_.rotation());
      return !bins_.hits(b, to, 1.02 * R);
    });
    for (const Eigen::Vector3d &p : b.primaries)
      add(1, 2.0 * R, primary_density(recipe_), at + p, number);
  }

  void place_cbd(const GivenSphere &s) {
    const double R = 0.5 * s.diameter;
    const auto free = [&](const Eigen::Vector3d &to, int) { return !bins_.hits(to, R); };
    add(2, s.diameter, recipe_.structure.densities_of_file ? s.density : cbd_density(recipe_),
        find(s.x, R, free), 0);
  }

  GivenPlacement finish() {
    for (Particle &p : out_.loose.particles)
      p.x = in_cell(recipe_, p.x);
    out_.loose.height += 0.1;
    return std::move(out_);
  }

private:
  const Recipe &recipe_;
  Random random_;
  SphereBins bins_;
  GivenPlacement out_;

  void add(int type, double diameter, double density, const Eigen::Vector3d &x, int body) {
    bins_.add(x, 0.5 * diameter);
    const int tag = static_cast<int>(out_.loose.particles.size()) + 1;
    out_.loose.particles.push_back({tag, type, diameter, density, x, body});
  }
};

} // namespace

GivenPlacement place_as_given(const Recipe &r, const GivenStructure &structure,
                              GivenBodies &given) {
  const double envelope = r.am_column() + r.cbd_solid_column() / (1.0 - r.nanoporosity);
  const double stretch = std::max(1.0, 5.0 * envelope / structure.extent);
  Placer placer(r, stretch, std::max(r.primary_diameter, r.cbd_diameter));
  for (size_t k = 0; k < given.bodies.size(); ++k)
    placer.place_body(given.bodies[k], given.at[k], !r.structure.clusters, int(k) + 1);
  for (const GivenSphere &s : structure.cbd)
    placer.place_cbd(s);
  return placer.finish();
}

} // namespace calendem
