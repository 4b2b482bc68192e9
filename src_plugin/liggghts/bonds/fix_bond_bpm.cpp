// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_bond_bpm.h"
#include "bond_command.h"
#include "bond_sums.h"
#include "cell_growth.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_time_bpm.h"
#include "material_checks.h"
#include "modify.h"
#include "mpi_liggghts.h"
#include "neighbor.h"
#include "update.h"
#include "work_ledger.h"
#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;
using calendem::BridgeKind;

namespace {
const int kGatherEvery = 100; // steps
const char *const kHistoriesId = "contacthistory_bpm";
} // namespace

FixBondBpm::FixBondBpm(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), pairs_(lmp), grid_(lmp), map_(lmp, this), atoms_(lmp), insets_(lmp),
      bridges_(lmp, this), watch_(lmp, this), log_(lmp, this) {
  if (!atom->sphere_flag || !atom->tag_enable)
    error->fix_error(FLERR, this, "needs atom_style granular (or sphere) with atom tags");
  if (domain->triclinic)
    error->fix_error(FLERR, this, "works in orthogonal boxes only; this box is triclinic");
  BondCommand command(lmp, this);
  command.read(narg, arg);
  settings_ = command.settings;
  bodies_file_ = command.bodies;
  log_file_ = command.log;
  platen_id_ = command.platen;
  restart_global = restart_peratom = create_attribute = 1;
  vector_flag = 1;
  size_vector = 18;
  global_freq = 1;
  comm_forward = 2;
  neighbor->register_contact_dist_factor(kContactDistanceFactor);
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  atom->add_callback(1);
}

FixBondBpm::~FixBondBpm() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
}

void FixBondBpm::post_create() {
  const char *words[] = {kHistoriesId, "all", "contacthistory/bpm"};
  if (modify->find_fix(kHistoriesId) < 0) // it outlives this fix, to keep its place
    modify->add_fix(3, const_cast<char **>(words));
  time_ = FixTimeBpm::of(lmp);
  time_->claim_state(this);
}

int FixBondBpm::setmask() {
  // PRE_EXCHANGE for its set-up call
  return POST_INTEGRATE | PRE_EXCHANGE | PRE_FORCE | POST_FORCE;
}

FixBondBpm *FixBondBpm::find(LAMMPS *lmp, const char *caller) {
  return static_cast<FixBondBpm *>(BondEvents::find(lmp, caller));
}

int FixBondBpm::modify_param(int narg, char **arg) {
  if (!strcmp(arg[0], "bridges"))
    return bridges_.read(narg, arg, settings_.material.damping);
  if (!strcmp(arg[0], "shrinkage"))
    return bridges_.read_shrinkage(narg, arg);
  BondCommand command(lmp, this);
  command.settings = settings_;
  const int words = command.read_strength(narg, arg);
  settings_ = command.settings;
  return words;
}

void FixBondBpm::init() {
  time_->stop_if_state_is_lost(this);
  refuse_styles();
  grid_.choose();
  ledger_ = WorkLedger::find(lmp);
  MaterialChecks(lmp, this).check_properties();
  check_bridges();
  check_radii();
  if (restarted_)
    earlier_.check(settings_to_repeat(), error, this);
  if (!created_) {
    map_.read(bodies_file_);
    bodies_ = map_.highest();
    for (int i = 0; i < atom->nlocal; ++i)
      atoms_.set_body(i, map_.of_tag(atom->tag[i]));
  }
  log_.open(log_file_);
}

