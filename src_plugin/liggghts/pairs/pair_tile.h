// SPDX-License-Identifier: GPL-2.0-or-later
// Pairs side by side, a value of all pairs next to each other, and what the laws of physics/ make
// of them: written so that the compiler turns them into vector instructions. No host in here.
#ifndef CALENDEM_PAIR_TILE_H
#define CALENDEM_PAIR_TILE_H

#include "physics/bond_pair.h"
#include "physics/contact_pair.h"
#include "physics/fixed_point.h"
#include <algorithm>
#include <cmath>

namespace LAMMPS_NS {

/// Small enough for the cache; rows of 40 numbers do not fall onto the same lines of it.
constexpr int kTilePairs = 40;

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

/// Material of a pair of atom types.
using PairMaterial = calendem::ContactMaterial;

/// Pairs that stay together for many steps, and what is remembered of them from step to step.
struct PairTile {
  int size = 0;
  int i[kTilePairs], j[kTilePairs];
  int material[kTilePairs];    // of their types
  double *history[kTilePairs]; // in the host's lists, as are the flags
  int *flags[kTilePairs];
  Row reference;          // overlap from which the contact counts
  VectorRow displacement; // tangential, of the contact

  void copy(int to, const PairTile &t, int from);
};

/// Intact bonds; they touch as well where they are shorter than at creation.
struct BondTile : PairTile {
  Row length, strength, twist;
  VectorRow shear, bending;

  void copy(int to, const BondTile &t, int from);
  calendem::BondLoads loads(int p) const { return {shear[p], bending[p], twist[p]}; }
};

/// Other pairs, near enough to touch.
struct ContactTile : PairTile {
  Row separating; // 1: of a broken bond, and the spheres have touched ever since

  void copy(int to, const ContactTile &t, int from);
};

/// What a step makes of a tile, on i and the opposite force and torque_j on j.
struct PairStep {
  // both spheres; d = x_i - x_j, v = v_i - v_j
  VectorRow d, v, spin_i, spin_j;
  Row r_squared, radius_i, radius_j, mass_i, mass_j;
  Row contact_radius, elastic; // of the contact's area; force without damping
  VectorRow force, torque_i, torque_j;
  // of these, for the energy ledger: by damping of the bond, of the contact, by its friction
  VectorRow bond_damping, bond_damping_torque_i, bond_damping_torque_j;
  VectorRow contact_damping, friction_force, friction_torque_i, friction_torque_j;
  Row failed; // 1 of a bond that fails
  /// Force, torque_i, torque_j as whole numbers, in units of a FixedPoint, and behind the
  /// components of each its SumCheck.
  alignas(64) unsigned long long whole[3][kTilePairs][4];

  double radius_sum(int p) const { return radius_i[p] + radius_j[p]; }
  bool touches(int p) const { return r_squared[p] < radius_sum(p) * radius_sum(p); }
};

/// Overlap beyond the reference [um], 0 where the contact rests.
inline double acting_overlap(const PairTile &t, const PairStep &s, int p) {
  return calendem::acting_overlap(s.radius_sum(p), std::sqrt(s.r_squared[p]), t.reference[p]);
}

/// True where the contact acts: spheres touch, and the bond is not longer than at creation.
inline bool acts(const ContactTile &, const PairStep &s, int p) { return s.touches(p); }
inline bool acts(const BondTile &t, const PairStep &s, int p) {
  return s.touches(p) & (s.r_squared[p] < t.length[p] * t.length[p]);
}

/// A pair, and a bond, of a tile as their laws see them.
inline calendem::PairMotion motion_of(const PairStep &s, int p) {
  return calendem::pair_motion(s.d[p], std::sqrt(s.r_squared[p]), s.v[p], s.spin_i[p], s.spin_j[p]);
}
inline calendem::BondPair bond_of(const calendem::BondMaterial &m, const BondTile &t,
                                  const PairStep &s, int p) {
  calendem::BondPair pair(m, s.radius_i[p], s.radius_j[p], t.length[p]);
  pair.place(m, t.length[p], motion_of(s, p));
  return pair;
}

/// Loads after a step of length dt [us], which bonds fail, and what they exert; without `update`,
/// as during set-up, loads stay and nothing fails.
void run_bonds(BondTile &, PairStep &, const calendem::BondMaterial &,
               const calendem::BondStrength &, calendem::FailureCriterion, bool update, double dt);
/// Contact radius and elastic force by Hertz' law.
void run_hertz(const PairTile &, PairStep &, const PairMaterial *);
/// Damping, friction and cohesion over a step. Of bonds the results hold the bonds' actions, the
/// contacts' are added and cohesion does not act. The history of a contact is
/// reset while it does not act.
void run_contacts(BondTile &, PairStep &, const PairMaterial *, bool update, double dt);
void run_contacts(ContactTile &, PairStep &, const PairMaterial *, bool update, double dt);
/// Force and torques as whole numbers; as doubles they are gone then. False if one of them is no
/// number, or far too large to be added.
bool round_off(int size, PairStep &, const calendem::FixedPoint &force,
               const calendem::FixedPoint &torque);

} // namespace LAMMPS_NS

#endif
