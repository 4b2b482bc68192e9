// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact_effects.h"
#include "error.h"
#include "fix_property_global.h"
#include "force.h"
#include "global_properties.h"
#include "modify.h"
#include "pair_gran.h"
#include "property_registry.h"
#include <cmath>

using namespace LAMMPS_NS;

namespace {

// By pairs of atom types, 0 everywhere if the script does not set the property.
MatrixProperty *optional(PropertyRegistry &registry, const char *name) {
  const int n = registry.max_type();
  MatrixProperty *matrix = new MatrixProperty(n + 1, n + 1);
  FixPropertyGlobal *given =
      static_cast<FixPropertyGlobal *>(registry.getLAMMPS()->modify->find_fix_property(
          name, "property/global", "peratomtypepair", n, n, "model hertz_effects", false));
  for (int i = 1; i <= n; ++i)
    for (int j = 1; j <= n; ++j)
      matrix->data[i][j] = given ? given->compute_array(i - 1, j - 1) : 0.0;
  return matrix;
}

MatrixProperty *yield_pressure(PropertyRegistry &registry, const char *, bool) {
  return optional(registry, "contactYieldPressure");
}

MatrixProperty *relaxed_fraction(PropertyRegistry &registry, const char *, bool) {
  return optional(registry, "contactRelaxedFraction");
}

MatrixProperty *relaxation_time(PropertyRegistry &registry, const char *, bool) {
  return optional(registry, "contactRelaxationTime");
}

void refuse(LAMMPS *lmp, const char *name, int i, int j, double value, const char *why) {
  char message[400];
  snprintf(message, sizeof message,
           "model hertz_effects: %s of atom types %d and %d is %g in the script's units; %s", name,
           i, j, value, why);
  lmp->error->all(FLERR, message);
}

} // namespace

bool ContactEffects::in_use(LAMMPS *lmp) {
  PairGran *pair = static_cast<PairGran *>(lmp->force->pair_match("gran", 1));
  return pair && pair->contact_match("normal", kModel);
}

void ContactEffects::connect(PropertyRegistry &registry, const char *caller) {
  registry.registerProperty("contactYieldPressure", &yield_pressure);
  registry.connect("contactYieldPressure", yield_pressure_, caller);
  registry.registerProperty("contactRelaxedFraction", &relaxed_fraction);
  registry.connect("contactRelaxedFraction", relaxed_fraction_, caller);
  registry.registerProperty("contactRelaxationTime", &relaxation_time);
  registry.connect("contactRelaxationTime", relaxation_time_, caller);
  registry.registerProperty("Yeff", &MODEL_PARAMS::createYeff);
  registry.connect("Yeff", modulus_, caller);
  registry.registerProperty("Geff", &MODEL_PARAMS::createGeff);
  registry.connect("Geff", shear_modulus_, caller);
  registry.registerProperty("betaeff", &MODEL_PARAMS::createBetaEff);
  registry.connect("betaeff", damping_, caller);
  check(registry);
}

double ContactEffects::force(const EffectContact &c, const double *memory) const {
  if (memory && yields(c.itype, c.jtype))
    return plastic(c).force(c.overlap, *memory);
  if (memory && relaxes(c.itype, c.jtype))
    return viscous(c).force(c.overlap, *memory);
  return calendem::hertz_force(modulus_[c.itype][c.jtype], c.effective_radius, c.overlap);
}

double ContactEffects::elastic_energy(const EffectContact &c, const double *memory) const {
  if (memory && yields(c.itype, c.jtype))
    return plastic(c).elastic_energy(c.overlap, *memory);
  if (memory && relaxes(c.itype, c.jtype))
    return viscous(c).elastic_energy(c.overlap, *memory);
  return calendem::hertz_energy(modulus_[c.itype][c.jtype], c.effective_radius, c.overlap);
}

double ContactEffects::contact_radius(const EffectContact &c, double memory) const {
  return yields(c.itype, c.jtype) ? plastic(c).contact_radius(c.overlap, memory)
                                  : viscous(c).contact_radius(c.overlap, memory);
}

