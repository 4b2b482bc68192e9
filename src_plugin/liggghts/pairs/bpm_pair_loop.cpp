// SPDX-License-Identifier: GPL-2.0-or-later
#include "bpm_pair_loop.h"
#include "atom.h"
#include "cell_growth.h"
#include "contact_readers.h"
#include "error.h"
#include "force.h"
#include "global_properties.h"
#include "history_layout.h"
#include "modify.h"
#include "neighbor.h"
#include "pair_gran.h"
#include "physics/hertz_contact.h"
#include "property_registry.h"
#include "update.h"
#include "work_ledger.h"
#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using calendem::Vec3;

namespace {

Vec3 difference(const double *a, const double *b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

} // namespace

BpmPairLoop::BpmPairLoop(LAMMPS *lmp)
    : Pointers(lmp), known_(lmp), forces_(lmp), table_(lmp), step_(new PairStep()) {}

void BpmPairLoop::connect(int bond_offset, int effects_offset) {
  bonds_ = BondEvents::find(lmp, "pair_style gran");
  ledger_ = WorkLedger::find(lmp);
  cell_ = CellGrowth::find(lmp);
  bond_ = bond_offset;
  memory_ = effects_offset;
  bonds_->pairs().connect(bond_offset);
  spring_ = friction_history_offset(lmp, bond_offset);
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
  contacts_are_read_ = contacts_are_read(*modify);
  forces_.connect(bonds_);
  table_.connect(bonds_, bond_, memory_, spring_);
  bonds_->pairs().set_loop(this);
  known_.find();
  radii_vary_ = false;
  for (int k = 0; k < modify->nfix; ++k)
    radii_vary_ |= modify->fix[k]->rad_mass_vary_flag != 0;
}

BpmPairLoop::~BpmPairLoop() {
  for (int k = 0; k < modify->nfix; ++k)
    if (bonds_ && dynamic_cast<BondEvents *>(modify->fix[k]) == bonds_)
      bonds_->pairs().set_loop(nullptr);
}

bool BpmPairLoop::serves(PairGran *pair) const {
  return spring_ >= 0 && pair->computeflag() && atom->rmass && !pair->fr_pair() &&
         !pair->freeze_group_bit() && !pair->storeSumDelta() && !pair->storeContactForces() &&
         !pair->storeContactForcesStress() && !pair->store_sum_normal_force() &&
         force->nktv2p == 1.0 && !force->newton_pair;
}

void BpmPairLoop::check_reference() const {
  if (cell_)
    error->all(FLERR, "fix elongation needs the fused loop over pairs, and this pair_style gran is "
                      "computed by the host's. Leave out 'fused off', settings of the host's "
                      "models, and fixes and computes that store single contacts");
}

void BpmPairLoop::prepare() {
  known_.check();
  if (neighbor->ago == 0 || radii_vary_)
    forces_.choose_units(modulus_, known_.highest());
}

// Anew in every step: the host's properties may change.
void BpmPairLoop::copy_materials() {
  types_ = atom->ntypes + 1;
  materials_.resize(types_ * types_);
  for (int a = 1; a <= known_.highest(); ++a)
    for (int b = 1; b <= known_.highest(); ++b)
      materials_[a * types_ + b] = {modulus_[a][b], shear_modulus_[a][b], damping_[a][b],
                                    friction_[a][b], cohesion_[a][b]};
}

// True if radii have changed.
bool BpmPairLoop::copy_spheres() {
  const int n = atom->nlocal + atom->nghost;
  if (n > static_cast<int>(spheres_.size()))
    spheres_.resize(n + n / 8);
  bool resized = false;
  for (int k = 0; k < n; ++k) {
    Sphere &s = spheres_[k];
    for (int c = 0; c < 3; ++c) {
      s.v[c] = atom->v[k][c];
      s.omega[c] = atom->omega[k][c];
    }
    resized |= s.radius != atom->radius[k];
    s.radius = atom->radius[k];
    s.mass = atom->rmass[k];
  }
  return resized;
}

void BpmPairLoop::compute_force(PairGran *pair) {
  update_ = pair->shearupdate();
  virial_ = pair->evflag ? pair : nullptr;
  copy_materials();
  const bool resized = copy_spheres();
  if (table_.holds_histories())
    table_.update(resized);
  else
    table_.adopt_lists(pair);
  table_.mark_changed();
  forces_.clear(atom->nlocal + atom->nghost);
  bigint acting = table_.deciding();
  for (int n = 0; n < table_.bonds.tiles(); ++n)
    acting -= compute_tile(table_.bonds, n, bonds_->settings());
  for (int n = 0; n < table_.bridges.tiles(); ++n)
    acting -= compute_tile(table_.bridges, n, bonds_->bridge_settings());
  for (int n = 0; n < table_.contacts.tiles(); ++n)
    compute_tile(table_.contacts.tile(n));
  forces_.add_to_atoms(pair);
  if (update_)
    bonds_->count_acting(acting);
  if (update->whichflag != 1) // nobody says when lists are built
    table_.release_histories();
  else if (contacts_are_read_)
    table_.store_histories();
}

// Returns how many of the bonds that this rank decides do not act, as they are stretched beyond the
// range of histories. The contact of a bridge has its own row.
int BpmPairLoop::compute_tile(PairTable::Bonds &list, int n, const BondSettings &b) {
  BondTile &tile = list.tile(n);
  gather_spheres(tile);
  run_bonds(tile, *step_, b.material, b.strength, b.criterion, update_, update->dt);
  const int lost = watch_bonds(list, n, b);
  if (&list == &table_.bonds) {
    run_hertz(tile, *step_, materials_.data());
    run_contacts(tile, *step_, materials_.data(), update_, update->dt);
    if (ledger_)
      book_contacts(tile);
  }
  book_moment(tile);
  sum_forces(tile);
  if (ledger_)
    book_bonds(tile);
  if (ledger_ && &list == &table_.bridges && bonds_->shrinks())
    book_shrinking(tile, b.material);
  return lost;
}

void BpmPairLoop::compute_tile(ContactTile &tile) {
  gather_spheres(tile);
  run_hertz(tile, *step_, materials_.data());
  if (memory_ >= 0)
    apply_effects(tile);
  run_contacts(tile, *step_, materials_.data(), update_, update->dt);
  if (update_)
    mark_separated(tile);
  book_moment(tile);
  sum_forces(tile);
  if (ledger_)
    book_contacts(tile);
}

void BpmPairLoop::gather_spheres(const PairTile &t) {
  const double *x = atom->x[0];
  PairStep &s = *step_;
  for (int p = 0; p < t.size; ++p) {
    const int i = t.i[p], j = t.j[p];
    const Sphere &a = spheres_[i], &b = spheres_[j];
    const Vec3 d = difference(x + 3 * i, x + 3 * j);
    s.d.set(p, d);
    s.r_squared[p] = norm_squared(d);
    s.v.set(p, difference(a.v, b.v));
    s.spin_i.set(p, calendem::load(a.omega));
    s.spin_j.set(p, calendem::load(b.omega));
    s.radius_i[p] = a.radius;
    s.radius_j[p] = b.radius;
    s.mass_i[p] = a.mass;
    s.mass_j[p] = b.mass;
  }
  if (cell_)
    add_gradient(t.size);
}

// Velocities are beside the mean motion.
void BpmPairLoop::add_gradient(int size) {
  const double gradient = cell_->step().gradient(update->dt);
  for (int p = 0; p < size; ++p)
    step_->v.x[p] += gradient * step_->d.x[p];
}

// Contacts between types on which an effect acts follow its law instead of Hertz's.
void BpmPairLoop::apply_effects(const ContactTile &t) {
  PairStep &s = *step_;
  for (int p = 0; p < t.size; ++p) {
    const double overlap = acting_overlap(t, s, p);
    if (overlap == 0.0) {
      table_.clear_effect(t.history[p]);
      continue;
    }
    const int a = atom->type[t.i[p]], b = atom->type[t.j[p]];
    if (!effects_.act(a, b) || BondHistory(t.history[p] + bond_).has_reference())
      continue;
    EffectContact contact = EffectContact::of_spheres(a, b, s.radius_i[p], s.radius_j[p], overlap);
    double *memory = t.history[p] + memory_;
    if (update_) {
      effects_.grow(contact, t.i[p], t.j[p]);
      const Vec3 n = (1.0 / std::sqrt(s.r_squared[p])) * s.d[p];
      const double before = overlap + dot(s.v[p], n) * update->dt;
      const double taken = effects_.advance(contact, before, update->dt, memory);
      if (ledger_ && taken != 0.0)
        ledger_->add_taken(t.i[p], t.j[p], taken, effects_.law(a, b).takes);
    }
    s.contact_radius[p] = effects_.contact_radius(contact, memory);
    s.elastic[p] = effects_.force(contact, memory);
  }
}

// Bonds that fail, that are stretched too far, that are lost: few tiles have any.
int BpmPairLoop::watch_bonds(PairTable::Bonds &list, int n, const BondSettings &b) {
  const BondTile &t = list.tile(n);
  PairStep &s = *step_;
  const double range = neighbor->contactDistanceFactor;
  const double limit = kStretchLimit;
  long long events = 0;
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p) {
    const double reach = limit * s.radius_sum(p);
    events += (s.r_squared[p] > reach * reach) | (s.failed[p] != 0.0);
  }
  if (events == 0)
    return 0;
  int lost = 0;
  for (int p = 0; p < t.size; ++p) {
    if (s.r_squared[p] >= range * range * s.radius_sum(p) * s.radius_sum(p)) {
      lost += bonds_->pairs().decides(t.i[p], t.j[p]);
      s.force.set(p, {});
      s.torque_i.set(p, {});
      s.torque_j.set(p, {});
      continue;
    }
    bonds_->check_stretch(std::sqrt(s.r_squared[p]) / s.radius_sum(p));
    if (!update_ || s.failed[p] == 0.0 || !b.breakable)
      continue;
    table_.store_loads(t, p);
    bonds_->record_break(t.i[p], t.j[p], BondHistory(t.history[p] + bond_),
                         bond_of(b.material, t, s, p), t.loads(p));
    list.failed.push_back(n * kTilePairs + p);
  }
  return lost;
}

