// SPDX-License-Identifier: GPL-2.0-or-later
#include "pair_tile.h"
#include "physics/hertz_mindlin.h"
#include "physics/sjkr_cohesion.h"
#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using calendem::BondMaterial;
using calendem::BondStrength;
using calendem::FailureCriterion;
using calendem::Vec3;

namespace {

double effective_mass(const PairTile &t, int p) {
  return t.mass_i[p] * t.mass_j[p] / (t.mass_i[p] + t.mass_j[p]);
}

// `kUpdate`: histories advance. `kDamped`: bonds have viscous damping. `kCriterion` is a constant
// so that the loop has no branch; material and strength are copies, which nothing stored can
// change.
template <bool kUpdate, bool kDamped, FailureCriterion kCriterion>
__attribute__((flatten)) void run_bonds(PairTile &t, const BondMaterial material,
                                        const BondStrength strength, double dt) {
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const BondPair pair(material, t, p);
    t.stretch[p] = pair.motion.r / (t.radius_i[p] + t.radius_j[p]);
    calendem::BondLoads loads = loads_of(t, p);
    if (kUpdate) {
      calendem::advance(loads, pair.motion, pair.stiffness, dt);
      t.shear.set(p, loads.shear);
      t.bending.set(p, loads.bending);
      t.twist[p] = loads.twist;
      const double factor = t.strength[p];
      const BondStrength own = {factor * strength.tensile, factor * strength.shear};
      t.failed[p] = calendem::fails(loads, pair.tension, pair.section, own, kCriterion) ? 1.0 : 0.0;
    }
    calendem::BondDamping damping;
    if (kDamped)
      damping = calendem::BondDamping(material, pair.section, pair.stiffness, effective_mass(t, p),
                                      std::min(t.radius_i[p], t.radius_j[p]));
    const calendem::BondAction a = calendem::action(loads, pair.tension, pair.motion, damping);
    t.force.set(p, a.force);
    t.torque_i.set(p, a.torque_i);
    t.torque_j.set(p, a.torque_j);
    if (!kDamped)
      continue;
    const calendem::BondAction d = calendem::damping_action(pair.motion, damping);
    t.bond_damping.set(p, d.force);
    t.bond_damping_torque_i.set(p, d.torque_i);
    t.bond_damping_torque_j.set(p, d.torque_j);
  }
}

// A contact at rest, or opened by its law, neither moves nor winds up its friction.
struct ContactPair {
  Vec3 n;
  double r;
  calendem::ContactMotion motion;
  Vec3 displacement;

  ContactPair(const PairTile &t, int p) : r(std::sqrt(t.r_squared[p])) {
    const Vec3 d = t.d[p];
    const double inverse_r = 1.0 / r;
    n = inverse_r * d;
    motion =
        calendem::contact_motion(d, t.v[p], t.spin_i[p], t.spin_j[p], n, inverse_r,
                                 t.radius_i[p] + t.radius_j[p] - r, t.radius_i[p], t.radius_j[p]);
    const bool rests = acting_overlap(t, p) == 0.0, slides = t.contact_radius[p] > 0.0;
    motion.normal_velocity = rests ? 0.0 : motion.normal_velocity;
    const Vec3 v = motion.sliding_velocity, s = t.displacement[p];
    motion.sliding_velocity = {slides ? v.x : 0.0, slides ? v.y : 0.0, slides ? v.z : 0.0};
    displacement = {rests ? 0.0 : s.x, rests ? 0.0 : s.y, rests ? 0.0 : s.z};
  }
};

