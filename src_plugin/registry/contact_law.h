// SPDX-License-Identifier: GPL-2.0-or-later
// The contact laws that can take Hertz' place between two phases: one row each. A law reads its
// properties from the script, by pairs of atom types (`fix property/global NAME peratomtypepair`,
// units micro). It acts where its first property is > 0; a property that is not set is 0. A pair of
// types may have one law.
// To add one: its header in src_plugin/physics with the members of law_interface.h; a row below; the
// row and the class in kContactLaws and ContactLaws, in the same place; its effect in
// effects_of_contacts.h; then `calendem registry .`. An example: docs/tutorials/new_law.md.
#ifndef CALENDEM_REGISTRY_CONTACT_LAW_H
#define CALENDEM_REGISTRY_CONTACT_LAW_H

#include "physics/confined_contact.h"
#include "physics/plastic_contact.h"
#include "physics/viscous_contact.h"
#include <array>
#include <tuple>

namespace calendem {

/// Where the law acts a value is > 0 and < `below`.
struct ContactProperty {
  const char *name; ///< of the script's property; NULL: the law has no more of them
  const char *unit; ///< the script's
  double below = std::numeric_limits<double>::infinity();
  bool may_be_zero = false;                                    ///< where the law acts
  double of_modulus = std::numeric_limits<double>::infinity(); ///< at most, of the effective one
};

struct ContactLaw {
  const char *name;
  const char *header; ///< in src_plugin/physics
  std::array<ContactProperty, 4> properties;
  /// Contacts get stiffer than Hertz' under the same force: the time step is checked as they do.
  bool stiffens;
  /// Of the first property, all of them given.
  ContactLimits (*limits)(const PhasePair &phases, const double *values);
  WorkTaken takes = WorkTaken::Nothing;
  /// Largest overlap with a wall, of the radius: deeper, the host may lose a sphere through it.
  double deepest = std::numeric_limits<double>::infinity();
};

inline constexpr ContactLaw kPlasticContact = {
    "elastic-plastic",
    "plastic_contact.h",
    {{{"contactYieldPressure", "kPa"},
      {"contactHardening", "kPa", HUGE_VAL, true, PlasticContact::kMostHardening},
      {"contactBeyondCohesion", "", HUGE_VAL, true},
      {"contactFlattening", "", HUGE_VAL, true}}},
    true,
    &plastic_contact_limits,
    WorkTaken::PlasticFlow,
    0.9};

inline constexpr ContactLaw kViscousContact = {
    "viscoelastic",
    "viscous_contact.h",
    {{{"contactRelaxedFraction", "", 1.0}, {"contactRelaxationTime", "us"}}},
    false,
    &viscous_contact_limits,
    WorkTaken::Dashpots};

inline constexpr ContactLaw kConfinedContact = {
    "confined",
    "confined_contact.h",
    {{{"contactBulkModulus", "kPa"}, {"contactFreeSurface", "", 1.0}}},
    true,
    &confined_contact_limits};

inline constexpr std::array<const ContactLaw *, 3> kContactLaws = {
    &kPlasticContact, &kViscousContact, &kConfinedContact};
/// Their classes (physics/law_interface.h), in the same order.
using ContactLaws = std::tuple<PlasticContact, ViscousContact, ConfinedContact>;
static_assert(std::tuple_size_v<ContactLaws> == kContactLaws.size(), "a law has a row and a class");

/// Most history values that one of these laws has.
template <class... Law> constexpr int most_memory(const std::tuple<Law...> *) {
  int most = 0;
  for (const int n : {Law::kMemory...})
    most = n > most ? n : most;
  return most;
}

} // namespace calendem

#endif