void BpmPairLoop::mark_separated(ContactTile &t) {
  long long separated = 0;
#pragma GCC ivdep
  for (int p = 0; p < t.size; ++p)
    separated += (t.separating[p] != 0.0) & !step_->touches(p);
  for (int p = 0; separated > 0 && p < t.size; ++p)
    if (t.separating[p] != 0.0 && !step_->touches(p))
      table_.mark_separated(t, p);
}

void BpmPairLoop::sum_forces(const PairTile &t) {
  const PairStep &s = *step_;
  for (int p = 0; virial_ && p < t.size; ++p)
    virial_->ev_tally_xyz(t.i[p], t.j[p], atom->nlocal, 0, 0.0, 0.0, s.force.x[p], s.force.y[p],
                          s.force.z[p], s.d.x[p], s.d.y[p], s.d.z[p]);
  forces_.add_tile(t, *step_);
}

// Each copy of a pair with a ghost has a half.
double BpmPairLoop::moment(const PairTile &t, const VectorRow &force) const {
  double sum = 0.0;
  for (int p = 0; p < t.size; ++p)
    sum += (t.j[p] < atom->nlocal ? 1.0 : 0.5) * force.x[p] * step_->d.x[p];
  return sum;
}

// As long as forces are no whole numbers.
void BpmPairLoop::book_moment(const PairTile &t) {
  if (ledger_ && cell_)
    ledger_->moments().all += moment(t, step_->force);
}

