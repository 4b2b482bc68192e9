// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_energy_bpm.h"
#include "cell_growth.h"
#include "comm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_property_atom.h"
#include "fix_time_bpm.h"
#include "fix_wall_gran_platen.h"
#include "force.h"
#include "global_properties.h"
#include "modify.h"
#include "physics/contact_pair.h"
#include "physics/sjkr_cohesion.h"
#include "update.h"
#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace FixConst;
using calendem::Vec3;

FixEnergyBpm::FixEnergyBpm(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), bonds_(NULL), cell_(NULL), pairs_have_effects_(false),
      cohesion_energy_density_(NULL), last_moment_(0.0) {
  if (narg != 3)
    error->fix_error(FLERR, this, "takes no arguments: 'fix ID all energy/bpm'");
  vector_flag = 1;
  size_vector = 9;
  global_freq = 1;
  restart_global = 1;
  grow_arrays(atom->nmax);
  atom->add_callback(0);
}

FixEnergyBpm::~FixEnergyBpm() { atom->delete_callback(id, 0); }

int FixEnergyBpm::setmask() { return POST_INTEGRATE | PRE_FORCE | POST_FORCE; }

FixEnergyBpm *FixEnergyBpm::find(LAMMPS *lmp) {
  return static_cast<FixEnergyBpm *>(lmp->modify->find_fix_style_strict("energy/bpm", 0));
}

void FixEnergyBpm::post_create() { FixTimeBpm::of(lmp)->claim_state(this); }

void FixEnergyBpm::init() {
  FixTimeBpm::of(lmp)->stop_if_state_is_lost(this);
  if (modify->n_fixes_style_strict("energy/bpm") > 1)
    error->fix_error(FLERR, this, "there may be only one");
  bonds_ = FixBondBpm::find(lmp, "fix energy/bpm");
  cell_ = CellGrowth::find(lmp);
  force->registry.registerProperty("cohEnergyDens", &MODEL_PARAMS::createCohesionEnergyDensity);
  force->registry.connect("cohEnergyDens", cohesion_energy_density_, "fix energy/bpm");
  find_walls();
  pairs_have_effects_ = ContactEffects::in_use(lmp);
  effects_.connect(force->registry, "fix energy/bpm");
}

void FixEnergyBpm::add_taken(int i, int j, double work, calendem::WorkTaken term) {
  if (bonds_->pairs().decides(i, j))
    add_taken(work, term);
}

void FixEnergyBpm::add_shrinking(int i, int j, double work) {
  if (bonds_->pairs().decides(i, j))
    add_shrinking(work);
}

void FixEnergyBpm::find_walls() {
  walls_.clear();
  bool behind = false;
  for (int k = 0; k < modify->nfix; ++k) {
    behind = behind || modify->fix[k] == this;
    FixWallGranPlaten *wall = dynamic_cast<FixWallGranPlaten *>(modify->fix[k]);
    if (wall && behind)
      error->fix_error(FLERR, this, "must stand behind the fixes wall/gran/platen in the script");
    if (wall && !wall->sticks() && !wall->contact_match("cohesion", "off"))
      error->fix_error(FLERR, this,
                       "knows no cohesion of walls but 'cohesion sjkr'; a fix wall/gran/platen has "
                       "another");
    if (wall)
      walls_.push_back({wall, wall->sticks(), 0.0, 0.0});
  }
}

void FixEnergyBpm::grow_arrays(int nmax) { loads_.resize(nmax); }

void FixEnergyBpm::pre_force(int) {
  std::fill(loads_.begin(), loads_.begin() + atom->nlocal + atom->nghost, AtomLoads());
  moments_ = {};
  shrinking_ = ended_ = 0.0;
}

// Atoms may have moved in memory, and the forces that follow no longer know the broken bonds.
void FixEnergyBpm::setup_pre_force(int vflag) {
  last_forces_.clear();
  last_moment_ = 0.0;
  pre_force(vflag);
}

