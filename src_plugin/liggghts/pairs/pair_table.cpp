// SPDX-License-Identifier: GPL-2.0-or-later
#include "pair_table.h"
#include "atom.h"
#include "contact_effects.h"
#include "contact_model_constants.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "pair_gran.h"
#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace LIGGGHTS::ContactModels;

namespace {

// Share of the lists' skin: a wider gap sorts less often and works on more pairs that do not touch.
constexpr double kGapOfSkin = 1.0 / 5.0;

// Flags that the host's contact objects set: of spheres that are apart, that touch.
constexpr int kApart = CONTACT_NORMAL_MODEL | CONTACT_COHESION_MODEL;
constexpr int kInContact = kApart | CONTACT_TANGENTIAL_MODEL;

} // namespace

void PairTable::connect(BondEvents *bonds, int bond_offset, int effects_offset, int spring_offset) {
  bonds_ = bonds;
  bond_ = bond_offset;
  memory_ = effects_offset;
  spring_ = spring_offset;
}

double PairTable::distance_squared(int i, int j) const {
  const double *a = atom->x[i], *b = atom->x[j];
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

bool PairTable::is_near(int i, int j, double gap) const {
  const double reach = atom->radius[i] + atom->radius[j] + gap;
  return distance_squared(i, j) < reach * reach;
}

// As far as histories reach.
void PairTable::make_bonds(int i, int j, BondHistory &history) const {
  const double r = std::sqrt(distance_squared(i, j));
  const double reach = neighbor->contactDistanceFactor * (atom->radius[i] + atom->radius[j]);
  if (r >= reach)
    return;
  bonds_->make_bond(i, j, r, history);
  bonds_->make_bridge(i, j, r, history);
}

void PairTable::adopt_lists(PairGran *pair) {
  for (Bonds *list : {&bonds, &bridges}) {
    list->clear();
    list->failed.clear();
  }
  contacts.clear();
  far_.clear();
  deciding_ = 0;
  gap_ = kGapOfSkin * neighbor->skin;
  const NeighList *list = pair->list;
  const int dnum = pair->dnum();
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    for (int k = 0; k < list->numneigh[i]; ++k) {
      const int j = list->firstneigh[i][k] & NEIGHMASK;
      int *flags = list->listgranhistory->firstneigh[i] + k;
      sort_pair({i, j, list->listgranhistory->firstdouble[i] + dnum * k, flags});
    }
  }
  remember_positions();
  holds_ = true;
  stored_ = false;
}

void PairTable::sort_pair(const FarPair &pair) {
  BondHistory history = bond(pair.history);
  if (bonds_->creating())
    make_bonds(pair.i, pair.j, history);
  const int state = history.state();
  if (state == kIntact)
    return add_bond(bonds, pair);
  if (state == kBridge)
    add_bond(bridges, pair);
  if (state == kBrokenTouching || is_near(pair.i, pair.j, gap_))
    add_contact(pair);
  else
    make_far(pair);
}

void PairTable::place_pair(PairTile &t, int p, const FarPair &pair) const {
  const int i = pair.i, j = pair.j;
  t.i[p] = i;
  t.j[p] = j;
  t.material[p] = atom->type[i] * (atom->ntypes + 1) + atom->type[j];
  t.history[p] = pair.history;
  t.flags[p] = pair.flags;
  update_reference(t, p);
  t.displacement.set(p, calendem::load(pair.history + spring_));
}

void PairTable::add_bond(Bonds &list, const FarPair &pair) {
  const int n = list.add(), p = list.at(n);
  BondTile &t = list.of(n);
  place_pair(t, p, pair);
  const BondHistory history = bond(pair.history);
  const calendem::BondLoads loads = history.loads();
  t.length[p] = history.length();
  t.strength[p] = history.strength_factor();
  t.shear.set(p, loads.shear);
  t.bending.set(p, loads.bending);
  t.twist[p] = loads.twist;
  deciding_ += bonds_->pairs().decides(pair.i, pair.j);
}

void PairTable::add_contact(const FarPair &pair) {
  const int n = contacts.add(), p = contacts.at(n);
  ContactTile &t = contacts.of(n);
  place_pair(t, p, pair);
  t.separating[p] = bond(pair.history).state() == kBrokenTouching ? 1.0 : 0.0;
}

// The far pairs that are not far any more.
void PairTable::sort_far_pairs() {
  size_t left = 0;
  for (const FarPair &pair : far_)
    if (is_near(pair.i, pair.j, gap_))
      add_contact(pair);
    else
      far_[left++] = pair;
  far_.resize(left);
}

// Contacts that have become far pairs.
void PairTable::sort_contacts() {
  for (int n = contacts.pairs() - 1; n >= 0; --n) {
    const ContactTile &t = contacts.of(n);
    const int p = contacts.at(n);
    if (is_near(t.i[p], t.j[p], gap_) || t.separating[p] != 0.0)
      continue;
    make_far({t.i[p], t.j[p], t.history[p], t.flags[p]});
    contacts.remove(n);
  }
}

