// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/from_structure.h"
#include "electrode/pack/body.h"
#include "electrode/pack/packing_state.h"
#include "electrode/structure/measured_shape.h"
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace calendem {

namespace {

// Members of each cluster; what belongs to none is a body of its own.
std::vector<std::vector<ExistingSphere>> clusters_of(const std::vector<ExistingSphere> &am) {
  std::map<long, std::vector<ExistingSphere>> by_id;
  std::vector<std::vector<ExistingSphere>> out;
  for (const ExistingSphere &p : am)
    if (p.cluster > 0)
      by_id[p.cluster].push_back(p);
    else
      out.push_back({p});
  for (auto &[id, members] : by_id)
    out.push_back(std::move(members));
  std::stable_sort(out.begin(), out.end(),
                   [](const auto &a, const auto &b) { return a.size() > b.size(); });
  return out;
}

// The members in an order in which each touches one before it, at the image beside that one; the
// places of those that do not hang together with the first are left out.
std::vector<Eigen::Vector3d> join(const Recipe &r, std::vector<ExistingSphere> &members) {
  std::vector<Eigen::Vector3d> x = {members.front().x};
  for (size_t k = 0; k < x.size(); ++k)
    for (size_t j = x.size(); j < members.size(); ++j) {
      const Eigen::Vector3d d = periodic_difference(r, members[j].x, x[k]);
      if (d.norm() < r.primary_diameter) {
        std::swap(members[j], members[x.size()]);
        x.push_back(x[k] + d);
      }
    }
  return x;
}

// The shortest turn of the x axis onto a unit vector; onto its opposite, half a turn about z. Eigen's
// FromTwoVectors, which looks there for an axis by a decomposition that takes long to compile.
Eigen::Quaterniond turn_of_x_onto(const Eigen::Vector3d &u) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), to = u.normalized();
  const double cosine = to.dot(x);
  if (cosine < -1.0 + 1e-12)
    return Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0);
  const double s = std::sqrt((1.0 + cosine) * 2.0);
  const Eigen::Vector3d axis = x.cross(to) * (1.0 / s);
  return Eigen::Quaterniond(0.5 * s, axis.x(), axis.y(), axis.z());
}

// The frame of two pairs that touch at about a right angle, for a cluster on a cubic lattice.
Eigen::Quaterniond frame_of(const std::vector<Eigen::Vector3d> &x, double touching) {
  std::vector<Eigen::Vector3d> pairs;
  for (size_t i = 0; i < x.size(); ++i)
    for (size_t j = i + 1; j < x.size(); ++j)
      if ((x[j] - x[i]).norm() < touching)
        pairs.push_back((x[j] - x[i]).normalized());
  if (pairs.empty())
    return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d u = pairs.front();
  const Eigen::Vector3d w =
      *std::min_element(pairs.begin(), pairs.end(), [&](const auto &a, const auto &b) {
        return std::fabs(a.dot(u)) < std::fabs(b.dot(u));
      });
  if (std::fabs(w.dot(u)) > 0.3)
    return turn_of_x_onto(u);
  Eigen::Matrix3d R;
  R << u, (w - w.dot(u) * u).normalized(), u.cross(w).normalized();
  return Eigen::Quaterniond(R);
}

// Sphericity of the union of the primaries and their cells of the lattice, its surface smoothed.
double sphericity_of(const Recipe &r, const Body &b) {
  if (b.primaries.size() == 1)
    return 1.0;
  const double R = 0.5 * r.primary_diameter, half = 0.5 * r.lattice, voxel = R / 4.0;
  const int n = int(std::ceil(2.0 * (b.reach + r.lattice) / voxel));
  LabelImage image;
  image.n = {n, n, n};
  image.voxel.setConstant(voxel);
  image.label.assign(size_t(n) * n * n, 0);
  const int span = int(std::ceil(std::max(R, std::sqrt(3.0) * half) / voxel)) + 1;
  const Eigen::Matrix3d back = b.lattice.toRotationMatrix().transpose();
  for (const Eigen::Vector3d &p : b.primaries) {
    const Eigen::Array3i c = (p.array() / voxel + 0.5 * n).cast<int>();
    for (int k = c[2] - span; k <= c[2] + span; ++k)
      for (int j = c[1] - span; j <= c[1] + span; ++j)
        for (int i = c[0] - span; i <= c[0] + span; ++i) {
          const Eigen::Vector3d d =
              voxel * (Eigen::Vector3d(i, j, k).array() + 0.5 - 0.5 * n).matrix() - p;
          if (d.norm() < R || (back * d).cwiseAbs().maxCoeff() < half)
            image.label[image.index(i, j, k)] = 1;
        }
  }
  return measure_surface(extract_particle(image, find_regions(image, 0)[0])).sphericity;
}

Body cluster_body(const Recipe &r, std::vector<Eigen::Vector3d> x, const Eigen::Vector3d &centre) {
  Body b;
  b.lattice = frame_of(x, r.primary_diameter);
  b.volume = double(x.size()) * std::pow(r.lattice, 3);
  for (Eigen::Vector3d &p : x) {
    p -= centre;
    b.reach = std::max(b.reach, p.norm() + 0.5 * r.primary_diameter);
  }
  b.width = width_of(x, r.primary_diameter);
  b.primaries = std::move(x);
  b.sphericity = sphericity_of(r, b);
  return b;
}

} // namespace