void FixEnergyBpm::setup(int) { collect_walls(); }

// Velocities are those that have just moved the atoms; the forces are still the step's first.
void FixEnergyBpm::post_integrate() {
  shrinking_ -= ended_;
  add_half_step();
  add_half_elongation(&calendem::ElongationStep::work_before);
  for (const LastForce &last : last_forces_)
    sums_[kBreaks] -= work_in_half_step(last.action, last.atom);
  last_forces_.clear();
  if (cell_)
    sums_[kBreaks] += cell_->step().work_before(last_moment_);
  last_moment_ = 0.0;
}

void FixEnergyBpm::post_force(int) {
  collect_walls();
  add_half_step();
  add_half_elongation(&calendem::ElongationStep::work_after);
}

// Pairs dissipate at their whole relative velocity.
void FixEnergyBpm::add_half_elongation(double (calendem::ElongationStep::*work)(double) const) {
  if (!cell_)
    return;
  sums_[kDamped] += (cell_->step().*work)(moments_.damped);
  sums_[kFriction] += (cell_->step().*work)(moments_.friction);
}

double FixEnergyBpm::work_in_half_step(const ForceAndTorque &a, int i) const {
  return 0.5 * update->dt *
         (dot(a.force, calendem::load(atom->v[i])) + dot(a.torque, calendem::load(atom->omega[i])));
}

// A wall moves along its damping force, and along its friction where a roll slips.
void FixEnergyBpm::add_half_step() {
  double damped = 0.0, friction = 0.0;
  for (int i = 0; i < atom->nlocal; ++i) {
    damped -= work_in_half_step(loads_[i].damping, i);
    friction -= work_in_half_step(loads_[i].friction, i);
  }
  for (const Wall &wall : walls_) {
    damped += 0.5 * update->dt * wall.damping * wall.fix->velocity();
    friction += 0.5 * update->dt * wall.friction * wall.fix->sliding();
  }
  sums_[kShrinking] += 0.5 * shrinking_ * bonds_->bridges().shrinking();
  sums_[kDamped] += damped;
  sums_[kFriction] += friction;
}

void FixEnergyBpm::collect_walls() {
  for (Wall &wall : walls_) {
    wall.damping = wall.friction = 0.0;
    double **force = wall.fix->fix_wallforce()->array_atom;
    for (int i = 0; i < atom->nlocal; ++i)
      if (force[i][2] != 0.0)
        collect(wall, i, force[i]);
  }
}

// The force that a flat wall exerts on atom i: Hertz, cohesion and damping along z, friction
// across, with the arm of the host's default surface model.
void FixEnergyBpm::collect(Wall &wall, int i, const double *force) {
  const calendem::WallContact at = wall.fix->contact(i);
  const EffectContact contact = EffectContact::at_wall(atom->type[i], wall.fix->atom_type_wall(),
                                                       atom->radius[i], at.overlap);
  const double held =
      effects_.force(contact, wall.fix->effect_memory(i)) -
      calendem::sjkr_wall_force(wall_cohesion(wall, i), at.distance, atom->radius[i]);
  const double damping = force[2] - at.side * held;
  wall.damping += damping;
  add_damping(i, {{0.0, 0.0, damping}, {}});
  const Vec3 friction = {force[0], force[1], 0.0};
  wall.friction += friction.x;
  add_friction(i, {friction, cross(at.arm, friction)});
}

double FixEnergyBpm::cohesion(int i, int j, double r) const {
  return calendem::sjkr_potential(cohesion_energy_density_[atom->type[i]][atom->type[j]], r,
                                  atom->radius[i], atom->radius[j]);
}

