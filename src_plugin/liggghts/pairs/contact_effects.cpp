// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact_effects.h"
#include "atom.h"
#include "error.h"
#include "fix_property_atom.h"
#include "fix_property_global.h"
#include "force.h"
#include "global_properties.h"
#include "known_types.h"
#include "modify.h"
#include "pair_gran.h"
#include "physics/kept_volume.h"
#include "property_registry.h"
#include <cmath>

using namespace LAMMPS_NS;
using calendem::ContactLaw;
using calendem::kContactLaws;

namespace {

// 0 if the script does not set the property.
double optional(LAMMPS *lmp, const char *name, int types, int i, int j) {
  auto *given = static_cast<FixPropertyGlobal *>(lmp->modify->find_fix_property(
      name, "property/global", "peratomtypepair", types, types, "model hertz_effects", false));
  return given ? given->compute_array(i - 1, j - 1) : 0.0;
}

void refuse(LAMMPS *lmp, const calendem::ContactProperty &property, int i, int j, double value,
            const char *why) {
  char message[500];
  snprintf(message, sizeof message, "model hertz_effects: %s of atom types %d and %d is %g%s%s; %s",
           property.name, i, j, value, *property.unit ? " " : "", property.unit, why);
  lmp->error->all(FLERR, message);
}

// Where the property's law acts.
void check(LAMMPS *lmp, const calendem::ContactProperty &property, int i, int j, double value,
           double modulus) {
  char why[200], below[40] = "";
  if (std::isfinite(property.below))
    snprintf(below, sizeof below, " and < %g", property.below);
  snprintf(why, sizeof why, "where the law acts it must be a finite number %s 0%s",
           property.may_be_zero ? ">=" : ">", below);
  const bool enough = property.may_be_zero ? value >= 0.0 : value > 0.0;
  if (!enough || !(value < property.below) || !std::isfinite(value))
    refuse(lmp, property, i, j, value, why);
  snprintf(why, sizeof why, "give at most %g, %g of the effective modulus",
           property.most_of_modulus * modulus, property.most_of_modulus);
  if (value > property.most_of_modulus * modulus)
    refuse(lmp, property, i, j, value, why);
}

} // namespace

bool ContactEffects::in_use(LAMMPS *lmp) {
  PairGran *pair = static_cast<PairGran *>(lmp->force->pair_match("gran", 1));
  return pair && pair->contact_match("normal", kModel);
}

void ContactEffects::connect(PropertyRegistry &registry, const char *caller) {
  registry.registerProperty("Yeff", &MODEL_PARAMS::createYeff);
  registry.registerProperty("Geff", &MODEL_PARAMS::createGeff);
  registry.registerProperty("betaeff", &MODEL_PARAMS::createBetaEff);
  atom_ = registry.getLAMMPS()->atom;
  growth_ = static_cast<FixPropertyAtom *>(registry.getLAMMPS()->modify->find_fix_property(
      kGrowth, "property/atom", "vector", 2, 0, caller, false));
  KnownTypes known(registry.getLAMMPS());
  known.find();
  types_ = known.highest();
  pairs_.assign((types_ + 1) * (types_ + 1), TypePair());
  for (int i = 1; i <= types_; ++i)
    for (int j = 1; j <= types_; ++j)
      read(registry, i, j, caller);
}

calendem::GrownSurfaces ContactEffects::grown_surfaces(int i, int j) const {
  const double *R = atom_->radius, *of_i = growth_->array_atom[i], Ri = R[i] + of_i[0];
  if (j < 0)
    return {Ri, Ri, of_i[0], of_i[1] == kFull, 1.0};
  const double *of_j = growth_->array_atom[j], Rj = R[j] + of_j[0];
  const int soft = of_i[1] != kNever && of_j[1] != kNever ? 2 : 1;
  const double R_eff = calendem::effective_radius(R[i], R[j]);
  return {calendem::effective_radius(Ri, Rj), std::fmin(Ri, Rj), of_i[0] + of_j[0],
          of_i[1] == kFull || of_j[1] == kFull,
          calendem::flat_depth(1.0, R_eff, std::fmin(R[i], R[j]), soft)};
}

void ContactEffects::read(PropertyRegistry &registry, int i, int j, const char *caller) {
  LAMMPS *lmp = registry.getLAMMPS();
  TypePair &p = pairs_[i * (types_ + 1) + j];
  p.material.modulus = registry.getMatrixProperty("Yeff", caller)->data[i][j];
  p.material.shear_modulus = registry.getMatrixProperty("Geff", caller)->data[i][j];
  p.material.damping = registry.getMatrixProperty("betaeff", caller)->data[i][j];
  p.material.cohesion = optional(lmp, "cohesionEnergyDensity", types_, i, j);
  for (int n = 0; n < static_cast<int>(kContactLaws.size()); ++n)
    if (optional(lmp, kContactLaws[n]->properties[0].name, types_, i, j) != 0.0)
      choose(lmp, n, i, j);
}

void ContactEffects::choose(LAMMPS *lmp, int n, int i, int j) {
  TypePair &p = pairs_[i * (types_ + 1) + j];
  const ContactLaw &law = *kContactLaws[n];
  char why[400];
  calendem::PropertyValues values = {};
  for (size_t k = 0; k < law.size; ++k) {
    values[k] = optional(lmp, law.properties[k].name, types_, i, j);
    check(lmp, law.properties[k], i, j, values[k], p.material.modulus);
  }
  if (p.law >= 0) {
    snprintf(why, sizeof why, "a contact follows one law: set it or %s to 0",
             kContactLaws[p.law]->properties[0].name);
    refuse(lmp, law.properties[0], i, j, values[0], why);
  }
  p.law = n;
  calendem::AllLaws::set(p.params, n, values);
  const calendem::ContactLimits limits =
      law.limits({p.material.cohesion, p.material.modulus}, values);
  const bool low = values[0] < limits.least;
  snprintf(why, sizeof why, "%s. Give at %s %g, or 0 (off)", limits.why, low ? "least" : "most",
           low ? limits.least : limits.most);
  if (low || values[0] > limits.most)
    refuse(lmp, law.properties[0], i, j, values[0], why);
}
