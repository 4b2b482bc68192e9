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
#include "wall_bridges.h"
#include "words.h"
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
      warned_(HUGE_VAL), pairs_have_effects_(false), stop_(false) {
  if (narg < 5 || narg > 9)
    error->fix_error(FLERR, this, kUsage);
  const NumberReader number(error, this);
  nevery = static_cast<int>(number("N", arg[3], whole_between(1, 1e9)));
  fraction_ = number("FRACTION", arg[4], above_and_at_most(0.0, 1.0));
  for (int i = 5; i < narg; i += 2) {
    const std::string key = arg[i], value = i + 1 < narg ? arg[i + 1] : "";
    if (key == "pressure")
      pressure_ = number(key, value, kPositive);
    else if (key == "error" && (value == "yes" || value == "no"))
      stop_ = value == "yes";
    else
      error->fix_error(FLERR, this, kUsage);
  }
  vector_flag = 1;
  size_vector = 4;
  global_freq = 1;
}

int FixCheckTimestepBpm::setmask() { return END_OF_STEP; }

void FixCheckTimestepBpm::init() {
  effects_.connect(force->registry, "fix check/timestep/bpm");
  pairs_have_effects_ = ContactEffects::in_use(lmp);
}

void FixCheckTimestepBpm::setup(int) { end_of_step(); }

double FixCheckTimestepBpm::bond_bound() const {
  FixBondBpm *bonds = FixBondBpm::find(lmp, "fix check/timestep/bpm");
  const int nlocal = atom->nlocal;
  Spheres bonded(nlocal), bridges(nlocal);
  const double *m = atom->rmass, *R = atom->radius;
  bonds->pairs().for_each_acting_copy([&](int i, int j, const BondHistory &bond) {
    const calendem::BondPair pair = bonds->pair_of(i, j, bond);
    const calendem::BondDamping c = pair.damping(bonds->settings_of(bond).material, R[i], R[j],
                                                 calendem::effective_mass(m[i], m[j]));
    const calendem::Vec3 n = pair.motion.n;
    Spheres &of = bond.state() == kBridge ? bridges : bonded;
    of[i].add(pair.stiffness, c, n, pair.motion.r);
    if (j < nlocal)
      of[j].add(pair.stiffness, c, -n, pair.motion.r);
  });
  if (const auto *wall = dynamic_cast<const WallBridges *>(bonds->bridges().on_collector()))
    for (int i = 0; i < nlocal; ++i)
      wall->add_to_blocks(&bridges[i].stiffness, &bridges[i].damping, i);
  double least = pressure_ > 0.0 ? contact_bound(bonded, bridges) : HUGE_VAL;
  for (int i = 0; i < nlocal; ++i)
    bonded[i].add(bridges[i]);
  add_contacts(bonded);
  for (int i = 0; i < nlocal; ++i)
    least = calendem::stable_step(bonded[i].stiffness, bonded[i].damping, m[i], R[i], least);
  return least;
}

// The contacts that there are. That of a bonded pair begins beyond its reference.
void FixCheckTimestepBpm::add_contacts(Spheres &spheres) const {
  const int nlocal = atom->nlocal;
  const double *R = atom->radius, *m = atom->rmass;
  FixBondBpm *bonds = FixBondBpm::find(lmp, "fix check/timestep/bpm");
  bonds->pairs().for_each_touching_copy([&](int i, int j, double r, const BondHistory &bond) {
    const double overlap = bond.contact(r, R[i] + R[j]).overlap;
    if (overlap <= 0.0)
      return;
    const int ti = atom->type[i], tj = atom->type[j];
    const double a =
        effects_.stiffness_radius(EffectContact::of_spheres(ti, tj, R[i], R[j], overlap),
                                  pairs_have_effects_ ? bond.effect_memory() : NULL);
    const calendem::BondCoefficients k = stiffness_of(ti, tj, a);
    const calendem::BondCoefficients c = calendem::contact_damping(
        k, effects_.damping(ti, tj), calendem::effective_mass(m[i], m[j]));
    const calendem::Vec3 n = (1.0 / r) * (calendem::load(atom->x[i]) - calendem::load(atom->x[j]));
    spheres[i].add(k, c, n, 2.0 * R[i]);
    if (j < nlocal)
      spheres[j].add(k, c, -n, 2.0 * R[j]);
  });
}

calendem::BondCoefficients FixCheckTimestepBpm::stiffness_of(int ti, int tj, double a) const {
  return calendem::contact_stiffness(effects_.modulus(ti, tj), effects_.shear_modulus(ti, tj), a);
}

// The bound of sphere i with the contacts that `pressure` will make with spheres or a wall of type
// `other`.
double FixCheckTimestepBpm::contact_bound(int i, int other, const Sphere &bonds,
                                          const Sphere &bridges) const {
  const calendem::BondMaterial &material =
      FixBondBpm::find(lmp, "fix check/timestep/bpm")->settings().material;
  const int type = atom->type[i];
  const double R = atom->radius[i], m = atom->rmass[i];
  const double force = calendem::mean_contact_force(pressure_, R);
  const calendem::BondCoefficients k = stiffness_of(
      type, other, effects_.radius_under(force, EffectContact::of_spheres(type, other, R, R, 0.0)));
  const calendem::BondCoefficients c =
      calendem::contact_damping(k, effects_.damping(type, other), 0.5 * m);
  const calendem::BondPair touching(material, R, R, 2.0 * R,
                                    calendem::pair_at_rest({2.0 * R, 0.0, 0.0}));
  const bool bonds_are_softer = touching.stiffness.normal < k.normal;
  Sphere beside = bonds_are_softer ? bonds : Sphere();
  beside.add(bridges);
  return calendem::stable_step_of_contacts(k, c, m, R, beside.stiffness, beside.damping);
}

double FixCheckTimestepBpm::contact_bound(const Spheres &bonds, const Spheres &bridges) const {
  double least = HUGE_VAL;
  for (int i = 0; i < atom->nlocal; ++i)
    for (int other = 1; other <= effects_.types(); ++other)
      least = std::min(least, contact_bound(i, other, bonds[i], bridges[i]));
  return least;
}

double FixCheckTimestepBpm::rayleigh_time() const {
  const int types = effects_.types();
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
           "time step %g us exceeds %g of the smaller of the bonds' bound (%g us, contacts "
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
