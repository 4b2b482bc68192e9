// SPDX-License-Identifier: GPL-2.0-or-later
#include "bpm_pair_loop.h"
#include "atom.h"
#include "contact_model_constants.h"
#include "fix_bond_bpm.h"
#include "fix_energy_bpm.h"
#include "force.h"
#include "global_properties.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "pair_gran.h"
#include "physics/hertz_contact.h"
#include "property_registry.h"
#include "update.h"
#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace LIGGGHTS::ContactModels;
using calendem::Vec3;

namespace {

Vec3 difference(const double *a, const double *b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

} // namespace

void BpmPairLoop::connect(int bond_offset, int effects_offset) {
  fix_ = FixBondBpm::find(lmp, "pair_style gran");
  energy_ = FixEnergyBpm::find(lmp);
  bond_ = bond_offset;
  memory_ = effects_offset;
  spring_ = fix_->friction_history_offset(bond_offset);
  PropertyRegistry &registry = force->registry;
  registry.registerProperty("Yeff", &MODEL_PARAMS::createYeff);
  registry.registerProperty("Geff", &MODEL_PARAMS::createGeff);
  registry.registerProperty("betaeff", &MODEL_PARAMS::createBetaEff);
  registry.registerProperty("coeffFrict", &MODEL_PARAMS::createCoeffFrict);
  registry.registerProperty("cohEnergyDens", &MODEL_PARAMS::createCohesionEnergyDensity);
  registry.connect("Yeff", modulus_, "pair_style gran");
  registry.connect("Geff", shear_modulus_, "pair_style gran");
  registry.connect("betaeff", damping_, "pair_style gran");
  registry.connect("coeffFrict", friction_, "pair_style gran");
  registry.connect("cohEnergyDens", cohesion_, "pair_style gran");
  if (memory_ >= 0)
    effects_.connect(registry, "pair_style gran");
  tiles_.reset(new PairTile[kApart]());
  choose_units();
}

bool BpmPairLoop::serves(PairGran *pair) const {
  return spring_ >= 0 && pair->computeflag() && atom->rmass && !pair->fr_pair() &&
         !pair->freeze_group_bit() && !pair->storeSumDelta() && !pair->storeContactForces() &&
         !pair->storeContactForcesStress() && !pair->store_sum_normal_force() &&
         force->nktv2p == 1.0 && !force->newton_pair &&
         !modify->n_fixes_style("insert/stream/predefined");
}

// A force of E R^2 would press a sphere into another by its radius.
void BpmPairLoop::choose_units() {
  double radius = 0.0, largest = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    radius = std::max(radius, atom->radius[i]);
  MPI_Allreduce(&radius, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
  double modulus = std::max(fix_->settings().material.youngs_modulus,
                            fix_->bridge_settings().material.youngs_modulus);
  for (int a = 1; a <= atom->ntypes; ++a)
    for (int b = 1; b <= atom->ntypes; ++b)
      modulus = std::max(modulus, modulus_[a][b]);
  const double force = modulus * largest * largest;
  if (force > 0.0) {
    force_unit_ = calendem::FixedPoint(force);
    torque_unit_ = calendem::FixedPoint(force * largest);
  }
}

// Anew in every step: the host's properties may change.
void BpmPairLoop::copy_materials() {
  types_ = atom->ntypes + 1;
  materials_.resize(types_ * types_);
  for (int a = 1; a < types_; ++a)
    for (int b = 1; b < types_; ++b)
      materials_[a * types_ + b] = {modulus_[a][b], shear_modulus_[a][b], damping_[a][b],
                                    friction_[a][b], cohesion_[a][b]};
}

void BpmPairLoop::copy_spheres() {
  const int n = atom->nlocal + atom->nghost;
  if (n > static_cast<int>(spheres_.size())) {
    spheres_.resize(n + n / 8);
    forces_.resize(n + n / 8);
  }
  std::fill(forces_.begin(), forces_.begin() + n, WholeForce());
  for (int k = 0; k < n; ++k) {
    Sphere &s = spheres_[k];
    for (int c = 0; c < 3; ++c) {
      s.v[c] = atom->v[k][c];
      s.omega[c] = atom->omega[k][c];
    }
    s.radius = atom->radius[k];
    s.mass = atom->rmass[k];
  }
}

int BpmPairLoop::find_near(int i, const int *neighbors, int count, double factor_squared) {
  if (count > static_cast<int>(near_.size())) {
    near_.resize(2 * count);
    for (std::vector<double> *row : {&dx_, &dy_, &dz_, &r_squared_, &limit_})
      row->resize(2 * count);
  }
  const double *x = atom->x[0], *radius = atom->radius;
  const double xi = x[3 * i], yi = x[3 * i + 1], zi = x[3 * i + 2], radius_i = radius[i];
  double *r_squared = r_squared_.data(), *limit = limit_.data();
  double *dx = dx_.data(), *dy = dy_.data(), *dz = dz_.data();
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const int j = neighbors[k] & NEIGHMASK;
    const double radius_sum = radius_i + radius[j];
    dx[k] = xi - x[3 * j];
    dy[k] = yi - x[3 * j + 1];
    dz[k] = zi - x[3 * j + 2];
    r_squared[k] = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k];
    limit[k] = factor_squared * radius_sum * radius_sum;
  }
  int found = 0;
  int *near = near_.data();
  for (int k = 0; k < count; ++k) {
    near[found] = k;
    found += r_squared[k] < limit[k];
  }
  return found;
}

