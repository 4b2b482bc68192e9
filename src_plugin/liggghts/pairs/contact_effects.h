// SPDX-License-Identifier: GPL-2.0-or-later
// Which contacts follow another law than Hertz, by pairs of atom types, and what of a contact
// others ask for: force, area, energy. Used by `model hertz_effects`, the energy ledger, the
// collapse of CBD and the check of the time step. The laws, and the properties that the script
// gives them (peratomtypepair, units micro; one that is missing is 0 everywhere), are those of
// laws/contact_laws.h; a pair of types may have one of them. A contact's history holds its
// law's State, at most kMemory numbers.
#ifndef CALENDEM_CONTACT_EFFECTS_H
#define CALENDEM_CONTACT_EFFECTS_H

#include "laws/contact_laws.h"
#include "physics/contact_pair.h"
#include "physics/contact_range.h"
#include "pointers.h"
#include <type_traits>
#include <vector>

class PropertyRegistry;

namespace LAMMPS_NS {

/// A contact as the laws see it.
struct EffectContact {
  int itype, jtype;
  double effective_radius, overlap, radius; ///< [um]; the last of the smaller sphere
  calendem::GrownSurfaces grown;            ///< for advance

  static EffectContact of_spheres(int itype, int jtype, double Ri, double Rj, double overlap) {
    const double R_eff = calendem::effective_radius(Ri, Rj), R = Ri < Rj ? Ri : Rj;
    return {itype, jtype, R_eff, overlap, R, {R_eff, R}};
  }
  static EffectContact at_wall(int type, int wall_type, double R, double overlap) {
    return {type, wall_type, R, overlap, R, {R, R}};
  }
};

class ContactEffects {
public:
  static constexpr const char *kModel = "hertz_effects";
  /// The host's fix property/atom of what fix cbd/growth finds: growth [um]; then a Grows.
  static constexpr const char *kGrowth = "cbd_growth";
  enum Grows { kNever, kFree, kFull };
  /// History values of a contact.
  static constexpr int kMemory = static_cast<int>(calendem::AllLaws::kMostMemory);

  /// True if the pair style's normal model is `hertz_effects`.
  static bool in_use(class LAMMPS *lmp);

  /// Reads the properties; stops with a message if the script's values cannot be used.
  void connect(PropertyRegistry &registry, const char *caller);

  /// The highest type whose properties are known.
  int types() const { return types_; }

  /// True if contacts of these types follow another law than Hertz.
  bool act(int itype, int jtype) const { return pair(itype, jtype).law >= 0; }

  /// Elastic force [nN] and stored energy [fJ]; Hertz' without effect or memory (NULL).
  double force(const EffectContact &c, const double *memory) const {
    if (!memory || !act(c.itype, c.jtype))
      return calendem::hertz_force(modulus(c.itype, c.jtype), c.effective_radius, c.overlap);
    return with_law(
        c, memory, [&](const auto &law, const auto &state) { return law.force(c.overlap, state); });
  }
  double elastic_energy(const EffectContact &c, const double *memory) const {
    if (!memory || !act(c.itype, c.jtype))
      return calendem::hertz_energy(modulus(c.itype, c.jtype), c.effective_radius, c.overlap);
    return with_law(c, memory, [&](const auto &law, const auto &state) {
      return law.elastic_energy(c.overlap, state);
    });
  }

  // Contacts that an effect acts on; the two for the time step take others too. See
  // physics/law_interface.h.
  double contact_radius(const EffectContact &c, const double *memory) const {
    return with_law(c, memory, [&](const auto &law, const auto &state) {
      return law.contact_radius(c.overlap, state);
    });
  }
  double stiffness_radius(const EffectContact &c, const double *memory) const {
    if (!memory || !act(c.itype, c.jtype))
      return calendem::hertz_contact_radius(c.effective_radius, c.overlap);
    return with_law(c, memory, [&](const auto &law, const auto &state) {
      return law.stiffness_radius(c.overlap, state);
    });
  }
  /// Overlap over the smaller radius up to which the contact's law has been compared.
  double range(const EffectContact &c, const double *memory) const {
    if (!memory || !act(c.itype, c.jtype))
      return calendem::kHertzRange;
    return law(c.itype, c.jtype).range({0.0, c.effective_radius, c.radius});
  }
  double radius_under(double force, const EffectContact &c) const {
    if (!act(c.itype, c.jtype))
      return calendem::hertz_contact_radius(
          c.effective_radius,
          calendem::hertz_overlap(modulus(c.itype, c.jtype), c.effective_radius, force));
    const double none[kMemory] = {};
    return with_law(c, none,
                    [&](const auto &law, const auto &) { return law.radius_under(force); });
  }
  /// Surfaces as spheres i and j have grown (fix cbd/growth), for a law that asks; j < 0: a wall.
  void grow(EffectContact &c, int i, int j) const {
    if (growth_ && law(c.itype, c.jtype).grows)
      c.grown = grown_surfaces(i, j);
  }
  /// Brings the memory up to the contact's overlap, which `time` [us] ago was `before`; returns the
  /// work [fJ] that this has taken.
  double advance(const EffectContact &c, double before, double time, double *memory) const {
    return with_law(c, memory, [&](const auto &law, auto state) {
      double taken;
      if constexpr (std::decay_t<decltype(law)>::kGrows)
        taken = law.advance(before, c.overlap, time, state, c.grown);
      else
        taken = law.advance(before, c.overlap, time, state);
      calendem::store_state(state, memory);
      return taken;
    });
  }
  const calendem::ContactLaw &law(int itype, int jtype) const {
    return *calendem::kContactLaws[pair(itype, jtype).law];
  }

  double modulus(int itype, int jtype) const { return pair(itype, jtype).material.modulus; }
  double shear_modulus(int itype, int jtype) const {
    return pair(itype, jtype).material.shear_modulus;
  }
  double damping(int itype, int jtype) const { return pair(itype, jtype).material.damping; }
  /// Friction is the host's tangential model's business, and not in it.
  const calendem::ContactMaterial &material(int itype, int jtype) const {
    return pair(itype, jtype).material;
  }

private:
  struct TypePair {
    int law = -1; ///< in ContactLaws; -1: Hertz
    calendem::ContactMaterial material = {};
    calendem::AllLaws::Params params;
  };

  int types_ = 0;
  class FixPropertyAtom *growth_ = NULL; // NULL: no sphere grows
  class Atom *atom_ = NULL;
  std::vector<TypePair> pairs_; // by both types, from 1

  const TypePair &pair(int i, int j) const { return pairs_[i * (types_ + 1) + j]; }
  void read(PropertyRegistry &registry, int i, int j, const char *caller);
  void choose(class LAMMPS *lmp, int law, int i, int j);
  calendem::GrownSurfaces grown_surfaces(int i, int j) const;

  /// f(law, state) with the law of the contact's types: a switch over ContactLaws.
  template <int n = 0, class F>
  double with_law(const EffectContact &c, const double *memory, F f) const {
    using Law = std::tuple_element_t<n, calendem::ContactLaws>;
    const TypePair &p = pair(c.itype, c.jtype);
    if constexpr (n + 1 < std::tuple_size_v<calendem::ContactLaws>)
      if (p.law != n)
        return with_law<n + 1>(c, memory, f);
    return f(Law({p.material.modulus, c.effective_radius, c.radius, p.material.cohesion},
                 std::get<n>(p.params)),
             calendem::load_state<typename Law::State>(memory));
  }
};

} // namespace LAMMPS_NS

#endif