// A minimizer follows an energy, and the host's contacts have none; each of its iterations would
// advance histories like a time step. Respa does not call what makes the bonds. Fix multisphere
// excludes pairs of one molecule before it has told spheres that they are in none.
void FixBondBpm::refuse_styles() {
  if (update->whichflag == 2)
    error->fix_error(
        FLERR, this,
        "'minimize' does not know the energy of contacts and bonds. To let spheres come "
        "to rest, 'run' with fix viscous or nve/limit, or with 'damping' of the bonds");
  if (!strcmp(update->integrate_style, "respa"))
    error->fix_error(FLERR, this,
                     "'run_style respa' makes no bonds. Use 'run_style verlet', the default");
  if (modify->n_fixes_style("multisphere") + modify->n_fixes_style("concave") > 0)
    error->fix_error(FLERR, this,
                     "fix multisphere leaves pairs of spheres out of LIGGGHTS' first lists, and "
                     "with them their bonds. For rigid clusters of spheres use fix rigid");
}

void FixBondBpm::check_bridges() {
  bridges_.check();
  if (bridges_.shrinkage().strain <= 0.0)
    return;
  const Fix *ledger = dynamic_cast<Fix *>(ledger_);
  if (ledger && modify->find_fix(ledger->id) < modify->find_fix(id))
    error->fix_error(FLERR, this, "with 'shrinkage' it must stand before fix energy/bpm");
  bridges_.begin_shrinking();
}

void FixBondBpm::check_radii() {
  double least = HUGE_VAL, all = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    least = std::fmin(least, atom->radius[i]);
  MPI_Allreduce(&least, &all, 1, MPI_DOUBLE, MPI_MIN, world);
  if (settings_.surface_inset > 0.5 * all)
    error->fix_error(FLERR, this, "'surface_inset' is more than half of the smallest radius");
}

void FixBondBpm::setup_pre_exchange() { grid_.put_atoms_on(); }

void FixBondBpm::post_integrate() {
  if (domain->box_change_size && !CellGrowth::find(lmp))
    grid_.choose(); // of fix deform; fix elongation keeps the cell on it
  grid_.put_atoms_on();
  if (bridges_.shrinkage().strain > 0.0)
    bridges_.shrink(update->dt);
}

void FixBondBpm::setup_pre_force(int) {
  watch_.begin_run();
  grid_.check_box(this);
  creating_ = !created_;
  if (creating_)
    comm->forward_comm_fix(this);
  pre_force(0);
}

// Pairs that are new in the lists, or whose history the host has dropped, know of no bond. Beside a
// bridge the contact goes on as it was.
void FixBondBpm::pre_force(int) {
  const bool others = settings_.contact_diameter < 1.0 || settings_.surface_inset > 0.0;
  if (!others || neighbor->ago != 0)
    return;
  insets_.find(settings_, pairs_, atoms_.bodies(), [this](int i, int j, const BondHistory &bond) {
    return bond.state() == kIntact || (creating_ && are_to_bond(i, j, pairs_.distance(i, j), bond));
  });
  comm->forward_comm_fix(this);
  pairs_.for_each_neighbor([this](int i, int j, BondHistory &bond) {
    if (!bond.has_reference())
      bond.meet_at(insets_.not_into_contact(i, j, bond.meeting_distance(), meeting_distance(i, j)));
  });
}

// Pairs of a body that meet at a part of their radii do so at those of now.
void FixBondBpm::radii_have_changed() {
  if (settings_.contact_diameter == 1.0)
    return;
  pairs_.for_each_neighbor([this](int i, int j, BondHistory &bond) {
    const bool apart = bond.state() == kNeverBonded || bond.state() == kBrokenSeparated;
    if (apart && atoms_.in_one(i, j))
      bond.meet_at(meeting_distance(i, j));
  });
}

double FixBondBpm::meeting_distance(int i, int j) const {
  return insets_.meeting_distance(settings_, atoms_.in_one(i, j), i, j);
}

bool FixBondBpm::are_to_bond(int i, int j, double r, const BondHistory &bond) const {
  const double farthest = settings_.reach * (atom->radius[i] + atom->radius[j]);
  return bond.state() == kNeverBonded && atoms_.in_one(i, j) && r < farthest;
}

