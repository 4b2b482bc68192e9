// SPDX-License-Identifier: GPL-2.0-or-later
#include "pair_tile.h"
#include "physics/sjkr_cohesion.h"
#include <algorithm>
#include <cmath>
#include <type_traits>

using namespace LAMMPS_NS;
using calendem::BondMaterial;
using calendem::BondStrength;
using calendem::FailureCriterion;
using calendem::SumCheck;
using calendem::Vec3;

namespace {

double effective_mass(const PairStep &s, int p) {
  return calendem::effective_mass(s.mass_i[p], s.mass_j[p]);
}

// `kUpdate`: histories advance. `kDamped`: bonds have viscous damping. `kCriterion` is a constant
// so that the loop has no branch; material and strength are copies, which nothing stored can
// change.
template <bool kUpdate, bool kDamped, FailureCriterion kCriterion>
__attribute__((flatten)) void run_bonds(BondTile &t, PairStep &s, const BondMaterial material,
                                        const BondStrength strength, double dt) {
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const calendem::BondPair pair = bond_of(material, t, s, p);
    calendem::BondLoads loads = t.loads(p);
    if (kUpdate) {
      pair.advance(loads, dt);
      t.shear.set(p, loads.shear);
      t.bending.set(p, loads.bending);
      t.twist[p] = loads.twist;
      const double factor = t.strength[p];
      const BondStrength own = {factor * strength.tensile, factor * strength.shear};
      s.failed[p] = pair.fails(loads, own, kCriterion) ? 1.0 : 0.0;
    }
    calendem::BondDamping damping;
    if (kDamped)
      damping = pair.damping(material, s.radius_i[p], s.radius_j[p], effective_mass(s, p));
    const calendem::BondAction a = pair.action(loads, damping);
    s.force.set(p, a.force);
    s.torque_i.set(p, a.torque_i);
    s.torque_j.set(p, a.torque_j);
    if (!kDamped)
      continue;
    const calendem::BondAction d = pair.damping_action(damping);
    s.bond_damping.set(p, d.force);
    s.bond_damping_torque_i.set(p, d.torque_i);
    s.bond_damping_torque_j.set(p, d.torque_j);
  }
}

calendem::ContactPair contact_of(const PairStep &s, int p, bool rests) {
  return {motion_of(s, p), s.radius_i[p], s.radius_j[p], rests, s.contact_radius[p] > 0.0};
}

template <bool kUpdate, class Tile>
__attribute__((flatten)) void run_contacts(Tile &t, PairStep &s, const PairMaterial *materials,
                                           double dt) {
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const bool acting = acts(t, s, p);
    const bool rests = acting_overlap(t, s, p) == 0.0;
    const calendem::ContactPair pair = contact_of(s, p, rests);
    const PairMaterial &m = materials[t.material[p]];
    const calendem::ContactResistance resistance =
        calendem::contact_resistance(m, s.contact_radius[p], effective_mass(s, p));
    Vec3 displacement = select(!rests, t.displacement[p]);
    if (kUpdate)
      displacement = calendem::slide(displacement, pair.motion, pair.n, dt);
    const calendem::ContactAction a =
        calendem::contact_action(pair, m, resistance, s.elastic[p], acting, displacement);
    t.displacement.set(p, select(acting, kUpdate ? displacement : t.displacement[p]));
    const Vec3 push = select(acting, a.normal * pair.n);
    if constexpr (std::is_same_v<Tile, BondTile>) {
      s.force.set(p, push + s.force[p] + a.friction);
      s.torque_i.set(p, s.torque_i[p] + a.torque_i);
      s.torque_j.set(p, s.torque_j[p] + a.torque_j);
    } else {
      const double pull =
          calendem::sjkr_force(m.cohesion, calendem::acting_distance(pair.r, t.reference[p]),
                               s.radius_i[p], s.radius_j[p]);
      s.force.set(p, push - select(acting, pull * pair.n) + a.friction);
      s.torque_i.set(p, a.torque_i);
      s.torque_j.set(p, a.torque_j);
    }
    s.contact_damping.set(p, select(acting, a.damping * pair.n));
    s.friction_force.set(p, a.friction);
    s.friction_torque_i.set(p, a.torque_i);
    s.friction_torque_j.set(p, a.torque_j);
  }
}

} // namespace

