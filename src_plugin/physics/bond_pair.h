// SPDX-License-Identifier: GPL-2.0-or-later
// A bond and the two spheres that it joins, at one instant: the only place where section, stiffness,
// tension, motion and failure of parallel_bond.h and bond_failure.h meet. The pair loop, the host's
// contact model, bridges, the energy ledger, the bound of the time step and what is written all
// take it from here.
//   R = lambda min(R_i, R_j),  k of R and the length l at creation,  F_n = k_n (r - rest l)
// At a wall the sphere's own radius is the smaller one, and the wall is at rest.
// Range, signs, energy, source: as in the two headers. Verified by
// tests/unit/physics/bond_pair_test.cpp and, through the host, by tests/reliability/same_physics.
#ifndef CALENDEM_PHYSICS_BOND_PAIR_H
#define CALENDEM_PHYSICS_BOND_PAIR_H

#include "bond_failure.h"
#include "parallel_bond.h"
#include <algorithm>

namespace calendem {

/// Primaries of a body are bonded up to this multiple of the sum of their radii. A tessellation of
/// a sphere of a "magic" number of grains has a middle one whose neighbours all lie just beyond 1,
/// and a cubic lattice has its diagonal ones beyond it.
constexpr double kBondReach = 1.04;

struct BondPair {
  BondSection section;
  BondStiffness stiffness;
  PairMotion motion;
  double tension = 0.0; ///< F_n [nN]

  /// @param length at creation [um]
  BondPair(const BondMaterial &m, double radius_i, double radius_j, double length)
      : section(m.radius_ratio * std::min(radius_i, radius_j)), stiffness(m, section, length) {}
  BondPair(const BondMaterial &m, double radius_i, double radius_j, double length,
           const PairMotion &now)
      : BondPair(m, radius_i, radius_j, length) {
    place(m, length, now);
  }

  /// Where the spheres are. In loops over many bonds, after the section: fewer values are alive.
  void place(const BondMaterial &m, double length, const PairMotion &now) {
    motion = now;
    tension = bond_tension(m, stiffness, now.r, length);
  }

  /// Carries the loads through the step of length dt [us] that has led here.
  void advance(BondLoads &loads, double dt) const {
    calendem::advance(loads, motion, stiffness, dt);
  }
  /// @param mass_eff of the pair; at a wall that of the sphere [pg]
  BondDamping damping(const BondMaterial &m, double radius_i, double radius_j,
                      double mass_eff) const {
    return {m, section, stiffness, mass_eff, std::min(radius_i, radius_j)};
  }
  BondAction action(const BondLoads &loads, const BondDamping &damping = {}) const {
    return calendem::action(loads, tension, motion, damping);
  }
  BondAction damping_action(const BondDamping &damping) const {
    return calendem::damping_action(motion, damping);
  }
  bool fails(const BondLoads &loads, const BondStrength &strength,
             FailureCriterion criterion) const {
    return calendem::fails(loads, tension, section, strength, criterion);
  }
  BondStress stress(const BondLoads &loads, FailureCriterion criterion) const {
    return bond_stress(loads, tension, section, criterion);
  }
  double strain_energy(const BondLoads &loads) const {
    return calendem::strain_energy(loads, tension, stiffness);
  }
};

} // namespace calendem

#endif
