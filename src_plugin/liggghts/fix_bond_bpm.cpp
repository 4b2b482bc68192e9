// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_bond_bpm.h"
#include "bpm_pair_loop.h"
#include "comm.h"
#include "contact_effects.h"
#include "domain.h"
#include "error.h"
#include "fix_contact_history.h"
#include "fix_elongation.h"
#include "fix_energy_bpm.h"
#include "memory.h"
#include "modify.h"
#include "mpi_liggghts.h"
#include "neighbor.h"
#include "physics/fixed_point.h"
#include "update.h"
#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {
const int kEventSize = sizeof(BreakEvent) / sizeof(double);
const int kGatherEvery = 100; // steps
} // namespace

FixBondBpm::FixBondBpm(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), energy_(NULL), body_(NULL), broken_(NULL), history_offset_(-1),
      created_(false), creating_(false), log_ready_(false), initial_(0), by_mode_(),
      energy_lost_(0.0), bridges_made_(), bridges_broken_(), bridge_energy_lost_(0.0),
      overstretched_(0.0), acting_(0), expected_(-1), missing_(0), spacing_() {
  if (!atom->sphere_flag || !atom->tag_enable)
    error->fix_error(FLERR, this, "needs atom_style granular (or sphere) with atom tags");
  if (domain->triclinic)
    error->fix_error(FLERR, this, "works in orthogonal boxes only; this box is triclinic");
  parse(narg, arg);
  restart_global = restart_peratom = create_attribute = 1;
  vector_flag = 1;
  size_vector = 18;
  global_freq = 1;
  comm_forward = 2;
  neighbor->register_contact_dist_factor(kContactDistanceFactor);
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  atom->add_callback(1);
  for (int i = 0; i < atom->nmax; ++i)
    body_[i] = broken_[i] = 0;
}

FixBondBpm::~FixBondBpm() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
  memory->destroy(body_);
  memory->destroy(broken_);
}

int FixBondBpm::setmask() {
  // PRE_EXCHANGE for its set-up call
  return POST_INTEGRATE | PRE_EXCHANGE | PRE_FORCE | POST_FORCE | END_OF_STEP;
}

FixBondBpm *FixBondBpm::find(LAMMPS *lmp, const char *caller) {
  const int n = lmp->modify->n_fixes_style_strict("bond/bpm");
  if (n != 1) {
    char message[256];
    snprintf(message, sizeof message,
             "%s needs exactly one 'fix ID all bond/bpm ...' in the script; found %d", caller, n);
    lmp->error->all(FLERR, message);
  }
  return static_cast<FixBondBpm *>(lmp->modify->find_fix_style_strict("bond/bpm", 0));
}

int FixBondBpm::friction_history_offset(int bond_offset) {
  history_offset_ = bond_offset;
  PairGran *pair = static_cast<PairGran *>(force->pair_match("gran", 1));
  const int first = bond_offset + BondHistory::kSize +
                    (ContactEffects::in_use(lmp) ? ContactEffects::kMemory : 0);
  const int rest = pair->dnum_pair() - first;
  if (rest == 0)
    return -1;
  if (rest != 3)
    error->fix_error(
        FLERR, this,
        "works with 'model hertz|hertz_effects tangential history|no_history|off' without rolling "
        "friction history; the pair style stores other values too");
  return first;
}

void FixBondBpm::init() {
  choose_grid();
  energy_ = FixEnergyBpm::find(lmp);
  check_materials();
  check_radii();
  check_shrinkage();
  check_remembered();
  if (!created_)
    read_bodies();
  if (!log_ready_)
    open_log();
}

void FixBondBpm::check_box() {
  const double cut = 2.0 * neighbor->cutneighmax;
  for (int k = 0; k < 3; ++k)
    if (domain->periodicity[k] && domain->prd[k] < cut) {
      char message[256];
      snprintf(message, sizeof message,
               "periodic box side %c is %g, shorter than two neighbour cut-offs (%g): a particle "
               "would touch two images of another. Make the cell larger or the skin smaller",
               "xyz"[k], domain -> prd[k], cut);
      error->fix_error(FLERR, this, message);
    }
}

// Ghosts lie beyond the box by no more than its half: check_box().
void FixBondBpm::choose_grid() {
  const FixElongation *elongation = FixElongation::find(lmp);
  for (int k = 0; k < 3; ++k) {
    spacing_[k] = 0.0;
    if (!domain->periodicity[k])
      continue;
    const double largest = std::max(std::fabs(domain->boxlo[k]), std::fabs(domain->boxhi[k]));
    const double growth = elongation && k == 0 ? elongation->growth_to_come() : 0.0;
    spacing_[k] = calendem::exact_spacing((1.0 + growth) * (largest + 0.5 * domain->prd[k]));
    domain->boxlo[k] = calendem::nearest_multiple(domain->boxlo[k], spacing_[k]);
    domain->boxhi[k] = calendem::nearest_multiple(domain->boxhi[k], spacing_[k]);
  }
  domain->set_global_box();
  domain->set_local_box();
}

