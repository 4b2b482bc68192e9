// SPDX-License-Identifier: GPL-2.0-or-later
// Which contacts follow another law than Hertz, by pairs of atom types, and what of such a contact
// others ask for: force, area, energy. Used by `model hertz_effects`, the energy ledger and the
// check of the time step. Read from the script's properties (peratomtypepair, units micro; one that
// is missing is 0 everywhere):
//   contactYieldPressure [kPa]  > 0: elastic-plastic, physics/plastic_contact.h
// A contact has one number in its history, its memory [um]: the largest overlap.
#ifndef CALENDEM_CONTACT_EFFECTS_H
#define CALENDEM_CONTACT_EFFECTS_H

#include "physics/plastic_contact.h"
#include "pointers.h"

class PropertyRegistry;

namespace LAMMPS_NS {

/// A contact as the laws see it.
struct EffectContact {
  int itype, jtype;
  double effective_radius, overlap; ///< [um]
};

class ContactEffects {
public:
  static constexpr const char *kModel = "hertz_effects";
  static constexpr int kMemory = 1; ///< history values of a contact

  /// True if the pair style's normal model is `hertz_effects`.
  static bool in_use(class LAMMPS *lmp);

  /// Stops with a message if the script's values cannot be used.
  void connect(PropertyRegistry &registry, const char *caller);

  /// True if contacts of these types follow another law than Hertz.
  bool act(int itype, int jtype) const { return yield_pressure_[itype][jtype] > 0.0; }

  /// Elastic force [nN] and stored energy [fJ]; Hertz' without effect or memory (NULL).
  double force(const EffectContact &c, const double *memory) const;
  double elastic_energy(const EffectContact &c, const double *memory) const;

  double contact_radius(const EffectContact &c, double memory) const {
    return plastic(c).contact_radius(c.overlap, memory);
  }
  /// Largest radius [um] of the contact's area so far: its stiffness is at most 2 E* times it.
  double largest_radius(const EffectContact &c, double memory) const {
    const double overlap = c.overlap > memory ? c.overlap : memory;
    return plastic(c).contact_radius(overlap, overlap);
  }
  /// Radius [um] of a contact's area under a force [nN] that it has not borne before.
  double radius_under(double force, int itype, int jtype, double effective_radius) const {
    const calendem::PlasticContact law = plastic({itype, jtype, effective_radius, 0.0});
    const double overlap = law.overlap_under(force);
    return law.contact_radius(overlap, overlap);
  }
  double modulus(int itype, int jtype) const { return modulus_[itype][jtype]; }
  double shear_modulus(int itype, int jtype) const { return shear_modulus_[itype][jtype]; }
  double damping(int itype, int jtype) const { return damping_[itype][jtype]; } ///< the host's beta

  /// Brings a contact's memory up to its overlap; returns the work [fJ] that this has taken.
  double advance(const EffectContact &c, double &memory) const {
    if (c.overlap <= memory)
      return 0.0;
    const double before = plastic(c).plastic_work(memory);
    memory = c.overlap;
    return plastic(c).plastic_work(memory) - before;
  }

private:
  double **yield_pressure_ = nullptr, **modulus_ = nullptr, **shear_modulus_ = nullptr,
         **damping_ = nullptr;

  calendem::PlasticContact plastic(const EffectContact &c) const {
    return {modulus_[c.itype][c.jtype], c.effective_radius, yield_pressure_[c.itype][c.jtype]};
  }
  void check(PropertyRegistry &registry) const;
};

} // namespace LAMMPS_NS

#endif
