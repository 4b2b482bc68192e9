// SPDX-License-Identifier: GPL-2.0-or-later
// Pairs side by side, a value of all pairs next to each other, and what the laws of physics/ make
// of them: written so that the compiler turns them into vector instructions. No host in here.
#ifndef CALENDEM_PAIR_TILE_H
#define CALENDEM_PAIR_TILE_H

#include "physics/bond_failure.h"
#include "physics/fixed_point.h"
#include "physics/parallel_bond.h"
#include <algorithm>
#include <cmath>

namespace LAMMPS_NS {

/// Small enough for the cache; rows of 72 numbers do not fall onto the same lines of it.
constexpr int kTilePairs = 72;

/// One number for each pair of a tile.
struct Row {
  alignas(64) double at[kTilePairs];
  double &operator[](int p) { return at[p]; }
  double operator[](int p) const { return at[p]; }
};

/// One vector for each pair of a tile.
struct VectorRow {
  Row x, y, z;
  calendem::Vec3 operator[](int p) const { return {x[p], y[p], z[p]}; }
  void set(int p, const calendem::Vec3 &v) {
    x[p] = v.x;
    y[p] = v.y;
    z[p] = v.z;
  }
};

/// What acts on the two spheres of each pair, in units of a FixedPoint.
struct WholeRow {
  alignas(64) long long at[kTilePairs];
  long long operator[](int p) const { return at[p]; }
};

/// Pairs of one kind and what acts between them: on i, the opposite force and torque_j on j.
struct PairTile {
  int size = 0;
  // both spheres; d = x_i - x_j, v = v_i - v_j
  VectorRow d, v, spin_i, spin_j;
  Row r_squared, radius_i, radius_j, mass_i, mass_j;
  // results
  VectorRow force, torque_i, torque_j;
  WholeRow whole[9]; // force, torque_i, torque_j as whole numbers
  // of these, for the energy ledger: by damping of the bond, of the contact, by its friction
  VectorRow bond_damping, bond_damping_torque_i, bond_damping_torque_j;
  VectorRow contact_damping, friction_force, friction_torque_i, friction_torque_j;
  // the bond
  Row length, strength, twist;
  VectorRow shear, bending;
  Row stretch, failed; // distance over the sum of radii; 1 if it fails
  // the contact
  Row modulus, shear_modulus, damping, friction, cohesion; // of its materials
  Row reference;                                           // overlap from which it counts
  Row contact_radius, elastic;                             // of its area; force without damping
  VectorRow displacement;                                  // tangential
};

/// Overlap beyond the reference [um], 0 where the contact rests.
inline double acting_overlap(const PairTile &t, int p) {
  const double beyond = t.radius_i[p] + t.radius_j[p] - std::sqrt(t.r_squared[p]) - t.reference[p];
  return beyond > 0.0 ? beyond : 0.0;
}

inline calendem::BondLoads loads_of(const PairTile &t, int p) {
  return {t.shear[p], t.bending[p], t.twist[p]};
}

/// A bond of a tile as its law sees it.
struct BondPair {
  calendem::BondSection section;
  calendem::BondStiffness stiffness;
  calendem::PairMotion motion;
  double tension; ///< [nN]

  BondPair(const calendem::BondMaterial &m, const PairTile &t, int p)
      : section(m.radius_ratio * std::min(t.radius_i[p], t.radius_j[p])),
        stiffness(m, section, t.length[p]) {
    const double r = std::sqrt(t.r_squared[p]);
    const calendem::Vec3 d = t.d[p];
    motion = {d, t.v[p], t.spin_i[p], t.spin_j[p], (1.0 / r) * d, r};
    tension = stiffness.normal * (r - t.length[p]);
  }
};

/// Loads after a step of length dt [us], which bonds fail, and what they exert; without `update`,
/// as during set-up, loads stay and nothing fails.
void run_bonds(PairTile &, const calendem::BondMaterial &, const calendem::BondStrength &,
               calendem::FailureCriterion, bool update, double dt);
/// Contact radius and elastic force by Hertz' law.
void run_hertz(PairTile &);
/// Damping, friction and cohesion over a step. `bonded`: the results hold the bonds' actions, the
/// contacts' are added and cohesion does not act.
void run_contacts(PairTile &, bool bonded, bool update, double dt);
/// Force and torques as whole numbers.
void round_off(PairTile &, const calendem::FixedPoint &force, const calendem::FixedPoint &torque);

} // namespace LAMMPS_NS

#endif
