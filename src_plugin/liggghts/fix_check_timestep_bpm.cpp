// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_check_timestep_bpm.h"
#include "comm.h"
#include "contact_effects.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_property_global.h"
#include "force.h"
#include "modify.h"
#include "physics/hertz_contact.h"
#include "physics/time_step_bound.h"
#include "update.h"
#include <algorithm>
#include <cstdlib>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {
const char *const kUsage =
    "expects 'check/timestep/bpm N FRACTION [error yes|no] [pressure P]', P > 0";
}

FixCheckTimestepBpm::FixCheckTimestepBpm(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), fraction_(0.0), bound_(0.0), rayleigh_(0.0), pressure_(0.0),
      warned_(HUGE_VAL), stop_(false) {
  if (narg < 5 || narg > 9)
    error->fix_error(FLERR, this, kUsage);
  nevery = atoi(arg[3]);
  fraction_ = atof(arg[4]);
  if (nevery < 1 || !(fraction_ > 0.0) || fraction_ > 1.0)
    error->fix_error(FLERR, this, "N must be >= 1 and FRACTION in (0, 1]");
  for (int i = 5; i < narg; i += 2) {
    const std::string key = arg[i], value = i + 1 < narg ? arg[i + 1] : "";
    pressure_ = key == "pressure" ? atof(value.c_str()) : pressure_;
    stop_ = key == "error" ? value == "yes" : stop_;
    if (!(key == "error" && (value == "yes" || value == "no")) &&
        !(key == "pressure" && pressure_ > 0.0))
      error->fix_error(FLERR, this, kUsage);
  }
  vector_flag = 1;
  size_vector = 4;
  global_freq = 1;
}

int FixCheckTimestepBpm::setmask() { return END_OF_STEP; }

void FixCheckTimestepBpm::init() {
  if (ContactEffects::in_use(lmp))
    effects_.connect(force->registry, "fix check/timestep/bpm");
}

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
  if (ContactEffects::in_use(lmp))
    add_contacts(stiffness, damping);
  if (ContactEffects::in_use(lmp) && pressure_ > 0.0)
    least = contact_bound();
  for (int i = 0; i < nlocal; ++i)
    least = std::min(least, calendem::stable_step(stiffness[i], damping[i], m[i], R[i]));
  return least;
}

void FixCheckTimestepBpm::add_contacts(std::vector<calendem::BondRowSum> &stiffness,
                                       std::vector<calendem::BondRowSum> &damping) const {
  const int nlocal = atom->nlocal;
  const double *R = atom->radius, *m = atom->rmass;
  FixBondBpm *bonds = FixBondBpm::find(lmp, "fix check/timestep/bpm");
  bonds->for_each_touching_copy([&](int i, int j, double r, const BondHistory &bond) {
    const int ti = atom->type[i], tj = atom->type[j];
    if (!bond.effect_memory() || !effects_.act(ti, tj))
      return;
    const double a = effects_.stiffness_radius(
        EffectContact::of_spheres(ti, tj, R[i], R[j], R[i] + R[j] - r), bond.effect_memory());
    const calendem::BondCoefficients k =
        calendem::contact_stiffness(effects_.modulus(ti, tj), effects_.shear_modulus(ti, tj), a);
    const calendem::BondCoefficients c =
        calendem::contact_damping(k, effects_.damping(ti, tj), m[i] * m[j] / (m[i] + m[j]));
    const calendem::Vec3 n = (1.0 / r) * (calendem::load(atom->x[i]) - calendem::load(atom->x[j]));
    for (int b : {i, j})
      if (b < nlocal) {
        stiffness[b].add(k, n, 2.0 * R[b]);
        damping[b].add(c, n, 2.0 * R[b]);
      }
  });
}

// A free sphere with the contacts that `pressure` will make.
double FixCheckTimestepBpm::contact_bound() const {
  double least = HUGE_VAL;
  for (int i = 0; i < atom->nlocal; ++i) {
    const int t = atom->type[i];
    if (!effects_.act(t, t) || !effects_.law(t, t).stiffens)
      continue;
    const double R = atom->radius[i], m = atom->rmass[i];
    const double a = effects_.radius_under(calendem::mean_contact_force(pressure_, R),
                                           EffectContact::of_spheres(t, t, R, R, 0.0));
    const calendem::BondCoefficients k =
        calendem::contact_stiffness(effects_.modulus(t, t), effects_.shear_modulus(t, t), a);
    const calendem::BondCoefficients c =
        calendem::contact_damping(k, effects_.damping(t, t), 0.5 * m);
    least = std::min(least, calendem::stable_step_of_contacts(k, c, m, R));
  }
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
  snprintf(
      message, sizeof message,
      "time step %g us exceeds %g of the smaller of the bonds' bound (%g us, contacts of effects "
      "included) and the Rayleigh time (%g us); use at most %g us",
      update->dt, fraction_, bound_, rayleigh_, limit);
  if (stop_)
    error->fix_error(FLERR, this, message);
  if (comm->me == 0 && limit < 0.9 * warned_)
    error->warning(FLERR, message);
  warned_ = limit < 0.9 * warned_ ? limit : warned_;
}

double FixCheckTimestepBpm::compute_vector(int n) {
  const double values[] = {bound_, update->dt / bound_, rayleigh_, update->dt / rayleigh_};
  return values[n];
}
