// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_cbd_collapse.h"
#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_energy_bpm.h"
#include "fix_time_bpm.h"
#include "fix_wall_gran_platen.h"
#include "force.h"
#include "global_properties.h"
#include "memory.h"
#include "modify.h"
#include "physics/pi.h"
#include "physics/sjkr_cohesion.h"
#include "stop_run.h"
#include "update.h"
#include "words.h"
#include <cmath>
#include <cstdlib>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {
const double kFourThirdsPi = 4.0 / 3.0 * calendem::kPi;
} // namespace

FixCbdCollapse::FixCbdCollapse(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), type_(0), imposed_until_(0.0), nanoporosity_(NULL),
      initial_radius_(NULL), largest_pressure_(0.0), cohesion_energy_density_(NULL),
      pairs_have_effects_(false), bonds_(NULL), energy_(NULL), upper_(NULL) {
  law_.relaxation = 0.1;
  law_.yield_pressure = law_.hardening = -1.0;
  nevery = 50;
  parse(narg, arg);
  since_.first = static_cast<double>(update->ntimestep);
  restart_global = restart_peratom = create_attribute = 1;
  vector_flag = 1;
  size_vector = 4;
  global_freq = 1;
  comm_forward = 1;
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  atom->add_callback(1);
  for (int i = 0; i < atom->nlocal; ++i)
    set_arrays(i);
}

FixCbdCollapse::~FixCbdCollapse() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
  memory->destroy(nanoporosity_);
  memory->destroy(initial_radius_);
}

int FixCbdCollapse::setmask() { return END_OF_STEP; }

void FixCbdCollapse::parse(int narg, char **arg) {
  const NumberReader number(error, this);
  for (int i = 3; i < narg; i += 2) {
    const std::string key = arg[i];
    const char *value = i + 1 < narg ? arg[i + 1] : "";
    if (key == "type")
      type_ = static_cast<int>(number(key, value, whole_between(1, atom->ntypes)));
    else if (key == "initial")
      law_.initial = number(key, value, between(0.0, 0.95));
    else if (key == "floor")
      law_.floor = number(key, value, between(0.0, 0.95));
    else if (key == "yield")
      law_.yield_pressure = number(key, value, between(0.0, 1e9));
    else if (key == "hardening")
      law_.hardening = number(key, value, between(1e-3, 1e9));
    else if (key == "imposed")
      imposed_until_ = number(key, value, between(1e-3, 1e9));
    else if (key == "relaxation")
      law_.relaxation = number(key, value, between(1e-6, 1e9));
    else if (key == "every")
      nevery = static_cast<int>(number(key, value, whole_between(1, 1e6)));
    else {
      const std::string message = "unknown setting '" + key +
                                  "'; known: type, initial, floor, yield, hardening, imposed, "
                                  "relaxation, every";
      error->fix_error(FLERR, this, message.c_str());
    }
  }
  check();
}

void FixCbdCollapse::check() {
  const bool by_law = law_.yield_pressure >= 0.0 && law_.hardening > 0.0;
  if (type_ == 0 || (!by_law && imposed_until_ == 0.0))
    error->fix_error(FLERR, this,
                     "needs at least 'type T yield P hardening H' or 'type T imposed P'");
  if (by_law && imposed_until_ > 0.0)
    error->fix_error(FLERR, this, "'yield' and 'imposed' exclude each other: give one of them");
  if (law_.floor > law_.initial)
    error->fix_error(FLERR, this, "'floor' must not lie above 'initial'");
}

void FixCbdCollapse::post_create() { FixTimeBpm::of(lmp)->claim_state(this); }

void FixCbdCollapse::init() {
  FixTimeBpm::of(lmp)->stop_if_state_is_lost(this);
  reset_dt();
  bonds_ = FixBondBpm::find(lmp, "fix cbd/collapse");
  energy_ = FixEnergyBpm::find(lmp);
  effects_.connect(force->registry, "fix cbd/collapse");
  pairs_have_effects_ = ContactEffects::in_use(lmp);
  force->registry.registerProperty("cohEnergyDens", &MODEL_PARAMS::createCohesionEnergyDensity);
  force->registry.connect("cohEnergyDens", cohesion_energy_density_, "fix cbd/collapse");
  walls_ = FixWallGranPlaten::all(*modify);
  upper_ = NULL;
  for (FixWallGranPlaten *wall : walls_)
    if (wall->is_top())
      upper_ = wall;
  if (imposed_until_ > 0.0 && !upper_)
    error->fix_error(FLERR, this, "'imposed' needs a fix wall/gran/platen with 'side top'");
}

