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
  registry.registerProperty("Yeff", &MODEL_PARAMS::createYeff);
  registry.connect("Yeff", modulus_, caller);
  registry.registerProperty("Geff", &MODEL_PARAMS::createGeff);
  registry.connect("Geff", shear_modulus_, caller);
  registry.registerProperty("betaeff", &MODEL_PARAMS::createBetaEff);
  registry.connect("betaeff", damping_, caller);
  check(registry);
}

double ContactEffects::force(const EffectContact &c, const double *memory) const {
  return memory && act(c.itype, c.jtype)
             ? plastic(c).force(c.overlap, *memory)
             : calendem::hertz_force(modulus_[c.itype][c.jtype], c.effective_radius, c.overlap);
}

double ContactEffects::elastic_energy(const EffectContact &c, const double *memory) const {
  return memory && act(c.itype, c.jtype)
             ? plastic(c).elastic_energy(c.overlap, *memory)
             : calendem::hertz_energy(modulus_[c.itype][c.jtype], c.effective_radius, c.overlap);
}

void ContactEffects::check(PropertyRegistry &registry) const {
  LAMMPS *lmp = registry.getLAMMPS();
  const int n = registry.max_type();
  FixPropertyGlobal *cohesion = static_cast<FixPropertyGlobal *>(lmp->modify->find_fix_property(
      "cohesionEnergyDensity", "property/global", "peratomtypepair", n, n, "", false));
  for (int i = 1; i <= n; ++i)
    for (int j = i; j <= n; ++j) {
      const double limit = yield_pressure_[i][j];
      if (!std::isfinite(limit) || limit < 0.0)
        refuse(lmp, "contactYieldPressure", i, j, limit,
               "it must be a finite number >= 0 (0: off)");
      const double least = cohesion ? 2.5 * cohesion->compute_array(i - 1, j - 1) : 0.0;
      if (limit > 0.0 && limit < least) {
        char why[250];
        snprintf(why, sizeof why,
                 "a contact that yields below 2 cohesionEnergyDensity cannot carry its own "
                 "cohesion and the packing collapses: give at least 2.5 times it, %g, or 0",
                 least);
        refuse(lmp, "contactYieldPressure", i, j, limit, why);
      }
    }
}
