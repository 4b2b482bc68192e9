// SPDX-License-Identifier: GPL-2.0-or-later
// Cohesion model `bpm`: the parallel bond for bonded pairs, SJKR (eq. 3) for all others, in one
// run, with a binder bridge beside it where there is one.
#ifdef COHESION_MODEL
COHESION_MODEL(COHESION_BPM, bpm, 30)
#else
#ifndef COHESION_MODEL_BPM_H_
#define COHESION_MODEL_BPM_H_

#include "atom.h"
#include "bond_bpm_history.h"
#include "bond_events.h"
#include "cohesion_model_base.h"
#include "contact_models.h"
#include "global_properties.h"
#include "physics/bond_pair.h"
#include "physics/sjkr_cohesion.h"
#include "update.h"
#include "work_ledger.h"
#include <cmath>

namespace LIGGGHTS {
namespace ContactModels {

template <> class CohesionModel<COHESION_BPM> : public CohesionModelBase {
public:
  CohesionModel(LAMMPS *lmp, IContactHistorySetup *hsetup, class ContactModelBase *cmb)
      : CohesionModelBase(lmp, hsetup, cmb), bonds_(NULL), ledger_(NULL), cohEnergyDens_(NULL),
        cmb_(cmb), offset_(-1) {
    if (cmb->is_wall())
      error->all(FLERR, "cohesion model bpm is for particle pairs; for a sticky wall use 'cohesion "
                        "sjkr' in fix wall/gran");
  }

  void registerSettings(Settings &) {}

  void postSettings(IContactHistorySetup *, ContactModelBase *cmb) {
    offset_ = cmb->get_history_offset("bond_bpm");
    if (offset_ < 0)
      error->all(FLERR, "cohesion model bpm needs 'surface bpm' in the same pair_style gran");
  }

  void connectToProperties(PropertyRegistry &registry) {
    registry.registerProperty("cohEnergyDens", &MODEL_PARAMS::createCohesionEnergyDensity);
    registry.connect("cohEnergyDens", cohEnergyDens_, "cohesion_model bpm");
    bonds_ = BondEvents::find(lmp, "cohesion model bpm");
    ledger_ = WorkLedger::find(lmp);
  }

  void surfacesIntersect(SurfacesIntersectData &s, ForceData &i_forces, ForceData &j_forces) {
    BondHistory bond(s.contact_history + offset_);
    if (s.contact_flags)
      *s.contact_flags |= CONTACT_COHESION_MODEL;
    const calendem::Vec3 n = {s.en[0], s.en[1], s.en[2]};
    if (bond.state() == kIntact) {
      bond_force(s, bond, n, s.r, i_forces, j_forces);
    } else {
      const double pull = calendem::sjkr_force(
          cohEnergyDens_[s.itype][s.jtype], bond.contact(s.r, s.radsum).distance, s.radi, s.radj);
      calendem::subtract_from(pull * n, i_forces.delta_F);
      calendem::add_to(pull * n, j_forces.delta_F);
      if (bond.state() == kBridge)
        bond_force(s, bond, n, s.r, i_forces, j_forces);
    }
    if (ledger_)
      remember(i_forces, j_forces);
  }

  void surfacesClose(SurfacesCloseData &s, ForceData &i_forces, ForceData &j_forces) {
    if (!s.contact_history)
      return;
    BondHistory bond(s.contact_history + offset_);
    if (!bond.acts())
      return;
    *s.contact_flags |= CONTACT_COHESION_MODEL;
    s.omega_i = atom->omega[s.i];
    s.omega_j = atom->omega[s.j];
    const double r = std::sqrt(s.rsq);
    const calendem::Vec3 n = (1.0 / r) * calendem::load(s.delta);
    bond_force(s, bond, n, r, i_forces, j_forces);
    s.has_force_update = true;
    bonds_->check_stretch(r / s.radsum);
  }

  // For the energy ledger: what the tangential model has added since, and the normal damping.
  void endSurfacesIntersect(SurfacesIntersectData &s, ForceData &i_forces, ForceData &j_forces) {
    if (ledger_ && s.computeflag && s.deltan > 0.0)
      book_contact(s, i_forces, j_forces);
  }
  void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void endPass(SurfacesIntersectData &, ForceData &, ForceData &) {}

private:
  BondEvents *bonds_;
  WorkLedger *ledger_;       // NULL when no ledger is kept
  ForceAndTorque so_far_[2]; // on i and j, before the tangential model
  double **cohEnergyDens_;
  ContactModelBase *cmb_;
  int offset_;

  static ForceAndTorque action_of(const ForceData &f) {
    return {calendem::load(f.delta_F), calendem::load(f.delta_torque)};
  }

  // Kept out of line: inlined they would slow down runs without a ledger.
  __attribute__((noinline)) void remember(const ForceData &i_forces, const ForceData &j_forces) {
    so_far_[0] = action_of(i_forces);
    so_far_[1] = action_of(j_forces);
  }
  __attribute__((noinline)) void book_contact(const SurfacesIntersectData &s,
                                              const ForceData &i_forces,
                                              const ForceData &j_forces) {
    const double damping = s.Fn - s.kn * s.deltan;
    const calendem::Vec3 force = {damping * s.en[0], damping * s.en[1], damping * s.en[2]};
    ledger_->add_damping(s.i, {force, {}});
    ledger_->add_damping(s.j, {-force, {}});
    ledger_->add_friction(s.i, action_of(i_forces) - so_far_[0]);
    ledger_->add_friction(s.j, action_of(j_forces) - so_far_[1]);
  }
  __attribute__((noinline)) void book_damping(int i, int j, const calendem::BondPair &pair,
                                              const calendem::BondDamping &damping) {
    ledger_->add_damping(i, j, pair.damping_action(damping));
  }

  void bond_force(SurfacesCloseData &s, BondHistory &bond, const calendem::Vec3 &n, double r,
                  ForceData &i_forces, ForceData &j_forces) {
    const BondSettings &b = bonds_->settings_of(bond);
    const calendem::BondPair pair(b.material, s.radi, s.radj, bond.length(),
                                  {calendem::load(s.delta),
                                   calendem::load(s.v_i) - calendem::load(s.v_j),
                                   calendem::load(s.omega_i), calendem::load(s.omega_j), n, r});
    calendem::BondLoads loads = bond.loads();
    if (s.computeflag && s.shearupdate) {
      bonds_->count_acting_pair(s.i, s.j);
      pair.advance(loads, update->dt);
      bond.set_loads(loads);
      if (b.breakable && pair.fails(loads, b.strength_of(bond.strength_factor()), b.criterion))
        bonds_->record_break(s.i, s.j, bond, pair, loads);
    }
    const calendem::BondDamping damping = pair.damping(
        b.material, s.radi, s.radj, calendem::effective_mass(atom->rmass[s.i], atom->rmass[s.j]));
    const calendem::BondAction a = pair.action(loads, damping);
    if (ledger_ && s.computeflag) {
      book_damping(s.i, s.j, pair, damping);
      if (bond.state() == kBridge && bonds_->shrinks())
        ledger_->add_shrinking(s.i, s.j, pair.tension * bond.length());
    }
    calendem::add_to(a.force, i_forces.delta_F);
    calendem::subtract_from(a.force, j_forces.delta_F);
    calendem::add_to(a.torque_i, i_forces.delta_torque);
    calendem::add_to(a.torque_j, j_forces.delta_torque);
  }
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