double ContactEffects::largest_radius(const EffectContact &c, double memory) const {
  const bool remembers = yields(c.itype, c.jtype) && memory > c.overlap;
  return std::sqrt(c.effective_radius * (remembers ? memory : c.overlap));
}

double ContactEffects::radius_under(double force, int itype, int jtype,
                                    double effective_radius) const {
  const double overlap =
      yields(itype, jtype)
          ? plastic({itype, jtype, effective_radius, 0.0}).overlap_under(force)
          : calendem::hertz_overlap(modulus_[itype][jtype], effective_radius, force);
  return std::sqrt(effective_radius * overlap);
}

double ContactEffects::advance(const EffectContact &c, double before, double time,
                               double &memory) const {
  if (relaxes(c.itype, c.jtype))
    return viscous(c).advance(before, c.overlap, time, memory);
  if (c.overlap <= memory)
    return 0.0;
  const double taken = plastic(c).plastic_work(c.overlap) - plastic(c).plastic_work(memory);
  memory = c.overlap;
  return taken;
}

void ContactEffects::check(PropertyRegistry &registry) const {
  LAMMPS *lmp = registry.getLAMMPS();
  const int n = registry.max_type();
  FixPropertyGlobal *cohesion = static_cast<FixPropertyGlobal *>(lmp->modify->find_fix_property(
      "cohesionEnergyDensity", "property/global", "peratomtypepair", n, n, "", false));
  for (int i = 1; i <= n; ++i)
    for (int j = i; j <= n; ++j) {
      check_yield(lmp, i, j, cohesion ? cohesion->compute_array(i - 1, j - 1) : 0.0);
      check_relaxation(lmp, i, j, cohesion ? cohesion->compute_array(i - 1, j - 1) : 0.0);
      if (yields(i, j) && relaxes(i, j))
        refuse(lmp, "contactRelaxedFraction", i, j, relaxed_fraction_[i][j],
               "a contact is plastic or viscous, not both: set it or contactYieldPressure to 0");
    }
}

void ContactEffects::check_yield(LAMMPS *lmp, int i, int j, double cohesion) const {
  const double limit = yield_pressure_[i][j], least = 2.5 * cohesion;
  if (!std::isfinite(limit) || limit < 0.0)
    refuse(lmp, "contactYieldPressure", i, j, limit, "it must be a finite number >= 0 (0: off)");
  char why[250];
  snprintf(why, sizeof why,
           "a contact that yields below 2 cohesionEnergyDensity cannot carry its own cohesion and "
           "the packing collapses: give at least 2.5 times it, %g, or 0",
           least);
  if (limit > 0.0 && limit < least)
    refuse(lmp, "contactYieldPressure", i, j, limit, why);
}

void ContactEffects::check_relaxation(LAMMPS *lmp, int i, int j, double cohesion) const {
  const double fraction = relaxed_fraction_[i][j], time = relaxation_time_[i][j];
  if (!(fraction >= 0.0 && fraction < 1.0))
    refuse(lmp, "contactRelaxedFraction", i, j, fraction, "it must be >= 0 (0: off) and < 1");
  if (fraction > 0.0 && !(time > 0.0 && std::isfinite(time)))
    refuse(lmp, "contactRelaxationTime", i, j, time,
           "it must be a finite number > 0 where contactRelaxedFraction is set");
  const double overlap =
      calendem::sjkr_equilibrium_overlap(cohesion, (1.0 - fraction) * modulus_[i][j], 0.5);
  char why[250];
  snprintf(why, sizeof why,
           "relaxed, cohesion pulls equal spheres into each other by %.3g of their radius and at "
           "most 0.3 is allowed, or the packing collapses. Lower it or cohesionEnergyDensity",
           overlap);
  if (fraction > 0.0 && overlap > 0.3)
    refuse(lmp, "contactRelaxedFraction", i, j, fraction, why);
}