namespace {
template <bool kUpdate, bool kDamped>
void run_bonds(BondTile &t, PairStep &s, const BondMaterial &material, const BondStrength &strength,
               FailureCriterion criterion, double dt) {
  switch (criterion) {
  case FailureCriterion::Unsigned:
    return run_bonds<kUpdate, kDamped, FailureCriterion::Unsigned>(t, s, material, strength, dt);
  case FailureCriterion::AsPrinted:
    return run_bonds<kUpdate, kDamped, FailureCriterion::AsPrinted>(t, s, material, strength, dt);
  default:
    return run_bonds<kUpdate, kDamped, FailureCriterion::Signed>(t, s, material, strength, dt);
  }
}

template <bool kUpdate>
void run_bonds(BondTile &t, PairStep &s, const BondMaterial &material, const BondStrength &strength,
               FailureCriterion criterion, double dt) {
  material.damping > 0.0 ? run_bonds<kUpdate, true>(t, s, material, strength, criterion, dt)
                         : run_bonds<kUpdate, false>(t, s, material, strength, criterion, dt);
}
} // namespace

void LAMMPS_NS::run_bonds(BondTile &t, PairStep &s, const BondMaterial &material,
                          const BondStrength &strength, FailureCriterion criterion, bool update,
                          double dt) {
  update ? ::run_bonds<true>(t, s, material, strength, criterion, dt)
         : ::run_bonds<false>(t, s, material, strength, criterion, dt);
}

void LAMMPS_NS::run_hertz(const PairTile &t, PairStep &s, const PairMaterial *materials) {
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const double overlap = acting_overlap(t, s, p);
    const double a = calendem::hertz_contact_radius(
        calendem::effective_radius(s.radius_i[p], s.radius_j[p]), overlap);
    s.contact_radius[p] = a;
    s.elastic[p] = calendem::hertz_mindlin_elastic(materials[t.material[p]].modulus, a, overlap);
  }
}

void LAMMPS_NS::run_contacts(BondTile &t, PairStep &s, const PairMaterial *m, bool update,
                             double dt) {
  update ? ::run_contacts<true>(t, s, m, dt) : ::run_contacts<false>(t, s, m, dt);
}

void LAMMPS_NS::run_contacts(ContactTile &t, PairStep &s, const PairMaterial *m, bool update,
                             double dt) {
  update ? ::run_contacts<true>(t, s, m, dt) : ::run_contacts<false>(t, s, m, dt);
}

namespace {
// Rounding and conversion stand apart: in one expression they are a scalar instruction.
void round_row(int size, Row &row, const calendem::FixedPoint &unit) {
#pragma GCC ivdep
  for (int p = 0; p < size; ++p)
    row[p] = unit.rounded(row[p]);
}

long long round_off(int size, VectorRow &from, const calendem::FixedPoint &unit,
                    unsigned long long (*to)[4]) {
  round_row(size, from.x, unit);
  round_row(size, from.y, unit);
  round_row(size, from.z, unit);
  long long large = 0;
#pragma GCC ivdep
  for (int p = 0; p < size; ++p) {
    const double check = SumCheck::of(from.x[p], from.y[p], from.z[p]);
    large += !SumCheck::can_be_added(check);
    to[p][0] = static_cast<unsigned long long>(static_cast<long long>(from.x[p]));
    to[p][1] = static_cast<unsigned long long>(static_cast<long long>(from.y[p]));
    to[p][2] = static_cast<unsigned long long>(static_cast<long long>(from.z[p]));
    to[p][3] = static_cast<unsigned long long>(static_cast<long long>(check));
  }
  return large;
}
} // namespace

bool LAMMPS_NS::round_off(int size, PairStep &s, const calendem::FixedPoint &force,
                          const calendem::FixedPoint &torque) {
  return ::round_off(size, s.force, force, s.whole[0]) +
             ::round_off(size, s.torque_i, torque, s.whole[1]) +
             ::round_off(size, s.torque_j, torque, s.whole[2]) ==
         0;
}

void PairTile::copy(int to, const PairTile &t, int from) {
  i[to] = t.i[from];
  j[to] = t.j[from];
  material[to] = t.material[from];
  history[to] = t.history[from];
  flags[to] = t.flags[from];
  reference[to] = t.reference[from];
  displacement.set(to, t.displacement[from]);
}

void BondTile::copy(int to, const BondTile &t, int from) {
  PairTile::copy(to, t, from);
  length[to] = t.length[from];
  strength[to] = t.strength[from];
  twist[to] = t.twist[from];
  shear.set(to, t.shear[from]);
  bending.set(to, t.bending[from]);
}

void ContactTile::copy(int to, const ContactTile &t, int from) {
  PairTile::copy(to, t, from);
  separating[to] = t.separating[from];
}
