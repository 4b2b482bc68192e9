// SPDX-License-Identifier: GPL-2.0-or-later
// The contact laws that can take Hertz' place between two phases. A law's row is made from its
// class, which says what it reads from the script (physics/law_interface.h). A pair of atom types
// may have one law; it acts where its first property is > 0.
// To add one: its header in src_plugin/physics; its class in ContactLaws below, anywhere. All other
// steps: docs/developer/add_a_law.md.
#ifndef CALENDEM_LAWS_CONTACT_LAWS_H
#define CALENDEM_LAWS_CONTACT_LAWS_H

#include "physics/confined_contact.h"
#include "physics/ductile_contact.h"
#include "physics/plastic_contact.h"
#include "physics/viscous_contact.h"
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <tuple>
#include <type_traits>

namespace calendem {

using ContactLaws = std::tuple<PlasticContact, ViscousContact, ConfinedContact, DuctileContact>;

/// Properties that a law may have.
constexpr std::size_t kMostProperties = 4;
/// Values of a law's properties, in their order, as the script gives them.
using PropertyValues = std::array<double, kMostProperties>;

/// What is known of a law where its class is not.
struct ContactLaw {
  const char *name;
  const char *header; ///< in src_plugin/physics
  std::array<ContactProperty, kMostProperties> properties;
  std::size_t size; ///< of the properties
  bool stiffens;
  WorkTaken takes;
  double deepest;
  bool grows;
  double (*range)(const ContactSurfaces &surfaces);
  ContactLimits (*limits)(const PhasePair &phases, const PropertyValues &values);
};

template <class Law> typename Law::Params params_of(const PropertyValues &values) {
  typename Law::Params params;
  for (std::size_t k = 0; k < std::size(Law::kProperties); ++k)
    params.*Law::kProperties[k].parameter = values[k];
  return params;
}

template <class Law> constexpr std::array<ContactProperty, kMostProperties> properties_of() {
  static_assert(std::size(Law::kProperties) <= kMostProperties, "raise kMostProperties");
  std::array<ContactProperty, kMostProperties> all;
  for (std::size_t k = 0; k < std::size(Law::kProperties); ++k)
    all[k] = Law::kProperties[k].property;
  return all;
}

template <class Law>
inline constexpr ContactLaw kContactLaw = {
    Law::kName,
    Law::kHeader,
    properties_of<Law>(),
    std::size(Law::kProperties),
    Law::kStiffens,
    Law::kTakes,
    Law::kDeepest,
    Law::kGrows,
    Law::range,
    [](const PhasePair &phases, const PropertyValues &values) {
      return Law::limits(phases, params_of<Law>(values));
    }};

/// Numbers that a contact's history holds of a law's State.
template <class State>
inline constexpr std::size_t kMemoryOf = std::is_empty_v<State> ? 0
                                                                : sizeof(State) / sizeof(double);

template <class State> State load_state(const double *memory) {
  State state;
  std::memcpy(&state, memory, kMemoryOf<State> * sizeof(double));
  return state;
}
template <class State> void store_state(const State &state, double *memory) {
  std::memcpy(memory, &state, kMemoryOf<State> * sizeof(double));
}

/// All laws at once, from their classes.
template <class> struct LawList;
template <class... Law> struct LawList<std::tuple<Law...>> {
  using Params = std::tuple<typename Law::Params...>;
  static constexpr std::array<const ContactLaw *, sizeof...(Law)> kRows = {&kContactLaw<Law>...};
  static constexpr std::size_t kMostMemory = std::max({kMemoryOf<typename Law::State>...});

  /// Sets the parameters of law number n.
  static void set(Params &all, std::size_t n, const PropertyValues &values) {
    std::size_t number = 0;
    ((number++ == n ? void(std::get<typename Law::Params>(all) = params_of<Law>(values)) : void()),
     ...);
  }
};

using AllLaws = LawList<ContactLaws>;
inline constexpr const auto &kContactLaws = AllLaws::kRows;

} // namespace calendem

#endif
