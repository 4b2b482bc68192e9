// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_check_timestep_bpm.h"
#include "comm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_property_global.h"
#include "modify.h"
#include "physics/time_step_bound.h"
#include "update.h"
#include <algorithm>
#include <cstdlib>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

FixCheckTimestepBpm::FixCheckTimestepBpm(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), fraction_(0.0), bound_(0.0), rayleigh_(0.0), stop_(false) {
  const bool has_switch =
      narg == 7 && !strcmp(arg[5], "error") && (!strcmp(arg[6], "yes") || !strcmp(arg[6], "no"));
  if (narg != 5 && !has_switch)
    error->fix_error(FLERR, this, "expects 'check/timestep/bpm N FRACTION [error yes|no]'");
  nevery = atoi(arg[3]);
  fraction_ = atof(arg[4]);
  if (nevery < 1 || !(fraction_ > 0.0) || fraction_ > 1.0)
    error->fix_error(FLERR, this, "N must be >= 1 and FRACTION in (0, 1]");
  stop_ = narg == 7 && !strcmp(arg[6], "yes");
  vector_flag = 1;
  size_vector = 4;
  global_freq = 1;
}

int FixCheckTimestepBpm::setmask() { return END_OF_STEP; }

void FixCheckTimestepBpm::setup(int) { end_of_step(); }

double FixCheckTimestepBpm::bond_bound() const {
  FixBondBpm *bonds = FixBondBpm::find(lmp, "fix check/timestep/bpm");
  const calendem::BondMaterial &material = bonds->settings().material;
  const int nlocal = atom->nlocal;
  std::vector<calendem::BondRowSum> stiffness(nlocal), damping(nlocal);
  const double *m = atom->rmass, *R = atom->radius;
  bonds->for_each_copy([&](int i, int j, const BondHistory &bond) {
    const calendem::BondSection section(material.radius_ratio * std::min(R[i], R[j]));
    const calendem::BondStiffness k(material, section, bond.length());
    const calendem::BondDamping c(material, section, k, m[i] * m[j] / (m[i] + m[j]),
                                  std::min(R[i], R[j]));
    const calendem::Vec3 d = calendem::load(atom->x[i]) - calendem::load(atom->x[j]);
    const calendem::Vec3 n = (1.0 / norm(d)) * d;
    for (int a : {i, j})
      if (a < nlocal) {
        stiffness[a].add(k, n, bond.length());
        damping[a].add(c, n, bond.length());
      }
  });
  double least = HUGE_VAL;
  for (int i = 0; i < nlocal; ++i)
    least = std::min(least, calendem::stable_step(stiffness[i], damping[i], m[i], R[i]));
  return least;
}

double FixCheckTimestepBpm::rayleigh_time() const {
  const int types = atom->ntypes;
  FixPropertyGlobal *E = static_cast<FixPropertyGlobal *>(modify->find_fix_property(
      "youngsModulus", "property/global", "peratomtype", types, 0, style));
  FixPropertyGlobal *nu = static_cast<FixPropertyGlobal *>(modify->find_fix_property(
      "poissonsRatio", "property/global", "peratomtype", types, 0, style));
  double least = HUGE_VAL;
  for (int i = 0; i < atom->nlocal; ++i) {
    const int t = atom->type[i] - 1;
    least = std::min(least, calendem::rayleigh_time(atom->radius[i], atom->density[i],
                                                    E->get_values()[t], nu->get_values()[t]));
  }
  return least;
}

void FixCheckTimestepBpm::end_of_step() {
  double mine[2] = {bond_bound(), rayleigh_time()}, all[2];
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MIN, world);
  bound_ = all[0];
  rayleigh_ = all[1];
  const double limit = fraction_ * std::min(bound_, rayleigh_);
  if (update->dt <= limit)
    return;
  char message[256];
  snprintf(message, sizeof message,
           "time step %g us exceeds %g of the smaller of the bonds' bound (%g us) and the Rayleigh "
           "time (%g us); use at most %g us",
           update->dt, fraction_, bound_, rayleigh_, limit);
  if (stop_)
    error->fix_error(FLERR, this, message);
  if (comm->me == 0)
    error->warning(FLERR, message);
}

double FixCheckTimestepBpm::compute_vector(int n) {
  const double values[] = {bound_, update->dt / bound_, rayleigh_, update->dt / rayleigh_};
  return values[n];
}
