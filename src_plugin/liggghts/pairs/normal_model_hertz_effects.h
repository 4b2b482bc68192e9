// SPDX-License-Identifier: GPL-2.0-or-later
// Normal model `hertz_effects`: the host's `hertz`, except between atom types for which an effect
// of contact_effects.h is set. Properties as of `hertz`, and those of contact_effects.h. Setting:
// tangential_damping on|off. Works in pair_style gran and in all fixes wall/gran.
//   F_n = law(overlap, memory) - gamma v_n,  gamma and k_t the host's with the law's contact radius
//   a: S_n = 2 E* a, S_t = k_t = 8 G* a. A contact that the law has opened (a = 0) takes no
//   friction.
// A pair whose overlap is counted from its creation (bonded, or broken and not yet separated) stays
// Hertz: effects are for surfaces that meet, not for the inside of a body. Memory ends when the
// spheres have separated. What effects take is booked in fix energy/bpm. A sphere that sinks
// into a wall by more than 0.9 of its radius is an error.
#ifdef NORMAL_MODEL
NORMAL_MODEL(HERTZ_EFFECTS, hertz_effects, 30)
#else
#ifndef NORMAL_MODEL_HERTZ_EFFECTS_H_
#define NORMAL_MODEL_HERTZ_EFFECTS_H_

#include "bond_bpm_history.h"
#include "contact_effects.h"
#include "contact_models.h"
#include "error.h"
#include "normal_model_base.h"
#include "physics/contact_pair.h"
#include "update.h"
#include "work_ledger.h"
#include <cmath>
#include <cstdio>

namespace LIGGGHTS {
namespace ContactModels {

template <> class NormalModel<HERTZ_EFFECTS> : public NormalModelBase {
public:
  NormalModel(LAMMPS *lmp, IContactHistorySetup *hsetup, class ContactModelBase *cmb)
      : NormalModelBase(lmp, hsetup, cmb), ledger_(NULL), tangential_damping_(true),
        memory_(hsetup->add_history_value("contact_memory", "0")), bond_(-1) {
    for (int k = 1; k < LAMMPS_NS::ContactEffects::kMemory; ++k)
      hsetup->add_history_value("contact_memory", "0");
    cmb->add_history_offset("contact_effects", memory_);
  }

  void registerSettings(Settings &settings) {
    settings.registerOnOff("tangential_damping", tangential_damping_, true);
  }

  void postSettings(IContactHistorySetup *, ContactModelBase *cmb) {
    bond_ = cmb->get_history_offset("bond_bpm");
  }

  void connectToProperties(PropertyRegistry &registry) {
    effects_.connect(registry, "model hertz_effects");
    ledger_ = WorkLedger::find(lmp);
  }

  double stressStrainExponent() { return 1.5; }

  void surfacesIntersect(SurfacesIntersectData &s, ForceData &i_forces, ForceData &j_forces) {
    if (s.contact_flags)
      *s.contact_flags |= CONTACT_NORMAL_MODEL;
    using LAMMPS_NS::EffectContact;
    EffectContact contact =
        s.is_wall ? EffectContact::at_wall(s.itype, s.jtype, s.radi, s.deltan)
                  : EffectContact::of_spheres(s.itype, s.jtype, s.radi, s.radj, s.deltan);
    double radius = calendem::hertz_contact_radius(contact.effective_radius, s.deltan);
    double force =
        calendem::hertz_mindlin_elastic(effects_.modulus(s.itype, s.jtype), radius, s.deltan);
    if (s.deltan <= 0.0)
      forget(s.contact_history);
    else if (effects_.act(s.itype, s.jtype) && meets(s)) {
      double *memory = s.contact_history + memory_;
      if (s.computeflag && s.shearupdate) {
        stop_if_sunk(s, contact);
        effects_.grow(contact, s.i, s.is_wall ? -1 : s.j);
        advance(s, contact, memory);
      }
      radius = effects_.contact_radius(contact, memory);
      force = effects_.force(contact, memory);
    }
    set(s, radius, force);
    apply(s, i_forces, j_forces);
  }

  void surfacesClose(SurfacesCloseData &s, ForceData &, ForceData &) {
    if (s.contact_flags)
      *s.contact_flags |= CONTACT_NORMAL_MODEL;
    forget(s.contact_history);
  }

  void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void endPass(SurfacesIntersectData &, ForceData &, ForceData &) {}

private:
  LAMMPS_NS::ContactEffects effects_;
  WorkLedger *ledger_; // NULL when no ledger is kept
  bool tangential_damping_;
  int memory_, bond_; // offsets in the history; bond_ is -1 without bonds

  void forget(double *history) const {
    for (int k = 0; history && k < LAMMPS_NS::ContactEffects::kMemory; ++k)
      history[memory_ + k] = 0.0;
  }

  bool meets(const SurfacesIntersectData &s) const {
    return bond_ < 0 || !LAMMPS_NS::BondHistory(s.contact_history + bond_).has_reference();
  }

  // Before the host loses a sphere whose centre leaves the box through a wall.
  void stop_if_sunk(const SurfacesIntersectData &s, const LAMMPS_NS::EffectContact &c) {
    const calendem::ContactLaw &law = effects_.law(s.itype, s.jtype);
    if (!s.is_wall || c.overlap <= law.deepest * s.radi)
      return;
    char text[320];
    snprintf(text, sizeof text,
             "model hertz_effects: a sphere of type %d has sunk %.3g um into the wall of type %d, "
             "more than %g of its radius, %.3g um: %s is too low for the load on single spheres. "
             "Raise it, take a larger cell, or press less",
             s.itype, c.overlap, s.jtype, law.deepest, s.radi, law.properties[0].name);
    error->one(FLERR, text);
  }

  void advance(const SurfacesIntersectData &s, const LAMMPS_NS::EffectContact &contact,
               double *memory) {
    const double dt = update->dt;
    const double taken = effects_.advance(contact, s.deltan + s.vn * dt, dt, memory);
    if (!ledger_ || taken == 0.0)
      return;
    const calendem::WorkTaken term = effects_.law(s.itype, s.jtype).takes;
    if (s.is_wall)
      ledger_->add_taken(taken, term);
    else
      ledger_->add_taken(s.i, s.j, taken, term);
  }

  void set(SurfacesIntersectData &s, double radius, double force) const {
    const calendem::ContactResistance resistance =
        calendem::contact_resistance(effects_.material(s.itype, s.jtype), radius, s.meff);
    s.kn = s.deltan > 0.0 ? force / s.deltan : 0.0; // F = kn deltan, as the ledger reads it
    s.kt = resistance.tangential_stiffness;
    s.gamman = resistance.normal_damping;
    s.gammat = tangential_damping_ ? resistance.tangential_damping : 0.0;
    s.Fn = force - s.gamman * s.vn;
    if (radius == 0.0) // open: the friction spring must not wind up meanwhile
      s.vtr1 = s.vtr2 = s.vtr3 = 0.0;
  }

  void apply(const SurfacesIntersectData &s, ForceData &i_forces, ForceData &j_forces) const {
    const double part = s.is_wall ? s.area_ratio : 1.0;
    for (int k = 0; k < 3; ++k) {
      i_forces.delta_F[k] += part * s.Fn * s.en[k];
      if (!s.is_wall)
        j_forces.delta_F[k] -= s.Fn * s.en[k];
    }
  }
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
