// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/given_bodies.h"
#include "electrode/pack/given_recipe.h"
#include "electrode/pack/placement.h"
#include "electrode/pack/sizes.h"
#include "electrode/structure/smooth_surface.h"
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace calendem {
namespace {

// Members of each cluster; what belongs to none is a body of its own.
std::vector<std::vector<GivenSphere>> clusters_of(const std::vector<GivenSphere> &am) {
  std::map<long, std::vector<GivenSphere>> by_id;
  std::vector<std::vector<GivenSphere>> out;
  for (const GivenSphere &p : am)
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
std::vector<Eigen::Vector3d> join(const Recipe &r, std::vector<GivenSphere> &members) {
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
    return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), u);
  Eigen::Matrix3d R;
  R << u, (w - w.dot(u) * u).normalized(), u.cross(w).normalized();
  return Eigen::Quaterniond(R);
}

// Of the union of the primaries and their cells of the lattice, its surface smoothed.
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

GivenBodies bodies_of_spheres(const Recipe &recipe, const GivenStructure &structure,
                              const MakeBody &make) {
  std::vector<GivenSphere> am = structure.am;
  std::stable_sort(am.begin(), am.end(), [](const GivenSphere &a, const GivenSphere &b) {
    return a.diameter > b.diameter;
  });
  std::vector<double> diameters;
  double volume = 0.0;
  for (const GivenSphere &p : am) {
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
  GivenBodies out;
  Random random(recipe.seed, 2);
  for (size_t k = 0; k < am.size(); ++k) {
    out.bodies.push_back(make(counts[k], random));
    out.at.push_back(am[k].x);
    out.ids.push_back({am[k].id});
  }
  return out;
}

GivenBodies bodies_of_clusters(const Recipe &recipe, const GivenStructure &structure) {
  Mistakes mistakes(recipe.file);
  GivenBodies out;
  for (std::vector<GivenSphere> &members : clusters_of(structure.am)) {
    const long cluster = members.front().cluster, first = members.front().id;
    const std::vector<Eigen::Vector3d> x = join(recipe, members);
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    const Eigen::Vector3d centre = std::accumulate(x.begin(), x.end(), none) / double(x.size());
    out.bodies.push_back(cluster_body(recipe, x, centre));
    out.at.push_back(centre);
    out.ids.emplace_back();
    for (const GivenSphere &p : members)
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

} // namespace calendem