void BpmPairLoop::compute_force(PairGran *pair) {
  const NeighList *list = pair->list;
  const int dnum = pair->dnum();
  const double factor = neighbor->contactDistanceFactor * neighbor->contactDistanceFactor;
  update_ = pair->shearupdate();
  acting_ = 0;
  copy_materials();
  copy_spheres();
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    const int *neighbors = list->firstneigh[i];
    double *history = list->listgranhistory->firstdouble[i];
    int *flags = list->listgranhistory->firstneigh[i];
    const int near = find_near(i, neighbors, list->numneigh[i], factor);
    for (int n = 0; n < near; ++n) {
      const int k = near_[n];
      if (found_ == kTilePairs)
        work_off();
      double *values = history + dnum * k;
      __builtin_prefetch(values);
      __builtin_prefetch(values + dnum - 1);
      pairs_[found_++] = {i,
                          neighbors[k] & NEIGHMASK,
                          kApart,
                          0,
                          values,
                          flags + k,
                          r_squared_[k],
                          {dx_[k], dy_[k], dz_[k]}};
    }
  }
  work_off();
  add_forces(pair);
  if (update_)
    fix_->count_acting(acting_);
}

void BpmPairLoop::work_off() {
  const double dt = update->dt;
  sort();
  for (const Kind kind : {kBond, kPressedBond, kBridged}) {
    const BondSettings &b = settings_of(kind);
    run_bonds(tiles_[kind], b.material, b.strength, b.criterion, update_, dt);
    if (update_)
      keep_bonds(kind);
  }
  for (const Kind kind : {kPressedBond, kContact}) {
    run_hertz(tiles_[kind]);
    if (kind == kContact && memory_ >= 0)
      act_effects();
    run_contacts(tiles_[kind], kind == kPressedBond, update_, dt);
    if (update_)
      keep_contacts(kind);
  }
  for (const Kind kind : {kBond, kPressedBond, kContact, kBridged})
    sum_forces(kind);
  if (energy_)
    book();
  found_ = 0;
}

// Which kind a pair is changes from pair to pair without a pattern: no branch depends on it.
void BpmPairLoop::sort() {
  const int nlocal = atom->nlocal, *tag = atom->tag;
  const bool creating = fix_->creating();
  std::fill(count_, count_ + kKinds, 0);
  for (int n = 0; n < found_; ++n) {
    Pair &pair = pairs_[n];
    const Sphere &a = spheres_[pair.i], &b = spheres_[pair.j];
    BondHistory bond(pair.history + bond_);
    const double radius_sum = a.radius + b.radius;
    const bool touches = pair.r_squared < radius_sum * radius_sum;
    if (creating && touches)
      fix_->create(pair.i, pair.j, std::sqrt(pair.r_squared), bond);
    if (creating)
      fix_->bridge(pair.i, pair.j, std::sqrt(pair.r_squared), bond);
    const double length = bond.length();
    const bool intact = bond.state() == kIntact;
    const bool pressed = touches & (pair.r_squared < length * length);
    pair.kind = intact ? (pressed ? kPressedBond : kBond) : (touches ? kContact : kApart);
    pair.at = count_[pair.kind]++;
    of_kind_[pair.kind][pair.at] = n;
    // as FixBondBpm::decides
    acting_ += intact & ((pair.j < nlocal) | (tag[pair.i] < tag[pair.j]));
  }
  for (const Kind kind : {kBond, kPressedBond, kContact})
    fill(kind);
  if (fix_->bridges().on())
    sort_bridges();
  for (int p = 0; p < count_[kApart]; ++p) {
    const Pair &pair = pairs_[of_kind_[kApart][p]];
    BondHistory bond(pair.history + bond_);
    if (bond.state() == kBrokenTouching && update_)
      bond.set_state(kBrokenSeparated);
    leave(pair);
  }
}