void FixBondBpm::put_on_grid() {
  for (int k = 0; k < 3; ++k) {
    const double spacing = spacing_[k], per_spacing = 1.0 / spacing; // powers of two
    for (int i = 0; spacing > 0.0 && i < atom->nlocal; ++i)
      atom->x[i][k] = std::rint(atom->x[i][k] * per_spacing) * spacing;
  }
}

void FixBondBpm::setup_pre_exchange() {
  put_on_grid();
  pre_exchange();
}

// New lists follow. The host has saved the old ones before it calls any other fix.
void FixBondBpm::pre_exchange() {
  if (!loop_ || !loop_->holds_histories())
    return;
  loop_->release_histories();
  static_cast<PairGran *>(force->pair_match("gran", 1))->get_fix_history()->pre_exchange();
}

void FixBondBpm::store_histories() {
  if (loop_)
    loop_->store_histories();
}

void FixBondBpm::post_integrate() {
  put_on_grid();
  if (shrinkage_.strain > 0.0)
    shrink(update->dt);
}

void FixBondBpm::setup_pre_force(int) {
  expected_ = -1;
  check_box();
  creating_ = !created_;
  if (creating_)
    comm->forward_comm_fix(this);
  pre_force(0);
}

// Pairs that are new in the lists, or whose history the host has dropped, know of no bond.
void FixBondBpm::pre_force(int) {
  const bool others = settings_.contact_diameter < 1.0 || settings_.surface_inset > 0.0;
  if (!others || neighbor->ago != 0)
    return;
  find_insets();
  comm->forward_comm_fix(this);
  for_each_neighbor([this](int i, int j, BondHistory &bond) {
    if (bond.state() == kNeverBonded)
      bond.meet_at(not_into_contact(i, j, bond.length(), meeting_distance(i, j)));
  });
}

// Surfaces that come out again do so up to each other: a contact never begins with a force.
double FixBondBpm::not_into_contact(int i, int j, double before, double length) const {
  if (length > 0.0 || before >= length)
    return length;
  const double r = norm(calendem::load(atom->x[i]) - calendem::load(atom->x[j]));
  return std::max(before, std::min(length, r - atom->radius[i] - atom->radius[j]));
}

// Of the primaries of bodies; smaller by its fading times the part of their bonds that is broken.
void FixBondBpm::find_insets() {
  inset_.assign(atom->nmax, 0.0);
  if (settings_.surface_inset == 0.0)
    return;
  if (settings_.inset_fading > 0.0)
    for_each_neighbor([this](int i, int j, const BondHistory &bond) {
      if (bond.state() != kIntact)
        return;
      ++inset_[i];
      if (j < atom->nlocal)
        ++inset_[j];
    });
  for (int i = 0; i < atom->nlocal; ++i) {
    const double lost = broken_[i] == 0 ? 0.0 : broken_[i] / (inset_[i] + broken_[i]);
    inset_[i] =
        body_[i] > 0 ? settings_.surface_inset * (1.0 - settings_.inset_fading * lost) : 0.0;
  }
}

void FixBondBpm::setup(int) {
  if (!creating_)
    return;
  creating_ = false;
  created_ = true;
  initial_ = count_intact();
  if (comm->me == 0 && screen)
    fprintf(screen, "fix %s: " BIGINT_FORMAT " bonds made\n", id, initial_);
  if (comm->me == 0 && logfile)
    fprintf(logfile, "fix %s: " BIGINT_FORMAT " bonds made\n", id, initial_);
  if (bridges_.on())
    count_bridges_made();
}

// Of every pair on two ranks, or across a periodic side, both copies are intact or none.
bool FixBondBpm::copies_agree() {
  bigint mine = 0, all = 0;
  for_each_acting_copy([&](int i, int j, const BondHistory &) {
    if (j >= atom->nlocal)
      mine += decides(i, j) ? 1 : -1;
  });
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  return all == 0;
}

bigint FixBondBpm::count_intact() {
  bigint mine = 0, all = 0;
  for_each_intact([&mine](int, int, const BondHistory &) { ++mine; });
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  return all;
}

