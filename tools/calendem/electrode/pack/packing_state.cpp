// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/packing_state.h"
#include "physics/hertz_contact.h"
#include "physics/sjkr_cohesion.h"
#include "registry/settings.h"
#include <algorithm>
#include <cmath>
#include <map>

namespace calendem {
namespace {

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
  return std::fabs(repulsion - sjkr_force(std::sqrt(ced(p) * ced(q)), r, Rp, Rq));
}

void note(Overlaps &o, double overlap) {
  ++o.pairs;
  o.mean += (overlap - o.mean) / o.pairs;
  o.largest = std::max(o.largest, overlap);
}

void note_contact(PackingState &s, const Particle &p, const Particle &q, double r,
                  const Recipe &recipe, const FinalMaterial &material) {
  const double overlap = 0.5 * (p.diameter + q.diameter) - r;
  if (p.type == 1 && q.type == 1 && p.body == q.body) {
    ++s.bonds;
    ++s.body_bonds[p.body - 1];
  } else if (p.type == 1 && q.type == 1) {
    s.body_force_nN = std::max(s.body_force_nN, pair_force(p, q, r, material));
  } else if (p.type == 2 && q.type == 2) {
    note(s.cbd_cbd, overlap / (0.5 * recipe.cbd_diameter));
  } else {
    note(s.cbd_am, overlap / (0.5 * recipe.cbd_diameter));
    s.am_cbd_force_nN = std::max(s.am_cbd_force_nN, pair_force(p, q, r, material));
  }
}

// Pairs of the body's primaries that touch as it was made, and how far those that still do are
// stretched; `first`: its first particle.
void note_pairs(PackingState &s, const Body &b, const Particle *first, const Recipe &recipe) {
  for (size_t i = 0; i < b.primaries.size(); ++i)
    for (size_t j = i + 1; j < b.primaries.size(); ++j) {
      const double made = (b.primaries[i] - b.primaries[j]).norm();
      if (made >= recipe.primary_diameter)
        continue;
      ++s.lattice_pairs;
      const double r = periodic_difference(recipe, first[i].x, first[j].x).norm();
      if (r < recipe.primary_diameter)
        s.bond_strain = std::max(s.bond_strain, std::fabs(r / made - 1.0));
    }
}

} // namespace

double case_default(const std::string &key) {
  const auto is = [&](const Key &k) { return k.name == key; };
  return std::stod(std::find_if(case_keys().begin(), case_keys().end(), is)->fallback);
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
      const double sum = 0.5 * (p.diameter + q.diameter);
      if (std::fabs(p.x.z() - q.x.z()) >= sum)
        continue;
      const double r = periodic_difference(recipe, p.x, q.x).norm();
      if (r < sum)
        note_contact(s, p, q, r, recipe, material);
    }
  }
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
        if (d.norm() < 0.5 * (p.diameter + q.diameter))
          bonds.emplace_back(list[a], list[b]);
      }
  return bonds;
}

} // namespace calendem
