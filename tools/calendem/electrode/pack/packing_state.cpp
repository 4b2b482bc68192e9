// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/packing_state.h"
#include "effects/settings.h"
#include "electrode/structure/phase_image.h"
#include "physics/bond_pair.h"
#include "physics/hertz_contact.h"
#include "physics/pi.h"
#include "physics/sjkr_cohesion.h"
#include <algorithm>
#include <cmath>
#include <map>

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
    out_.height = std::max(3.0 * (r.am_column() + r.cbd_solid_column() / (1.0 - r.nanoporosity)),
                           1.2 * r.thickness());
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

namespace {

// Repulsive ones are positive.
double pair_force(const Particle &p, const Particle &q, double r, const FinalMaterial &m) {
  constexpr double kGPa = 1e6, kJ_m3 = 1e-3; // in kPa
  const auto E = [&](const Particle &a) { return kGPa * (a.type == 1 ? m.E_am_GPa : m.E_cbd_GPa); };
  const auto nu = [&](const Particle &a) { return a.type == 1 ? m.nu_am : m.nu_cbd; };
  const auto ced = [&](const Particle &a) {
    return kJ_m3 * (a.type == 1 ? m.ced_am_J_m3 : m.ced_cbd_J_m3);
  };
  const double Rp = 0.5 * p.diameter, Rq = 0.5 * q.diameter;
  const double repulsion = hertz_force(effective_modulus(E(p), nu(p), E(q), nu(q)),
                                       effective_radius(Rp, Rq), Rp + Rq - r);
  return repulsion - sjkr_force(std::sqrt(ced(p) * ced(q)), r, Rp, Rq);
}

void note(Overlaps &o, double overlap) {
  ++o.pairs;
  o.mean += (overlap - o.mean) / o.pairs;
  o.largest = std::max(o.largest, overlap);
}

bool in_one_body(const Particle &p, const Particle &q) {
  return p.type == 1 && q.type == 1 && p.body == q.body;
}

void note_contact(PackingState &s, const Particle &p, const Particle &q, const Eigen::Vector3d &d,
                  const Recipe &recipe, const FinalMaterial &material) {
  const double r = d.norm();
  const bool bonded = in_one_body(p, q);
  const double force = bonded ? 0.0 : pair_force(p, q, r, material);
  s.film_stress_MPa += 0.5e-3 * force * (d.x() * d.x() + d.y() * d.y()) / r; // times volume
  const double overlap = 0.5 * (p.diameter + q.diameter) - r;
  if (bonded) {
    ++s.bonds;
    ++s.body_bonds[p.body - 1];
  } else if (p.type == 1 && q.type == 1) {
    s.body_force_nN = std::max(s.body_force_nN, std::fabs(force));
  } else if (p.type == 2 && q.type == 2) {
    note(s.cbd_cbd, overlap / (0.5 * recipe.cbd_diameter));
  } else {
    note(s.cbd_am, overlap / (0.5 * recipe.cbd_diameter));
    s.am_cbd_force_nN = std::max(s.am_cbd_force_nN, std::fabs(force));
  }
}

// A body at rest has bonds strained by less. Of pairs about the distance up to which primaries are
// bonded, one that moves no more may come to be bonded, or not.
constexpr double kBondStrain = 0.01;

// Pairs of the body's primaries that are bonded as it was made, and how far those that still are
// are stretched; `first`: its first particle.
void note_pairs(PackingState &s, const Body &b, const Particle *first, const Recipe &recipe) {
  for (size_t i = 0; i < b.primaries.size(); ++i)
    for (size_t j = i + 1; j < b.primaries.size(); ++j) {
      const double made = (b.primaries[i] - b.primaries[j]).norm();
      const double r = periodic_difference(recipe, first[i].x, first[j].x).norm();
      const bool was = made < recipe.bond_distance(), is = r < recipe.bond_distance();
      s.pairs_as_made += was;
      s.pairs_changed += was != is && std::fabs(r / made - 1.0) > kBondStrain;
      if (was && is)
        s.bond_strain = std::max(s.bond_strain, std::fabs(r / made - 1.0));
    }
}

} // namespace

FinalMaterial::FinalMaterial(const ReferenceMaterial &material) {
  Settings s;
  take_values(material, case_keys(), s);
  fill_in(case_keys(), s);
  E_am_GPa = s.number("material.am.youngs_modulus_GPa");
  E_cbd_GPa = s.number("material.cbd.youngs_modulus_GPa");
  nu_am = s.number("material.am.poisson");
  nu_cbd = s.number("material.cbd.poisson");
  ced_am_J_m3 = s.number("material.am.ced_J_m3");
  ced_cbd_J_m3 = s.number("material.cbd.ced_J_m3");
}