template <bool kUpdate, bool kBonded>
__attribute__((flatten)) void run_contacts(PairTile &t, double dt) {
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const ContactPair pair(t, p);
    const calendem::ContactMaterial material = {t.modulus[p], t.shear_modulus[p], t.damping[p],
                                                t.friction[p]};
    const calendem::ContactResistance resistance =
        calendem::contact_resistance(material, t.contact_radius[p], effective_mass(t, p));
    const double damping = -resistance.normal_damping * pair.motion.normal_velocity;
    const double normal = damping + t.elastic[p];
    Vec3 displacement = pair.displacement;
    if (kUpdate)
      displacement = calendem::slide(displacement, pair.motion, pair.n, dt);
    const Vec3 friction =
        calendem::friction_force(displacement, pair.motion, resistance, material.friction, normal);
    t.displacement.set(p, displacement);
    const Vec3 moment = cross(pair.n, friction);
    const Vec3 on_i = -pair.motion.arm_i * moment, on_j = -pair.motion.arm_j * moment;
    if (kBonded) {
      t.force.set(p, normal * pair.n + t.force[p] + friction);
      t.torque_i.set(p, t.torque_i[p] + on_i);
      t.torque_j.set(p, t.torque_j[p] + on_j);
    } else {
      const double pull = calendem::sjkr_force(t.cohesion[p], pair.r + t.reference[p],
                                               t.radius_i[p], t.radius_j[p]);
      t.force.set(p, normal * pair.n - pull * pair.n + friction);
      t.torque_i.set(p, on_i);
      t.torque_j.set(p, on_j);
    }
    t.contact_damping.set(p, damping * pair.n);
    t.friction_force.set(p, friction);
    t.friction_torque_i.set(p, on_i);
    t.friction_torque_j.set(p, on_j);
  }
}

} // namespace

namespace {
template <bool kUpdate, bool kDamped>
void run_bonds(PairTile &t, const BondMaterial &material, const BondStrength &strength,
               FailureCriterion criterion, double dt) {
  switch (criterion) {
  case FailureCriterion::Unsigned:
    return run_bonds<kUpdate, kDamped, FailureCriterion::Unsigned>(t, material, strength, dt);
  case FailureCriterion::AsPrinted:
    return run_bonds<kUpdate, kDamped, FailureCriterion::AsPrinted>(t, material, strength, dt);
  default:
    return run_bonds<kUpdate, kDamped, FailureCriterion::Signed>(t, material, strength, dt);
  }
}

template <bool kUpdate>
void run_bonds(PairTile &t, const BondMaterial &material, const BondStrength &strength,
               FailureCriterion criterion, double dt) {
  material.damping > 0.0 ? run_bonds<kUpdate, true>(t, material, strength, criterion, dt)
                         : run_bonds<kUpdate, false>(t, material, strength, criterion, dt);
}
} // namespace

void LAMMPS_NS::run_bonds(PairTile &t, const BondMaterial &material, const BondStrength &strength,
                          FailureCriterion criterion, bool update, double dt) {
  update ? ::run_bonds<true>(t, material, strength, criterion, dt)
         : ::run_bonds<false>(t, material, strength, criterion, dt);
}

void LAMMPS_NS::run_hertz(PairTile &t) {
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const double overlap = acting_overlap(t, p);
    const double radius_sum = t.radius_i[p] + t.radius_j[p];
    const double a = std::sqrt(t.radius_i[p] * t.radius_j[p] / radius_sum * overlap);
    t.contact_radius[p] = a;
    t.elastic[p] = calendem::hertz_mindlin_elastic(t.modulus[p], a, overlap);
  }
}

void LAMMPS_NS::run_contacts(PairTile &t, bool bonded, bool update, double dt) {
  if (update)
    bonded ? ::run_contacts<true, true>(t, dt) : ::run_contacts<true, false>(t, dt);
  else
    bonded ? ::run_contacts<false, true>(t, dt) : ::run_contacts<false, false>(t, dt);
}

void LAMMPS_NS::round_off(PairTile &t, const calendem::FixedPoint &force,
                          const calendem::FixedPoint &torque) {
  const Row *const rows[9] = {&t.force.x,    &t.force.y,    &t.force.z,
                              &t.torque_i.x, &t.torque_i.y, &t.torque_i.z,
                              &t.torque_j.x, &t.torque_j.y, &t.torque_j.z};
  for (int k = 0; k < 9; ++k) {
    const calendem::FixedPoint unit = k < 3 ? force : torque;
    const double *from = rows[k]->at;
    long long *to = t.whole[k].at;
#pragma GCC ivdep
    for (int p = 0; p < t.size; ++p)
      to[p] = unit.of(from[p]);
  }
}