void PairTable::clear_effect(double *history) const {
  if (memory_ >= 0)
    std::fill_n(history + memory_, ContactEffects::kMemory, 0.0);
}

void PairTable::make_far(const FarPair &pair) {
  double *spring = pair.history + spring_;
  if (spring[0] != 0.0 || spring[1] != 0.0 || spring[2] != 0.0) // most are zero
    spring[0] = spring[1] = spring[2] = 0.0;
  clear_effect(pair.history);
  far_.push_back(pair);
}

void PairTable::remember_positions() {
  const double *x = atom->x[0];
  positions_.assign(x, x + 3 * (atom->nlocal + atom->nghost));
}

// True if two spheres may have come nearer by all but a little of the far pairs' gap.
bool PairTable::spheres_moved() const {
  const double *x = atom->x[0], *before = positions_.data();
  const double limit = 0.24 * gap_ * gap_;
  long long beyond = 0;
  for (int k = 0; k < atom->nlocal + atom->nghost; ++k) {
    const double dx = x[3 * k] - before[3 * k], dy = x[3 * k + 1] - before[3 * k + 1],
                 dz = x[3 * k + 2] - before[3 * k + 2];
    beyond += dx * dx + dy * dy + dz * dz > limit;
  }
  return beyond > 0;
}

void PairTable::update_reference(PairTile &t, int p) const {
  const double radius_sum = atom->radius[t.i[p]] + atom->radius[t.j[p]];
  t.reference[p] = bond(t.history[p]).reference_overlap(radius_sum);
}

void PairTable::update_references() {
  for (int n = 0; n < bonds.pairs(); ++n)
    update_reference(bonds.of(n), bonds.at(n));
  for (int n = 0; n < contacts.pairs(); ++n)
    update_reference(contacts.of(n), contacts.at(n));
}

void PairTable::update(bool resized) {
  drop_broken();
  if (resized)
    update_references();
  if (!resized && !spheres_moved())
    return;
  sort_contacts();
  sort_far_pairs();
  remember_positions();
}

// Fix bond/bpm has broken what has failed since: all or none.
bool PairTable::has_broken(Bonds &list) {
  if (list.failed.empty())
    return false;
  const int first = list.failed[0];
  return !bond(list.of(first).history[list.at(first)]).acts();
}

void PairTable::drop_broken() {
  for (Bonds *list : {&bonds, &bridges}) {
    if (!has_broken(*list))
      continue;
    for (size_t k = list->failed.size(); k-- > 0;)
      drop_bond(*list, list->failed[k]);
    list->failed.clear();
  }
}

void PairTable::drop_bond(Bonds &list, int broken) {
  const BondTile &t = list.of(broken);
  const int p = list.at(broken);
  const FarPair pair = {t.i[p], t.j[p], t.history[p], t.flags[p]};
  if (&list == &bonds) {
    calendem::store(t.displacement[p], pair.history + spring_);
    add_contact(pair);
  }
  deciding_ -= bonds_->pairs().decides(pair.i, pair.j);
  list.remove(broken);
}

void PairTable::mark_separated(ContactTile &t, int p) {
  BondHistory history = bond(t.history[p]);
  bonds_->mark_separated(t.i[p], t.j[p], history);
  t.separating[p] = 0.0;
  update_reference(t, p);
}

void PairTable::store_loads(const BondTile &t, int p) const {
  bond(t.history[p]).set_loads(t.loads(p));
}

void PairTable::store_contact(const PairTile &t, int p) const {
  calendem::store(t.displacement[p], t.history[p] + spring_);
  *t.flags[p] = contact_flags(t.i[p], t.j[p]);
}

// As the host's contact objects leave them after a step.
int PairTable::contact_flags(int i, int j) const {
  const double reach = neighbor->contactDistanceFactor * (atom->radius[i] + atom->radius[j]);
  if (distance_squared(i, j) >= reach * reach)
    return 0;
  return is_near(i, j, 0.0) ? kInContact : kApart;
}

void PairTable::store_histories() {
  if (!holds_ || stored_)
    return;
  drop_broken();
  for (const FarPair &pair : far_)
    *pair.flags = contact_flags(pair.i, pair.j);
  for (int n = 0; n < bonds.pairs(); ++n) {
    store_loads(bonds.of(n), bonds.at(n));
    store_contact(bonds.of(n), bonds.at(n));
  }
  for (int n = 0; n < contacts.pairs(); ++n)
    store_contact(contacts.of(n), contacts.at(n));
  for (int n = 0; n < bridges.pairs(); ++n) {
    const BondTile &t = bridges.of(n);
    store_loads(t, bridges.at(n));
    *t.flags[bridges.at(n)] |= kApart;
  }
  stored_ = true;
}

void PairTable::release_histories() {
  store_histories();
  holds_ = false;
}
