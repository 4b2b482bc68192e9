// SPDX-License-Identifier: GPL-2.0-or-later
#include "wall_bridges.h"
#include "atom.h"
#include "domain.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_property_atom.h"
#include "laws/phases.h"
#include "modify.h"
#include "mpi_liggghts.h"
#include "update.h"
#include "work_ledger.h"

using namespace LAMMPS_NS;
using calendem::BridgeKind;

namespace {
// Beside the bond's values, where on the wall it ends.
const int kX = BondHistory::kSize, kY = kX + 1, kValues = kY + 1;
} // namespace

struct WallBridges::Bridge : calendem::BondPair {
  BondHistory bond;
  calendem::BondDamping damping;

  Bridge(const WallBridges &wall, int i)
      : BondPair(wall.material(), wall.atom->radius[i], wall.atom->radius[i],
                 BondHistory(wall.values(i)).length(), wall.motion(i)),
        bond(wall.values(i)),
        damping(BondPair::damping(wall.material(), wall.atom->radius[i], wall.atom->radius[i],
                                  wall.atom->rmass[i])) {}
};

WallBridges::WallBridges(LAMMPS *lmp, const std::string &wall, double z)
    : Pointers(lmp), name_("bridges_" + wall), z_(z), creating_(false), bonds_(NULL),
      storage_(NULL) {}

void WallBridges::add_storage(const char *caller) {
  std::vector<std::string> words = {name_, "all", "property/atom", name_, "vector", "yes",
                                    "no",  "no"};
  words.insert(words.end(), kValues, "0.");
  std::vector<char *> arg;
  for (std::string &word : words)
    arg.push_back(&word[0]);
  modify->add_fix(static_cast<int>(arg.size()), arg.data());
  storage_ = static_cast<FixPropertyAtom *>(
      modify->find_fix_property(name_.c_str(), "property/atom", "vector", kValues, 0, caller));
}

void WallBridges::delete_storage() {
  modify->delete_fix(name_.c_str());
  if (bonds_)
    bonds_->bridges().set_on_collector(NULL);
}

void WallBridges::init(int wall) {
  bonds_ = FixBondBpm::find(lmp, "fix wall/gran/platen with bridges");
  if (bonds_->bridges().on_collector() && bonds_->bridges().on_collector() != this)
    error->all(FLERR, "only one fix wall/gran/platen may have 'bridges yes'");
  bonds_->bridges().set_on_collector(this);
  if (modify->find_fix(bonds_->id) > wall)
    error->all(FLERR, "a fix wall/gran/platen with 'bridges yes' must stand behind fix bond/bpm");
}

double *WallBridges::values(int i) const { return storage_->array_atom[i]; }

bool WallBridges::stands(int i) const { return BondHistory(values(i)).state() == kBridge; }

const calendem::BondMaterial &WallBridges::material() const {
  return bonds_->bridge_settings().material;
}

calendem::PairMotion WallBridges::motion(int i) const {
  const double *x = atom->x[i], *end = values(i);
  double arm[3] = {x[0] - end[kX], x[1] - end[kY], x[2] - z_};
  const double height = arm[2]; // the box is not periodic along z
  domain->minimum_image(arm);
  return calendem::motion_on_wall({arm[0], arm[1], height}, calendem::load(atom->v[i]),
                                  calendem::load(atom->omega[i]));
}

void WallBridges::note_creation() { creating_ = bonds_->creating(); }

void WallBridges::create(int type) {
  const double tensile = bonds_->bridges().law().tensile_of(BridgeKind::CbdCollector);
  if (!creating_ || tensile <= 0.0 || type != int(calendem::Phase::Collector))
    return;
  for (int i = 0; i < atom->nlocal; ++i) {
    const double height = atom->x[i][2] - z_;
    if (atom->type[i] != int(calendem::Phase::Cbd) ||
        !bonds_->bridges().law().spans(atom->radius[i], height))
      continue;
    BondHistory(values(i)).create(height, tensile, kBridge);
    values(i)[kX] = atom->x[i][0];
    values(i)[kY] = atom->x[i][1];
  }
  creating_ = false;
  const bigint mine = intact();
  bigint all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  bonds_->bridges().set_made(BridgeKind::CbdCollector, all);
}

void WallBridges::act(bool update) {
  WorkLedger *ledger = WorkLedger::find(lmp);
  force_.assign(atom->nlocal, 0.0);
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!stands(i))
      continue;
    Bridge bridge(*this, i);
    calendem::BondLoads loads = bridge.bond.loads();
    if (update)
      bridge.advance(loads, this->update->dt);
    bridge.bond.set_loads(loads);
    const calendem::BondAction a = bridge.action(loads, bridge.damping);
    calendem::add_to(a.force, atom->f[i]);
    calendem::add_to(a.torque_i, atom->torque[i]);
    force_[i] = a.force.z;
    if (ledger) {
      const calendem::BondAction damping = bridge.damping_action(bridge.damping);
      ledger->add_damping(i, {damping.force, damping.torque_i});
      if (bonds_->shrinks())
        ledger->add_shrinking(bridge.tension * bridge.bond.length());
    }
    if (update)
      break_if_it_fails(i, bridge);
  }
}

void WallBridges::break_if_it_fails(int i, Bridge &bridge) {
  const BondSettings &set = bonds_->bridge_settings();
  const calendem::BondLoads loads = bridge.bond.loads();
  if (!bridge.fails(loads, set.strength_of(bridge.bond.strength_factor()), set.criterion))
    return;
  const calendem::BondAction last = bridge.action(loads);
  if (WorkLedger *ledger = WorkLedger::find(lmp)) {
    ledger->force_ends(i, {last.force, last.torque_i});
    ledger->shrinking_ends(bridge.tension * bridge.bond.length());
  }
  bonds_->bridge_breaks_on_wall(i, bridge.strain_energy(loads));
  bridge.bond.set_state(kBrokenSeparated);
  bridge.bond.set_loads({});
}

bigint WallBridges::intact() const {
  bigint n = 0;
  for (int i = 0; i < atom->nlocal; ++i)
    n += stands(i);
  return n;
}

double WallBridges::strain_energy() const {
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (stands(i)) {
      const Bridge bridge(*this, i);
      sum += bridge.strain_energy(bridge.bond.loads());
    }
  return sum;
}

void WallBridges::add_to_blocks(calendem::SphereBlock *stiffness, calendem::SphereBlock *damping,
                                int i) const {
  if (!stands(i))
    return;
  const Bridge bridge(*this, i);
  stiffness->add(bridge.stiffness, bridge.motion.n, bridge.motion.r);
  damping->add(bridge.damping, bridge.motion.n, bridge.motion.r);
}