void FixEnergyBpm::bond_breaks(int i, int j, const BondHistory &bond) {
  const double *radius = atom->radius;
  const calendem::BondPair pair = bonds_->pair_of(i, j, bond);
  const calendem::BondAction a = pair.action(bond.loads());
  const double beyond = bond.contact(pair.motion.r, radius[i] + radius[j]).distance;
  const bool begins = bond.state() != kBridge; // beside a bridge it acts all the time
  const double pull =
      begins ? calendem::sjkr_force(cohesion_energy_density_[atom->type[i]][atom->type[j]], beyond,
                                    radius[i], radius[j])
             : 0.0;
  const Vec3 force = a.force + pull * pair.motion.n; // the bond's, which ends, less the cohesion's
  last_forces_.push_back({i, {force, a.torque_i}});
  if (j < atom->nlocal)
    last_forces_.push_back({j, {-force, a.torque_j}});
  last_moment_ += (j < atom->nlocal ? 1.0 : 0.5) * force.x * pair.motion.d.x;
  if (!bonds_->pairs().decides(i, j))
    return;
  if (begins)
    sums_[kBreaks] -= cohesion(i, j, beyond);
  else
    shrinking_ends(pair.tension * bond.length());
}

double FixEnergyBpm::pair_energy(bool of_cohesion) const {
  double sum = 0.0;
  bonds_->pairs().for_each_touching([&](int i, int j, double r, const BondHistory &bond) {
    const double *radius = atom->radius;
    const calendem::ActingContact acting = bond.contact(r, radius[i] + radius[j]);
    if (!of_cohesion)
      sum +=
          effects_.elastic_energy(EffectContact::of_spheres(atom->type[i], atom->type[j], radius[i],
                                                            radius[j], acting.overlap),
                                  pairs_have_effects_ ? bond.effect_memory() : NULL);
    else if (acting.coheres)
      sum += cohesion(i, j, acting.distance);
  });
  return sum;
}

// Cohesion energy density of atom i at the wall, 0 if it does not stick.
double FixEnergyBpm::wall_cohesion(const Wall &wall, int i) const {
  return wall.sticks ? cohesion_energy_density_[atom->type[i]][wall.fix->atom_type_wall()] : 0.0;
}

double FixEnergyBpm::wall_energy(bool of_cohesion) const {
  double sum = 0.0;
  for (const Wall &wall : walls_)
    for (int i = 0; i < atom->nlocal; ++i) {
      const double radius = atom->radius[i];
      const calendem::WallContact at = wall.fix->contact(i);
      sum += of_cohesion
                 ? calendem::sjkr_wall_potential(wall_cohesion(wall, i), at.distance, radius)
                 : effects_.elastic_energy(EffectContact::at_wall(atom->type[i],
                                                                  wall.fix->atom_type_wall(),
                                                                  radius, at.overlap),
                                           wall.fix->effect_memory(i));
    }
  return sum;
}

double FixEnergyBpm::stored_in_contacts() const {
  return pair_energy(false) + pair_energy(true) + wall_energy(false) + wall_energy(true);
}

double FixEnergyBpm::compute_vector(int n) {
  double mine = n >= 2 ? sums_[n - 2] : pair_energy(n == 1) + wall_energy(n == 1), all = 0.0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

// The first rank goes on from the total, as after a restart: both give the same bits.
void FixEnergyBpm::write_restart(FILE *fp) {
  double total[kSums];
  MPI_Allreduce(sums_, total, kSums, MPI_DOUBLE, MPI_SUM, world);
  for (int k = 0; k < kSums; ++k)
    sums_[k] = comm->me == 0 ? total[k] : 0.0;
  if (comm->me != 0)
    return;
  const int bytes = sizeof total;
  fwrite(&bytes, sizeof(int), 1, fp);
  fwrite(total, sizeof(double), kSums, fp);
}

void FixEnergyBpm::restart(char *buf) {
  const double *total = reinterpret_cast<const double *>(buf);
  for (int k = 0; k < kSums; ++k)
    sums_[k] = comm->me == 0 ? total[k] : 0.0;
}

double FixEnergyBpm::memory_usage() { return loads_.capacity() * sizeof(AtomLoads); }