void FixBondBpm::make_bond(int i, int j, double r, BondHistory &bond) const {
  if (!are_to_bond(i, j, r, bond))
    return;
  const int body = atoms_.body(i);
  bond.create(r,
              settings_.strengths.factor({atom->tag[i], atom->tag[j], body, map_.diameter(body)}));
}

void FixBondBpm::mark_separated(int i, int j, BondHistory &bond) const {
  bond.set_state(kBrokenSeparated);
  bond.meet_at(meeting_distance(i, j));
}

void FixBondBpm::setup(int) {
  stop_if_overflowed();
  watch_.set_spheres(static_cast<bigint>(atom->natoms));
  if (!creating_)
    return;
  creating_ = false;
  created_ = true;
  initial_ = BondSums(lmp, *this).intact();
  for (FILE *out : {screen, logfile})
    if (comm->me == 0 && out)
      fprintf(out, "fix %s: " BIGINT_FORMAT " bonds made\n", id, initial_);
  if (bridges_.on())
    bridges_.count_made(pairs_);
}

// Counts those of all ranks, by what was made and what is known to have broken.
bigint FixBondBpm::acting_pairs() const {
  bigint pairs = initial_ - log_.totals().broken();
  for (const BridgeKind kind : {BridgeKind::AmCbd, BridgeKind::CbdCbd})
    pairs += bridges_.made(kind) - log_.totals().of_bridges[int(kind)];
  return pairs;
}

void FixBondBpm::record_break(int i, int j, BondHistory bond, const calendem::BondPair &pair,
                              const calendem::BondLoads &loads) {
  const BondSettings &set = settings_of(bond);
  const calendem::BondStress s = pair.stress(loads, set.criterion);
  const bool i_is_low = atom->tag[i] < atom->tag[j], of_bridge = bond.state() == kBridge;
  const int low = i_is_low ? i : j, high = i_is_low ? j : i;
  const double *a = atom->x[low], *b = atom->x[high];
  const BreakEvent e = {
      time_->now(),
      static_cast<double>(atom->tag[low]),
      static_cast<double>(atom->tag[high]),
      of_bridge ? -1.0 : static_cast<double>(atoms_.body(low < atom->nlocal ? low : high)),
      of_bridge ? static_cast<double>(bridges_.kind_of(i, j))
                : static_cast<double>(break_mode(s, set.strength_of(bond.strength_factor()))),
      s.sigma(),
      s.tau(),
      0.5 * (a[0] + b[0]),
      0.5 * (a[1] + b[1]),
      0.5 * (a[2] + b[2]),
      0.0,
      pair.strain_energy(loads)};
  failing_.push_back({i, j, bond, e});
}

void FixBondBpm::bridge_breaks_on_wall(int i, double energy) {
  BreakEvent e = {};
  e.time = time_->now();
  e.tag_high = static_cast<double>(atom->tag[i]);
  e.body = -1.0;
  e.mode = static_cast<double>(BridgeKind::CbdCollector);
  e.energy = energy;
  log_.add(e);
}

void FixBondBpm::post_force(int) {
  const bool new_lists = neighbor->ago == 0 || !watch_.has_stepped();
  watch_.end_step(pairs_, new_lists);
  const bool due = new_lists || update->ntimestep % kGatherEvery == 0;
  if (due || (watch_.is_wrong() && comm->nprocs == 1))
    stop_if_wrong();
  stop_if_overflowed();
  apply_breaks();
  if (update->ntimestep % kGatherEvery == 0)
    log_.gather();
}

void FixBondBpm::stop_if_wrong() { watch_.stop_if_wrong(acting_pairs(), log_.waiting()); }

// By this rank at once: the forces of this step are wrong.
void FixBondBpm::stop_if_overflowed() {
  if (overflowed_ > 0)
    pairs_.loop()->stop_overflow(overflowed_);
}

// What is looked for now and then is looked for at the end, if there was a step.
void FixBondBpm::post_run() {
  if (watch_.has_stepped())
    stop_if_wrong();
  log_.gather();
}

