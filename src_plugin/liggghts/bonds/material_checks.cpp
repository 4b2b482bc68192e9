// SPDX-License-Identifier: GPL-2.0-or-later
#include "material_checks.h"
#include "error.h"
#include "fix_property_global.h"
#include "modify.h"
#include "physics/hertz_contact.h"
#include "physics/sjkr_cohesion.h"
#include "update.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace LAMMPS_NS;

// Ten times diamond in units micro, where 1 is 1 kPa: such a value is in Pa.
void MaterialChecks::check_modulus(const char *what, double value) const {
  const double most = 1e10;
  char message[256];
  snprintf(message, sizeof message,
           "%s is %g kPa = %g GPa; at most %g GPa is allowed. Is it given in Pa? The input scripts "
           "take GPa",
           what, value, 1e-6 * value, 1e-6 * most);
  if (!strcmp(update->unit_style, "micro") && value > most)
    error->fix_error(FLERR, owner_, message);
}

void MaterialChecks::refuse(const char *what, double value, int i, int j, const char *why) const {
  char message[400];
  snprintf(message, sizeof message, "%s of atom types %d and %d is %g in the script's units; %s",
           what, i, j, value, why);
  error->fix_error(FLERR, owner_, message);
  std::abort(); // fix_error does not return
}

// A global property by types or by pairs of them, for as many as the script gives, which may be
// fewer than the box has; NULL if it gives none.
FixPropertyGlobal *MaterialChecks::property(const char *name, const char *kind) const {
  return static_cast<FixPropertyGlobal *>(
      modify->find_fix_property(name, "property/global", kind, 0, 0, owner_->style, false));
}

void MaterialChecks::check_not_negative(const char *name) const {
  FixPropertyGlobal *of_pairs = property(name, "peratomtypepair");
  for (int i = 0; of_pairs && i < of_pairs->size_array_rows; ++i)
    for (int j = i; j < of_pairs->size_array_cols; ++j)
      if (const double value = of_pairs->compute_array(i, j); !(value >= 0.0))
        refuse(name, value, i + 1, j + 1, "it must be >= 0");
}

void MaterialChecks::check_properties() const {
  FixPropertyGlobal *modulus = property("youngsModulus", "peratomtype");
  FixPropertyGlobal *poisson = property("poissonsRatio", "peratomtype");
  FixPropertyGlobal *ced = property("cohesionEnergyDensity", "peratomtypepair");
  char what[64];
  for (int i = 0; modulus && i < modulus->size_vector; ++i) {
    snprintf(what, sizeof what, "youngsModulus of atom type %d", i + 1);
    check_modulus(what, modulus->compute_vector(i));
  }
  check_not_negative("coefficientFriction");
  check_not_negative("cohesionEnergyDensity");
  if (!modulus || !poisson || !ced)
    return;
  const double *E = modulus->get_values(), *nu = poisson->get_values();
  const int n = std::min({modulus->size_vector, poisson->size_vector, ced->size_array_rows});
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
      check_collapse(i + 1, j + 1, ced->compute_array(i, j),
                     calendem::effective_modulus(E[i], nu[i], E[j], nu[j]));
}

// Two spheres that nothing but SJKR and Hertz act on; the overlap scales as (CED/E)^2.
void MaterialChecks::check_collapse(int i, int j, double ced, double effective_modulus) const {
  const double most = 0.3; // the paper's own values give up to 0.07
  const double overlap = calendem::sjkr_equilibrium_overlap(ced, effective_modulus, 0.5);
  char message[256];
  snprintf(message, sizeof message,
           "it pulls equal spheres into each other by %.3g of their radius and at most %g is "
           "allowed, or the packing collapses. Lower it or raise youngsModulus: the overlap scales "
           "as (CED/E)^2",
           overlap, most);
  if (overlap > most)
    refuse("cohesionEnergyDensity", ced, i, j, message);
}