PackingState examine(const Recipe &recipe, const std::vector<Body> &bodies,
                     const std::vector<Particle> &particles, const FinalMaterial &material) {
  PackingState s;
  s.body_bonds.assign(bodies.size(), 0);
  const Particle *first = particles.data();
  for (const Body &b : bodies) {
    note_pairs(s, b, first, recipe);
    first += b.primaries.size();
  }
  for (size_t i = 0; i < particles.size(); ++i) {
    const Particle &p = particles[i];
    s.highest_um = std::max(s.highest_um, p.x.z() + 0.5 * p.diameter);
    for (size_t j = i + 1; j < particles.size(); ++j) {
      const Particle &q = particles[j];
      const double sum =
          in_one_body(p, q) ? recipe.bond_distance() : 0.5 * (p.diameter + q.diameter);
      if (std::fabs(p.x.z() - q.x.z()) >= sum)
        continue;
      const Eigen::Vector3d d = periodic_difference(recipe, p.x, q.x);
      if (d.norm() < sum)
        note_contact(s, p, q, d, recipe, material);
    }
  }
  s.film_stress_MPa /= recipe.cell_x * recipe.cell_y * s.highest_um;
  return s;
}

std::vector<std::pair<int, int>> bonds_by_distance(const std::vector<Particle> &particles,
                                                   double lx, double ly) {
  std::map<int, std::vector<int>> members;
  for (size_t i = 0; i < particles.size(); ++i)
    if (particles[i].body > 0)
      members[particles[i].body].push_back(static_cast<int>(i));
  std::vector<std::pair<int, int>> bonds;
  for (const auto &[body, list] : members)
    for (size_t a = 0; a < list.size(); ++a)
      for (size_t b = a + 1; b < list.size(); ++b) {
        const Particle &p = particles[list[a]], &q = particles[list[b]];
        Eigen::Vector3d d = p.x - q.x;
        d.x() -= lx * std::round(d.x() / lx);
        d.y() -= ly * std::round(d.y() / ly);
        if (d.norm() < kBondReach * 0.5 * (p.diameter + q.diameter))
          bonds.emplace_back(list[a], list[b]);
      }
  return bonds;
}

Envelope measure_envelope(const Recipe &recipe, const std::vector<Particle> &particles,
                          double voxel) {
  std::vector<Sphere> spheres;
  double height = 0.0;
  for (const Particle &p : particles) {
    spheres.push_back({p.x, 0.5 * p.diameter, p.body});
    height = std::max(height, p.x.z() + 0.5 * p.diameter + recipe.lattice);
  }
  const PhaseImage image =
      voxelise(spheres, {recipe.cell_x, recipe.cell_y, height}, recipe.lattice, voxel);
  Envelope out;
  for (size_t v = 0; v < image.label.size(); ++v) {
    out.am += image.voxel.prod() * (image.phase(v) == VoxelPhase::am);
    out.total += image.voxel.prod() * (image.phase(v) != VoxelPhase::pore);
  }
  return out;
}

namespace {

// Each primary touches an earlier one (bodies are grown that way): take its image next to that one.
Eigen::Matrix3Xd join(const Recipe &recipe, const Body &body, const Particle *first) {
  const Eigen::Index n = static_cast<Eigen::Index>(body.primaries.size());
  Eigen::Matrix3Xd x(3, n);
  x.col(0) = first[0].x;
  for (Eigen::Index k = 1; k < n; ++k) {
    Eigen::Index j = 0;
    while (j < k - 1 && (body.primaries[k] - body.primaries[j]).norm() >= recipe.bond_distance())
      ++j;
    x.col(k) = x.col(j) + periodic_difference(recipe, first[k].x, x.col(j));
  }
  return x;
}

} // namespace

std::vector<Pose> find_poses(const Recipe &recipe, const std::vector<Body> &bodies,
                             const std::vector<Particle> &particles) {
  std::vector<Pose> poses;
  const Particle *first = particles.data();
  for (const Body &b : bodies) {
    const Eigen::Matrix3Xd x = join(recipe, b, first);
    const Eigen::Map<const Eigen::Matrix3Xd> shape(b.primaries.front().data(), 3, x.cols());
    first += b.primaries.size();
    const Eigen::Vector3d mean = x.rowwise().mean();
    Pose pose{in_cell(recipe, mean), b.lattice, 0.0};
    if (x.cols() > 1) {
      const Eigen::Matrix3d R = Eigen::umeyama(shape, x, false).topLeftCorner<3, 3>();
      pose.turn = (Eigen::Quaterniond(R) * b.lattice).normalized();
      pose.distortion = ((x.colwise() - mean) - R * shape).colwise().norm().maxCoeff();
    }
    poses.push_back(pose);
  }
  return poses;
}

} // namespace calendem