bool FixCbdCollapse::is_mine(int i) const { return i < atom->nlocal && atom->type[i] == type_; }

// What presses, less what cohesion pulls: of the contacts, not of bonds and bridges beside them.
void FixCbdCollapse::add_pair_forces(std::vector<calendem::WideSum> &sum) const {
  const double *R = atom->radius;
  bonds_->pairs().for_each_touching_copy([&](int i, int j, double r, const BondHistory &bond) {
    if (!is_mine(i) && !is_mine(j))
      return;
    const int ti = atom->type[i], tj = atom->type[j];
    const double *memory = pairs_have_effects_ ? bond.effect_memory() : NULL;
    const calendem::ActingContact acting = bond.contact(r, R[i] + R[j]);
    double net =
        effects_.force(EffectContact::of_spheres(ti, tj, R[i], R[j], acting.overlap), memory);
    if (acting.coheres)
      net -= calendem::sjkr_force(cohesion_energy_density_[ti][tj], acting.distance, R[i], R[j]);
    for (int a : {i, j})
      if (is_mine(a))
        sum[a].add(net);
  });
}

void FixCbdCollapse::add_wall_forces(std::vector<calendem::WideSum> &sum) const {
  for (FixWallGranPlaten *wall : walls_) {
    const int tw = wall->atom_type_wall();
    for (int i = 0; i < atom->nlocal; ++i) {
      if (!is_mine(i))
        continue;
      const double R = atom->radius[i];
      const calendem::WallContact at = wall->contact(i);
      const double ced = wall->sticks() ? cohesion_energy_density_[type_][tw] : 0.0;
      sum[i].add(
          effects_.force(EffectContact::at_wall(type_, tw, R, at.overlap), wall->effect_memory(i)) -
          calendem::sjkr_wall_force(ced, at.distance, R));
    }
  }
}

double FixCbdCollapse::rotational_energy() const {
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (is_mine(i)) {
      const calendem::Vec3 w = calendem::load(atom->omega[i]);
      sum += 0.2 * atom->rmass[i] * atom->radius[i] * atom->radius[i] * dot(w, w);
    }
  return sum;
}

void FixCbdCollapse::stop_no_number(int i) {
  char message[200];
  snprintf(message, sizeof message,
           "fix cbd/collapse: a force on particle %d is not a number. The time step is too large, "
           "or something "
           "moves too fast: lower the timestep or the speed",
           static_cast<int>(atom->tag[i]));
  stop_run(lmp, FLERR, message);
}

// The nanoporosities after this update; returns whether one of this rank falls.
bool FixCbdCollapse::decide(const std::vector<calendem::WideSum> &sum, std::vector<double> &next) {
  const double step = static_cast<double>(update->ntimestep), time = since_.at(step);
  since_ = {0.0, step, update->dt};
  bool falls = false;
  largest_pressure_ = 0.0;
  next.assign(atom->nlocal, 0.0);
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!is_mine(i))
      continue;
    if (!sum[i].holds_all())
      stop_no_number(i);
    const double p = calendem::mean_pressure(sum[i].value(), atom->radius[i]);
    const double phi = nanoporosity_[i];
    next[i] = imposed_until_ > 0.0
                  ? law_.follow(phi, law_.imposed(upper_->largest_pressure(), imposed_until_), time)
                  : law_.advance(phi, p, time);
    falls = falls || next[i] < nanoporosity_[i];
    largest_pressure_ = std::fmax(largest_pressure_, p);
  }
  return falls;
}

void FixCbdCollapse::shrink(const std::vector<double> &next) {
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!is_mine(i) || !(next[i] < nanoporosity_[i]))
      continue;
    nanoporosity_[i] = next[i];
    const double r = law_.radius(initial_radius_[i], next[i]);
    atom->radius[i] = r;
    atom->density[i] = atom->rmass[i] / (kFourThirdsPi * r * r * r);
  }
}