void BpmPairLoop::sort_bridges() {
  for (int n = 0; n < found_; ++n) {
    const Pair &pair = pairs_[n];
    if (BondHistory(pair.history + bond_).state() != kBridge)
      continue;
    of_kind_[kBridged][count_[kBridged]++] = n;
    acting_ += fix_->decides(pair.i, pair.j);
  }
  fill(kBridged);
}

const BondSettings &BpmPairLoop::settings_of(Kind kind) const {
  return kind == kBridged ? fix_->bridge_settings() : fix_->settings();
}

// The spheres do not touch: the contact forgets. Flags here and below are those that the host's
// contact objects set.
void BpmPairLoop::leave(const Pair &pair) const {
  *pair.flags = (*pair.flags | CONTACT_NORMAL_MODEL) & ~CONTACT_TANGENTIAL_MODEL;
  double *spring = pair.history + spring_;
  // most are zero: leave their line of the cache be
  if (spring[0] != 0.0 || spring[1] != 0.0 || spring[2] != 0.0)
    spring[0] = spring[1] = spring[2] = 0.0;
  if (memory_ >= 0)
    std::fill_n(pair.history + memory_, ContactEffects::kMemory, 0.0);
}

void BpmPairLoop::fill(Kind kind) {
  PairTile &t = tiles_[kind];
  t.size = count_[kind];
  for (int p = 0; p < t.size; ++p) {
    const Pair &pair = pairs_[of_kind_[kind][p]];
    put_spheres(t, p, pair);
    if (kind != kContact)
      put_bond(t, p, pair);
    if (kind == kBond)
      leave(pair);
    else if (kind != kBridged)
      put_contact(t, p, pair);
    *pair.flags |= CONTACT_COHESION_MODEL;
  }
}

void BpmPairLoop::put_spheres(PairTile &t, int p, const Pair &pair) const {
  const Sphere &a = spheres_[pair.i], &b = spheres_[pair.j];
  t.d.set(p, pair.d);
  t.v.set(p, difference(a.v, b.v));
  t.spin_i.set(p, calendem::load(a.omega));
  t.spin_j.set(p, calendem::load(b.omega));
  t.r_squared[p] = pair.r_squared;
  t.radius_i[p] = a.radius;
  t.radius_j[p] = b.radius;
  t.mass_i[p] = a.mass;
  t.mass_j[p] = b.mass;
}

void BpmPairLoop::put_bond(PairTile &t, int p, const Pair &pair) const {
  const BondHistory bond(pair.history + bond_);
  const calendem::BondLoads loads = bond.loads();
  t.length[p] = bond.length();
  t.strength[p] = bond.strength_factor();
  t.shear.set(p, loads.shear);
  t.bending.set(p, loads.bending);
  t.twist[p] = loads.twist;
}

void BpmPairLoop::put_contact(PairTile &t, int p, const Pair &pair) const {
  const Sphere &a = spheres_[pair.i], &b = spheres_[pair.j];
  const PairMaterial &m = materials_[atom->type[pair.i] * types_ + atom->type[pair.j]];
  t.modulus[p] = m.modulus;
  t.shear_modulus[p] = m.shear_modulus;
  t.damping[p] = m.damping;
  t.friction[p] = m.friction;
  t.cohesion[p] = m.cohesion;
  t.reference[p] = BondHistory(pair.history + bond_).reference_overlap(a.radius + b.radius);
  t.displacement.set(p, calendem::load(pair.history + spring_));
  *pair.flags |= CONTACT_NORMAL_MODEL | CONTACT_TANGENTIAL_MODEL;
}