// After the step's last force. A copy of a pair whose other one is on another rank fails there as
// well.
void FixBondBpm::apply_breaks() {
  if (failing_.empty())
    return;
  const double pressure = platen_pressure();
  for (Break &b : failing_) {
    if (ledger_)
      ledger_->bond_breaks(b.i, b.j, b.bond);
    const bool of_body = !b.event.of_bridge();
    b.bond.set_state(of_body ? kBrokenTouching : kBrokenSeparated);
    b.bond.set_loads({});
    if (of_body)
      atoms_.count_break(b.i);
    if (of_body && b.j < atom->nlocal)
      atoms_.count_break(b.j);
    if (!pairs_.decides(b.i, b.j))
      continue;
    b.event.pressure = pressure;
    log_.add(b.event);
    watch_.count_break();
  }
  failing_.clear();
}

// Averaged, of the step; 0 without a platen.
double FixBondBpm::platen_pressure() const {
  const int platen = platen_id_.empty() ? -1 : modify->find_fix(platen_id_.c_str());
  return platen < 0 ? 0.0 : modify->fix[platen]->compute_vector(4);
}

double FixBondBpm::compute_vector(int n) {
  if (n == 0)
    return initial_;
  log_.gather();
  const BreakTotals &totals = log_.totals();
  if (n == 1)
    return BondSums(lmp, *this).checked_intact(initial_, totals.broken(), this);
  if (n == 2)
    return totals.broken();
  if (n <= 6)
    return totals.of_mode[n - 2];
  if (n >= 9)
    return bridges_.output(n - 9, *this, totals);
  return n == 8 ? totals.energy : BondSums(lmp, *this).strain_energy(kIntact);
}

// The host calls this for every atom at the first set-up too, after init().
void FixBondBpm::set_arrays(int i) { atoms_.set_arrays(i, map_.of_tag(atom->tag[i])); }

int FixBondBpm::pack_comm(int n, int *list, double *buf, int, int *) {
  for (int k = 0; k < n; ++k) {
    buf[2 * k] = atoms_.body(list[k]);
    buf[2 * k + 1] = insets_.of(list[k]);
  }
  return 2;
}

void FixBondBpm::unpack_comm(int n, int first, double *buf) {
  for (int k = n - 1; k >= 0; --k) {
    atoms_.set_body(first + k, static_cast<int>(buf[2 * k]));
    insets_.set(first + k, buf[2 * k + 1]);
  }
}

void FixBondBpm::write_restart(FILE *fp) {
  log_.gather();
  if (comm->me != 0)
    return;
  BondRecord record;
  record.created = created_;
  record.made = initial_;
  record.totals = log_.totals();
  for (int k = 0; k < calendem::kBridgeKinds; ++k)
    record.bridges_made[k] = bridges_.made(static_cast<BridgeKind>(k));
  record.shrunk = bridges_.shrunk();
  record.repeated = settings_to_repeat();
  record.bodies = bodies_;
  record.largest_radius = largest_radius_;
  record.events = log_.events();
  record.write(fp);
}

void FixBondBpm::restart(char *buf) {
  BondRecord record;
  record.read(buf, error, this);
  created_ = restarted_ = record.created != 0.0;
  initial_ = record.made;
  for (int k = 0; k < calendem::kBridgeKinds; ++k)
    bridges_.set_made(static_cast<BridgeKind>(k), record.bridges_made[k]);
  bridges_.restart(record.shrunk);
  earlier_ = record.repeated;
  bodies_ = record.bodies;
  largest_radius_ = record.largest_radius;
  log_.restart(record.totals, record.events);
}

// What pairs keep in their histories follows from these.
RepeatedSettings FixBondBpm::settings_to_repeat() const {
  return {settings_.contact_diameter, settings_.surface_inset, settings_.inset_fading,
          bridges_.shrinkage().strain, bridges_.shrinkage().time};
}

double FixBondBpm::memory_usage() { return 2.0 * atom->nmax * sizeof(int) + log_.memory_usage(); }