void FixCbdCollapse::reset_dt() {
  since_.set_length(static_cast<double>(update->ntimestep), update->dt);
}

void FixCbdCollapse::reset_timestep(bigint newstep, bigint oldstep) {
  since_.renumber(static_cast<double>(oldstep), static_cast<double>(newstep));
}

void FixCbdCollapse::end_of_step() {
  std::vector<calendem::WideSum> sum(atom->nlocal);
  std::vector<double> next;
  add_pair_forces(sum);
  add_wall_forces(sum);
  int mine = decide(sum, next), any = 0;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (!any)
    return;
  const double before = energy_ ? energy_->stored_in_contacts() + rotational_energy() : 0.0;
  shrink(next);
  comm->forward_comm_fix(this);
  bonds_->radii_have_changed();
  if (energy_)
    energy_->add_collapse(before - energy_->stored_in_contacts() - rotational_energy());
}

double FixCbdCollapse::compute_vector(int n) {
  double sums[3] = {0.0, 0.0, 0.0}, ends[2] = {-1.0, largest_pressure_}; // -1: of no sphere
  for (int i = 0; i < atom->nlocal; ++i)
    if (is_mine(i)) {
      const double r = atom->radius[i], r0 = initial_radius_[i];
      sums[0] += 1.0;
      sums[1] += nanoporosity_[i];
      sums[2] += kFourThirdsPi * (r0 * r0 * r0 - r * r * r);
      ends[0] = std::fmax(ends[0], -nanoporosity_[i]);
    }
  double all[3], most[2];
  MPI_Allreduce(sums, all, 3, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(ends, most, 2, MPI_DOUBLE, MPI_MAX, world);
  const double values[] = {all[0] > 0.0 ? all[1] / all[0] : 0.0, -most[0], most[1], all[2]};
  return values[n];
}

void FixCbdCollapse::grow_arrays(int nmax) {
  memory->grow(nanoporosity_, nmax, "cbd/collapse:nanoporosity");
  memory->grow(initial_radius_, nmax, "cbd/collapse:initial_radius");
}

void FixCbdCollapse::copy_arrays(int i, int j, int) {
  nanoporosity_[j] = nanoporosity_[i];
  initial_radius_[j] = initial_radius_[i];
}

void FixCbdCollapse::set_arrays(int i) {
  nanoporosity_[i] = law_.initial;
  initial_radius_[i] = atom->radius[i];
}

int FixCbdCollapse::pack_exchange(int i, double *buf) {
  buf[0] = nanoporosity_[i];
  buf[1] = initial_radius_[i];
  return 2;
}

int FixCbdCollapse::unpack_exchange(int nlocal, double *buf) {
  nanoporosity_[nlocal] = buf[0];
  initial_radius_[nlocal] = buf[1];
  return 2;
}

int FixCbdCollapse::pack_comm(int n, int *list, double *buf, int, int *) {
  for (int k = 0; k < n; ++k)
    buf[k] = atom->radius[list[k]];
  return 1;
}

void FixCbdCollapse::unpack_comm(int n, int first, double *buf) {
  for (int k = 0; k < n; ++k)
    atom->radius[first + k] = buf[k];
}

void FixCbdCollapse::write_restart(FILE *fp) {
  if (comm->me != 0)
    return;
  const int bytes = sizeof since_;
  fwrite(&bytes, sizeof(int), 1, fp);
  fwrite(&since_, sizeof since_, 1, fp);
}

void FixCbdCollapse::restart(char *buf) { memcpy(&since_, buf, sizeof since_); }

int FixCbdCollapse::pack_restart(int i, double *buf) {
  buf[0] = 3;
  buf[1] = nanoporosity_[i];
  buf[2] = initial_radius_[i];
  return 3;
}

void FixCbdCollapse::unpack_restart(int nlocal, int nth) {
  double *values = atom->extra[nlocal];
  int m = 0;
  for (int i = 0; i < nth; ++i)
    m += static_cast<int>(values[m]);
  nanoporosity_[nlocal] = values[m + 1];
  initial_radius_[nlocal] = values[m + 2];
}

double FixCbdCollapse::memory_usage() { return 2.0 * atom->nmax * sizeof(double); }