void FixBondBpm::record_break(int i, int j, BondHistory bond, const calendem::BondPair &pair,
                              const calendem::BondLoads &loads) {
  const BondSettings &set = settings_of(bond);
  const calendem::BondStress s = pair.stress(loads, set.criterion);
  const bool i_is_low = atom->tag[i] < atom->tag[j], of_bridge = bond.state() == kBridge;
  const int low = i_is_low ? i : j, high = i_is_low ? j : i;
  const double *a = atom->x[low], *b = atom->x[high];
  const BreakEvent e = {
      update->ntimestep * update->dt,
      static_cast<double>(atom->tag[low]),
      static_cast<double>(atom->tag[high]),
      of_bridge ? -1.0 : static_cast<double>(body_[low < atom->nlocal ? low : high]),
      of_bridge ? static_cast<double>(kind_of_bridge(i, j))
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

void FixBondBpm::gather_breaks() {
  const int nprocs = comm->nprocs;
  std::vector<int> counts(nprocs), starts(nprocs, 0);
  const int mine = kEventSize * static_cast<int>(mine_.size());
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (int p = 1; p < nprocs; ++p)
    starts[p] = starts[p - 1] + counts[p - 1];
  std::vector<BreakEvent> all((starts[nprocs - 1] + counts[nprocs - 1]) / kEventSize);
  if (all.empty())
    return;
  MPI_Allgatherv(mine_.data(), mine, MPI_DOUBLE, all.data(), counts.data(), starts.data(),
                 MPI_DOUBLE, world);
  mine_.clear();
  std::sort(all.begin(), all.end());
  for (const BreakEvent &e : all) {
    ++(e.of_bridge() ? bridges_broken_ : by_mode_)[static_cast<int>(e.mode)];
    (e.of_bridge() ? bridge_energy_lost_ : energy_lost_) += e.energy;
  }
  all.erase(
      std::remove_if(all.begin(), all.end(), [](const BreakEvent &e) { return e.of_bridge(); }),
      all.end());
  log_breaks(all);
}

void FixBondBpm::post_force(int) {
  const bool new_lists = neighbor->ago == 0 || expected_ < 0;
  check_acting(new_lists);
  const bool wrong = overstretched_ > 0.0 || missing_ != 0;
  const bool due = new_lists || update->ntimestep % kGatherEvery == 0;
  if (due || (wrong && comm->nprocs == 1))
    stop_if_wrong();
  apply_breaks();
  if (update->ntimestep % kGatherEvery == 0) {
    stop_if_overflowed();
    gather_breaks();
  }
}

void FixBondBpm::post_run() {
  stop_if_overflowed();
  gather_breaks();
}

bigint FixBondBpm::broken() const { return by_mode_[1] + by_mode_[2] + by_mode_[3] + by_mode_[4]; }

// After the step's last force. A copy of a pair whose other one is on another rank fails there as
// well.
void FixBondBpm::apply_breaks() {
  if (failing_.empty())
    return;
  const double pressure = platen_pressure();
  for (Break &b : failing_) {
    if (energy_)
      energy_->bond_breaks(b.i, b.j, b.bond);
    const bool of_body = !b.event.of_bridge();
    if (of_body)
      b.bond.set_state(kBrokenTouching);
    else
      separate(b.i, b.j, b.bond);
    b.bond.set_loads({});
    broken_[b.i] += of_body;
    if (b.j < atom->nlocal)
      broken_[b.j] += of_body;
    if (!decides(b.i, b.j))
      continue;
    b.event.pressure = pressure;
    mine_.push_back(b.event);
    --expected_;
  }
  failing_.clear();
}

double FixBondBpm::compute_vector(int n) {
  if (n == 0)
    return initial_;
  gather_breaks();
  if (n == 1) {
    const bigint intact = count_intact();
    if (intact + broken() != initial_ || !copies_agree()) {
      char message[256];
      snprintf(message, sizeof message,
               "bonds do not add up: " BIGINT_FORMAT " made, " BIGINT_FORMAT
               " intact, " BIGINT_FORMAT
               " logged as broken. A bond vanished without a break, or broke on one rank only",
               initial_, intact, broken());
      error->fix_error(FLERR, this, message);
    }
    return intact;
  }
  if (n == 2)
    return broken();
  if (n <= 6)
    return by_mode_[n - 2];
  if (n >= 9)
    return bridge_vector(n - 9);
  return n == 8 ? energy_lost_ : strain_energy_of(kIntact);
}

calendem::BondPair FixBondBpm::pair_of(int i, int j, const BondHistory &bond) const {
  const calendem::Vec3 d = calendem::load(atom->x[i]) - calendem::load(atom->x[j]);
  return {settings_of(bond).material, atom->radius[i], atom->radius[j], bond.length(),
          calendem::pair_at_rest(d)};
}

double FixBondBpm::strain_energy_of(BondState state) {
  double mine = 0.0, all = 0.0;
  for_each_acting_copy([&](int i, int j, const BondHistory &bond) {
    if (bond.state() != state || !decides(i, j))
      return;
    mine += pair_of(i, j, bond).strain_energy(bond.loads());
  });
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}
