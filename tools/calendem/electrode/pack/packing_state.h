// SPDX-License-Identifier: GPL-2.0-or-later
// A packing, from its loose start (bodies and CBD spheres without overlap in a tall cell, for the
// simulation to densify) to what is measured of it when finished, from positions alone: overlaps,
// forces, the volume that a tomogram shows as solid, where each body ended.
#ifndef CALENDEM_ELECTRODE_PACK_PACKING_STATE_H
#define CALENDEM_ELECTRODE_PACK_PACKING_STATE_H

#include "electrode/pack/body.h"
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace calendem {

struct Particle {
  int tag = 0;
  int type = 0; ///< 1 primary sphere, 2 CBD
  double diameter = 0.0, density = 0.0;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  int body = 0; ///< 0: none
};

struct Placement {
  std::vector<Particle> particles; ///< by tag; primaries first, body by body
  double height = 0.0;             ///< of the tall cell [um]
};

/// Density [g/cm3] of a primary sphere with which a body weighs its envelope volume times
/// am_density.
double primary_density(const Recipe &recipe);
/// Density [g/cm3] of a CBD sphere, nanopores included.
double cbd_density(const Recipe &recipe);
int cbd_count(const Recipe &recipe);

/// a - b as it comes nearest in a cell that is periodic in x and y.
Eigen::Vector3d periodic_difference(const Recipe &recipe, const Eigen::Vector3d &a,
                                    const Eigen::Vector3d &b);
/// The image of x inside the cell.
Eigen::Vector3d in_cell(const Recipe &recipe, Eigen::Vector3d x);

/// Bodies (largest first) and then CBD spheres at random places without overlap, in a cell three
/// times as high as they need, or higher where they find no room.
Placement place(const Recipe &recipe, const std::vector<Body> &bodies);

class SphereBins {
public:
  /// Spheres may have up to `width` [um] in diameter.
  SphereBins(const Recipe &r, double width)
      : recipe_(r), nx_(std::max(1, int(r.cell_x / width))),
        ny_(std::max(1, int(r.cell_y / width))), width_(width) {}

  void add(const Eigen::Vector3d &x, double radius) { bins_[key(index(x))].push_back({x, radius}); }

  /// True if a sphere overlaps one that is there.
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
  /// As hits() for a body whose centre is at `at` and whose primaries have this radius.
  bool hits(const Body &body, const Eigen::Vector3d &at, double radius) const {
    return std::any_of(body.primaries.begin(), body.primaries.end(),
                       [&](const Eigen::Vector3d &p) { return hits(at + p, radius); });
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

/// Stiffness and cohesion at which a packing is relaxed and its forces are judged: the material's, of
/// what it does not say a case's. Handed to in.pack as variables.
struct FinalMaterial {
  explicit FinalMaterial(const ReferenceMaterial &material = {});
  double E_am_GPa, E_cbd_GPa, nu_am, nu_cbd, ced_am_J_m3, ced_cbd_J_m3;
};

/// Overlaps of touching pairs over the radius of the CBD sphere.
struct Overlaps {
  int pairs = 0;
  double mean = 0.0, largest = 0.0;
};

struct PackingState {
  double body_force_nN = 0.0;   ///< largest |Hertz - SJKR| between primaries of different bodies
  double am_cbd_force_nN = 0.0; ///< the same between primaries and CBD
  /// In the plane, of the contacts between bodies and CBD, over the film's volume; positive: the
  /// film would spread. A film at rest has next to none.
  double film_stress_MPa = 0.0;
  Overlaps cbd_cbd, cbd_am;
  int bonds = 0;               ///< pairs of a body's primaries within the distance of a bond
  int pairs_as_made = 0;       ///< within it in the bodies as made
  int pairs_changed = 0;       ///< within it then or now, by more than a bond at rest is strained
  double bond_strain = 0.0;    ///< largest |r/r_made - 1| of them
  double highest_um = 0.0;     ///< top of the highest particle
  std::vector<int> body_bonds; ///< per body
};

PackingState examine(const Recipe &recipe, const std::vector<Body> &bodies,
                     const std::vector<Particle> &particles,
                     const FinalMaterial &material = FinalMaterial());

/// Index pairs of one body's particles within the distance of a bond, periodic in x and y.
std::vector<std::pair<int, int>> bonds_by_distance(const std::vector<Particle> &particles,
                                                   double lx, double ly);

struct Pose {
  Eigen::Vector3d centre;  ///< of mass, inside the cell [um]
  Eigen::Quaterniond turn; ///< orientation of the cubic lattice; a single primary keeps its first
  double distortion = 0.0; ///< largest distance of a primary from the rigid body [um]
};

/// Poses in the order of `bodies`, whose primaries are the first particles, body by body.
std::vector<Pose> find_poses(const Recipe &recipe, const std::vector<Body> &bodies,
                             const std::vector<Particle> &particles);

struct Envelope {
  double am = 0.0;    ///< union of the bodies' envelopes [um^3]
  double total = 0.0; ///< union of those and the CBD spheres [um^3]
};

Envelope measure_envelope(const Recipe &recipe, const std::vector<Particle> &particles,
                          double voxel = 0.2);

} // namespace calendem

#endif
