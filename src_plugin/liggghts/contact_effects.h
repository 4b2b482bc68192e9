// SPDX-License-Identifier: GPL-2.0-or-later
// Which contacts follow another law than Hertz, by pairs of atom types, and what of a contact
// others ask for: force, area, energy. Used by `model hertz_effects`, the energy ledger, the
// collapse of CBD and the check of the time step. Read from the script's properties
// (peratomtypepair, units micro; one that is missing is 0 everywhere), of which a pair of types may
// have one:
//   contactYieldPressure [kPa]  > 0: elastic-plastic, physics/plastic_contact.h
//   contactRelaxedFraction, contactRelaxationTime [us]  > 0: viscoelastic,
//   physics/viscous_contact.h
// A contact has one number in its history, its memory [um]: its largest overlap if it is plastic,
// the dashpot's part of its overlap if it is viscous.
#ifndef CALENDEM_CONTACT_EFFECTS_H
#define CALENDEM_CONTACT_EFFECTS_H

#include "physics/plastic_contact.h"
#include "physics/viscous_contact.h"
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
  bool act(int itype, int jtype) const { return yields(itype, jtype) || relaxes(itype, jtype); }
  bool yields(int itype, int jtype) const { return yield_pressure_[itype][jtype] > 0.0; }
  bool relaxes(int itype, int jtype) const { return relaxed_fraction_[itype][jtype] > 0.0; }

  /// Elastic force [nN] and stored energy [fJ]; Hertz' without effect or memory (NULL).
  double force(const EffectContact &c, const double *memory) const;
  double elastic_energy(const EffectContact &c, const double *memory) const;

  /// Radius [um] of the area of a contact that an effect acts on; 0 if the law has opened it.
  double contact_radius(const EffectContact &c, double memory) const;
  /// Largest radius [um] of its area so far: its stiffness is at most 2 E* times it.
  double largest_radius(const EffectContact &c, double memory) const;
  /// Radius [um] of the area of a contact under a force [nN] that it has not borne before; of a
  /// viscous one unrelaxed.
  double radius_under(double force, int itype, int jtype, double effective_radius) const;

  /// Brings the memory of a contact that an effect acts on up to its overlap, which `time` [us] ago
  /// was `before`; returns the work [fJ] that this has taken.
  double advance(const EffectContact &c, double before, double time, double &memory) const;

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
  double **yield_pressure_ = nullptr, **relaxed_fraction_ = nullptr, **relaxation_time_ = nullptr;
  double **modulus_ = nullptr, **shear_modulus_ = nullptr, **damping_ = nullptr;

  calendem::PlasticContact plastic(const EffectContact &c) const {
    return {modulus_[c.itype][c.jtype], c.effective_radius, yield_pressure_[c.itype][c.jtype]};
  }
  calendem::ViscousContact viscous(const EffectContact &c) const {
    return {modulus_[c.itype][c.jtype], c.effective_radius, relaxed_fraction_[c.itype][c.jtype],
            relaxation_time_[c.itype][c.jtype]};
  }
  void check(PropertyRegistry &registry) const;
  void check_yield(class LAMMPS *lmp, int i, int j, double cohesion) const;
  void check_relaxation(class LAMMPS *lmp, int i, int j, double cohesion) const;
};

} // namespace LAMMPS_NS

#endif