BodiesOfStructure bodies_of_spheres(const Recipe &recipe, const ExistingStructure &structure,
                                    const MakeBody &make) {
  std::vector<ExistingSphere> am = structure.am;
  std::stable_sort(am.begin(), am.end(), [](const ExistingSphere &a, const ExistingSphere &b) {
    return a.diameter > b.diameter;
  });
  std::vector<double> diameters;
  double volume = 0.0;
  for (const ExistingSphere &p : am) {
    diameters.push_back(p.diameter);
    volume += p.volume();
  }
  const int total = static_cast<int>(std::lround(volume / std::pow(recipe.lattice, 3)));
  const std::vector<int> counts = primary_counts(diameters, recipe.lattice, total);
  if (counts.size() != am.size())
    throw Failure(kBadInput, fmt::format("{}: {} spheres of active material have the volume of {} "
                                         "primaries: not one for each. Give finer primaries "
                                         "(particles.lattice_um and primary_diameter_um).",
                                         recipe.file, am.size(), total));
  BodiesOfStructure out;
  Random random(recipe.seed, 2);
  for (size_t k = 0; k < am.size(); ++k) {
    out.bodies.push_back(make(am[k], counts[k], random));
    out.at.push_back(am[k].x);
    out.ids.push_back({am[k].id});
  }
  return out;
}

BodiesOfStructure bodies_of_clusters(const Recipe &recipe, const ExistingStructure &structure) {
  Mistakes mistakes(recipe.file);
  BodiesOfStructure out;
  for (std::vector<ExistingSphere> &members : clusters_of(structure.am)) {
    const long cluster = members.front().cluster, first = members.front().id;
    const std::vector<Eigen::Vector3d> x = join(recipe, members);
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    const Eigen::Vector3d centre = std::accumulate(x.begin(), x.end(), none) / double(x.size());
    out.bodies.push_back(cluster_body(recipe, x, centre));
    out.at.push_back(centre);
    out.ids.emplace_back();
    for (const ExistingSphere &p : members)
      out.ids.back().push_back(p.id);
    if (x.size() < members.size())
      mistakes.add(0, fmt::format("cluster {} falls apart: {} of its {} primaries do not hang "
                                  "together with particle {} by primaries that overlap. Correct "
                                  "the molecule ids or the body map.",
                                  cluster, members.size() - x.size(), members.size(), first));
    else if (out.bodies.back().width > recipe.widest_body())
      mistakes.add(0,
                   fmt::format("cluster {} (first particle {}) is {:.4g} um wide; at most {:.4g} "
                               "um is allowed in a cell of {:.4g} x {:.4g} um. Give a larger "
                               "structure.",
                               cluster, first, out.bodies.back().width, recipe.widest_body(),
                               recipe.cell_x, recipe.cell_y));
  }
  mistakes.stop_if_any();
  return out;
}

namespace {

void turn(Body &b, const Eigen::Quaterniond &q) {
  for (Eigen::Vector3d &p : b.primaries)
    p = q * p;
  b.lattice = (q * b.lattice).normalized();
}

class StructurePlacer {
public:
  StructurePlacer(const Recipe &recipe, double stretch, double widest)
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

  void place_cbd(const ExistingSphere &s) {
    const double R = 0.5 * s.diameter;
    const auto free = [&](const Eigen::Vector3d &to, int) { return !bins_.hits(to, R); };
    add(2, s.diameter, recipe_.structure.densities_of_file ? s.density : cbd_density(recipe_),
        find(s.x, R, free), 0);
  }

  PlacementOfStructure finish() {
    for (Particle &p : out_.loose.particles)
      p.x = in_cell(recipe_, p.x);
    // the platen comes down to the film's thickness, be what lies there as low as it may
    out_.loose.height = std::max(out_.loose.height, recipe_.thickness()) + 0.1;
    return std::move(out_);
  }

private:
  const Recipe &recipe_;
  Random random_;
  SphereBins bins_;
  PlacementOfStructure out_;

  void add(int type, double diameter, double density, const Eigen::Vector3d &x, int body) {
    bins_.add(x, 0.5 * diameter);
    const int tag = static_cast<int>(out_.loose.particles.size()) + 1;
    out_.loose.particles.push_back({tag, type, diameter, density, x, body});
  }
};

} // namespace

PlacementOfStructure place_as_in_structure(const Recipe &r, const ExistingStructure &structure,
                                           BodiesOfStructure &given) {
  const double envelope = r.am_column() + r.cbd_solid_column() / (1.0 - r.nanoporosity);
  const double stretch = std::max(1.0, 5.0 * envelope / structure.extent);
  StructurePlacer placer(r, stretch, std::max(r.primary_diameter, r.cbd_diameter));
  for (size_t k = 0; k < given.bodies.size(); ++k)
    placer.place_body(given.bodies[k], given.at[k], !r.structure.clusters, int(k) + 1);
  for (const ExistingSphere &s : structure.cbd)
    placer.place_cbd(s);
  return placer.finish();
}

} // namespace calendem