// Contacts between types on which an effect acts follow its law instead of Hertz's.
void BpmPairLoop::act_effects() {
  PairTile &t = tiles_[kContact];
  for (int p = 0; p < t.size; ++p) {
    const Pair &pair = pairs_[of_kind_[kContact][p]];
    const int a = atom->type[pair.i], b = atom->type[pair.j];
    if (!effects_.act(a, b) || BondHistory(pair.history + bond_).has_reference())
      continue;
    const double overlap = acting_overlap(t, p);
    const EffectContact contact =
        EffectContact::of_spheres(a, b, t.radius_i[p], t.radius_j[p], overlap);
    double *memory = pair.history + memory_;
    if (update_) {
      const Vec3 n = (1.0 / std::sqrt(pair.r_squared)) * t.d[p];
      const double before = overlap + dot(t.v[p], n) * update->dt;
      const double taken = effects_.advance(contact, before, update->dt, memory);
      if (energy_ && taken != 0.0)
        energy_->add_taken(pair.i, pair.j, taken, effects_.law(a, b).takes);
    }
    t.contact_radius[p] = effects_.contact_radius(contact, memory);
    t.elastic[p] = effects_.force(contact, memory);
  }
}

void BpmPairLoop::keep_bonds(Kind kind) {
  const BondSettings &b = settings_of(kind);
  const PairTile &t = tiles_[kind];
  for (int p = 0; p < t.size; ++p) {
    const Pair &pair = pairs_[of_kind_[kind][p]];
    BondHistory history(pair.history + bond_);
    history.set_loads(loads_of(t, p));
    fix_->check_stretch(t.stretch[p]);
    if (t.failed[p] == 0.0 || !b.breakable)
      continue;
    const BondPair bond(b.material, t, p);
    fix_->record_break(pair.i, pair.j, history, loads_of(t, p), bond.tension, bond.section,
                       bond.stiffness, t.strength[p]);
  }
}

void BpmPairLoop::keep_contacts(Kind kind) {
  const PairTile &t = tiles_[kind];
  for (int p = 0; p < t.size; ++p)
    calendem::store(t.displacement[p], pairs_[of_kind_[kind][p]].history + spring_);
}

void BpmPairLoop::sum_forces(Kind kind) {
  PairTile &t = tiles_[kind];
  round_off(t, force_unit_, torque_unit_);
  for (int p = 0; p < t.size; ++p) {
    const Pair &pair = pairs_[of_kind_[kind][p]];
    unsigned long long *on_i = forces_[pair.i].sum, *on_j = forces_[pair.j].sum;
    for (int k = 0; k < 3; ++k) {
      on_i[k] += t.whole[k][p];
      on_j[k] -= t.whole[k][p];
      on_i[3 + k] += t.whole[3 + k][p];
      on_j[3 + k] += t.whole[6 + k][p];
    }
  }
}

void BpmPairLoop::add_forces(PairGran *pair) {
  for (int i = 0; i < atom->nlocal; ++i) {
    const double relax = pair->relax(i);
    const unsigned long long *sum = forces_[i].sum;
    for (int k = 0; k < 3; ++k) {
      atom->f[i][k] += relax * force_unit_.value(static_cast<long long>(sum[k]));
      atom->torque[i][k] += relax * torque_unit_.value(static_cast<long long>(sum[3 + k]));
    }
  }
}

void BpmPairLoop::book() {
  for (const Kind kind : {kBond, kPressedBond, kBridged}) {
    const PairTile &t = tiles_[kind];
    for (int p = 0; p < t.size; ++p) {
      const Pair &pair = pairs_[of_kind_[kind][p]];
      energy_->add_damping(
          pair.i, pair.j,
          {t.bond_damping[p], t.bond_damping_torque_i[p], t.bond_damping_torque_j[p]});
    }
  }
  for (const Kind kind : {kPressedBond, kContact}) {
    const PairTile &t = tiles_[kind];
    for (int p = 0; p < t.size; ++p) {
      const Pair &pair = pairs_[of_kind_[kind][p]];
      energy_->add_damping(pair.i, t.contact_damping[p]);
      energy_->add_damping(pair.j, -t.contact_damping[p]);
      energy_->add_friction(pair.i, {t.friction_force[p], t.friction_torque_i[p]});
      energy_->add_friction(pair.j, {-t.friction_force[p], t.friction_torque_j[p]});
    }
  }
}
