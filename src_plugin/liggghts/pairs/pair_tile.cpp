// SPDX-License-Identifier: GPL-2.0-or-later
#include "pair_tile.h"
#include "physics/hertz_mindlin.h"
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
  return s.mass_i[p] * s.mass_j[p] / (s.mass_i[p] + s.mass_j[p]);
}

// `kUpdate`: histories advance. `kDamped`: bonds have viscous damping. `kCriterion` is a constant
// so that the loop has no branch; material and strength are copies, which nothing stored can
// change.
template <bool kUpdate, bool kDamped, FailureCriterion kCriterion>
__attribute__((flatten)) void run_bonds(BondTile &t, PairStep &s, const BondMaterial material,
                                        const BondStrength strength, double dt) {
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const BondPair pair(material, t, s, p);
    calendem::BondLoads loads = t.loads(p);
    if (kUpdate) {
      calendem::advance(loads, pair.motion, pair.stiffness, dt);
      t.shear.set(p, loads.shear);
      t.bending.set(p, loads.bending);
      t.twist[p] = loads.twist;
      const double factor = t.strength[p];
      const BondStrength own = {factor * strength.tensile, factor * strength.shear};
      s.failed[p] = calendem::fails(loads, pair.tension, pair.section, own, kCriterion) ? 1.0 : 0.0;
    }
    calendem::BondDamping damping;
    if (kDamped)
      damping = calendem::BondDamping(material, pair.section, pair.stiffness, effective_mass(s, p),
                                      std::min(s.radius_i[p], s.radius_j[p]));
    const calendem::BondAction a = calendem::action(loads, pair.tension, pair.motion, damping);
    s.force.set(p, a.force);
    s.torque_i.set(p, a.torque_i);
    s.torque_j.set(p, a.torque_j);
    if (!kDamped)
      continue;
    const calendem::BondAction d = calendem::damping_action(pair.motion, damping);
    s.bond_damping.set(p, d.force);
    s.bond_damping_torque_i.set(p, d.torque_i);
    s.bond_damping_torque_j.set(p, d.torque_j);
  }
}

Vec3 select(bool condition, const Vec3 &v) {
  return {condition ? v.x : 0.0, condition ? v.y : 0.0, condition ? v.z : 0.0};
}

// A contact at rest, or opened by its law, neither moves nor winds up its friction.
struct ContactPair {
  Vec3 n;
  double r;
  calendem::ContactMotion motion;
  Vec3 displacement;

  ContactPair(const PairTile &t, const PairStep &s, int p) : r(std::sqrt(s.r_squared[p])) {
    const Vec3 d = s.d[p];
    const double inverse_r = 1.0 / r;
    n = inverse_r * d;
    motion = calendem::contact_motion(d, s.v[p], s.spin_i[p], s.spin_j[p], n, inverse_r,
                                      s.radius_sum(p) - r, s.radius_i[p], s.radius_j[p]);
    const bool rests = acting_overlap(t, s, p) == 0.0, slides = s.contact_radius[p] > 0.0;
    motion.normal_velocity = rests ? 0.0 : motion.normal_velocity;
    motion.sliding_velocity = select(slides, motion.sliding_velocity);
    displacement = select(!rests, t.displacement[p]);
  }
};

template <bool kUpdate, class Tile>
__attribute__((flatten)) void run_contacts(Tile &t, PairStep &s, const PairMaterial *materials,
                                           double dt) {
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const bool acting = acts(t, s, p);
    const ContactPair pair(t, s, p);
    const PairMaterial &m = materials[t.material[p]];
    const calendem::ContactMaterial material = {m.modulus, m.shear_modulus, m.damping, m.friction};
    const calendem::ContactResistance resistance =
        calendem::contact_resistance(material, s.contact_radius[p], effective_mass(s, p));
    const double damping = -resistance.normal_damping * pair.motion.normal_velocity;
    const double normal = damping + s.elastic[p];
    Vec3 displacement = pair.displacement;
    if (kUpdate)
      displacement = calendem::slide(displacement, pair.motion, pair.n, dt);
    const Vec3 friction = select(acting, calendem::friction_force(displacement, pair.motion,
                                                                  resistance, m.friction, normal));
    t.displacement.set(p, select(acting, kUpdate ? displacement : t.displacement[p]));
    const Vec3 moment = cross(pair.n, friction);
    const Vec3 on_i = -pair.motion.arm_i * moment, on_j = -pair.motion.arm_j * moment;
    const Vec3 push = select(acting, normal * pair.n);
    if constexpr (std::is_same_v<Tile, BondTile>) {
      s.force.set(p, push + s.force[p] + friction);
      s.torque_i.set(p, s.torque_i[p] + on_i);
      s.torque_j.set(p, s.torque_j[p] + on_j);
    } else {
      const double pull =
          calendem::sjkr_force(m.cohesion, calendem::acting_distance(pair.r, t.reference[p]),
                               s.radius_i[p], s.radius_j[p]);
      s.force.set(p, push - select(acting, pull * pair.n) + friction);
      s.torque_i.set(p, on_i);
      s.torque_j.set(p, on_j);
    }
    s.contact_damping.set(p, select(acting, damping * pair.n));
    s.friction_force.set(p, friction);
    s.friction_torque_i.set(p, on_i);
    s.friction_torque_j.set(p, on_j);
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
    const double a = std::sqrt(s.radius_i[p] * s.radius_j[p] / s.radius_sum(p) * overlap);
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
  parts[to] = t.parts[from];
}