void BpmPairLoop::book_bonds(const BondTile &t) {
  if (cell_)
    ledger_->moments().damped += moment(t, step_->bond_damping);
  for (int p = 0; p < t.size; ++p)
    ledger_->add_damping(
        t.i[p], t.j[p],
        {step_->bond_damping[p], step_->bond_damping_torque_i[p], step_->bond_damping_torque_j[p]});
}

void BpmPairLoop::book_shrinking(const BondTile &t, const calendem::BondMaterial &material) {
  for (int p = 0; p < t.size; ++p)
    ledger_->add_shrinking(t.i[p], t.j[p], bond_of(material, t, *step_, p).tension * t.length[p]);
}

void BpmPairLoop::book_contacts(const PairTile &t) {
  const PairStep &s = *step_;
  if (cell_) {
    ledger_->moments().damped += moment(t, s.contact_damping);
    ledger_->moments().friction += moment(t, s.friction_force);
  }
  for (int p = 0; p < t.size; ++p) {
    ledger_->add_damping(t.i[p], s.contact_damping[p]);
    ledger_->add_damping(t.j[p], -s.contact_damping[p]);
    ledger_->add_friction(t.i[p], {s.friction_force[p], s.friction_torque_i[p]});
    ledger_->add_friction(t.j[p], {-s.friction_force[p], s.friction_torque_j[p]});
  }
}
