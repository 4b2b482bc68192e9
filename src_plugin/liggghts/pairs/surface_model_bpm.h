// SPDX-License-Identifier: GPL-2.0-or-later
// Surface model `bpm`: runs before all other contact models, makes the bonds when `fix bond/bpm`
// says so, and measures the contact of a bonded pair from its overlap at creation.
#ifdef SURFACE_MODEL
SURFACE_MODEL(SURFACE_BPM, bpm, 30)
#else
#ifndef SURFACE_MODEL_BPM_H_
#define SURFACE_MODEL_BPM_H_

#include "atom.h"
#include "bond_bpm_history.h"
#include "bond_events.h"
#include "contact_models.h"
#include "error.h"
#include "force.h"
#include "granular_bpm.h"
#include "history_layout.h"
#include "physics/contact_pair.h"
#include "surface_model_base.h"
#include <cmath>

namespace LIGGGHTS {
namespace ContactModels {

template <> class SurfaceModel<SURFACE_BPM> : public SurfaceModelBase {
public:
  SurfaceModel(LAMMPS *lmp, IContactHistorySetup *hsetup, class ContactModelBase *cmb)
      : SurfaceModelBase(lmp, hsetup, cmb), bonds_(NULL), offset_(-1), spring_(-1) {
    if (cmb->is_wall())
      error->all(FLERR, "surface model bpm is for particle pairs; walls take 'surface default' "
                        "(leave the keyword out of fix wall/gran)");
    offset_ = hsetup->add_history_value("bond_shear_x", "1");
    hsetup->add_history_value("bond_shear_y", "1");
    hsetup->add_history_value("bond_shear_z", "1");
    hsetup->add_history_value("bond_twist", "0");
    hsetup->add_history_value("bond_bending_x", "1");
    hsetup->add_history_value("bond_bending_y", "1");
    hsetup->add_history_value("bond_bending_z", "1");
    hsetup->add_history_value("bond_strength", "0");
    hsetup->add_history_value("bond_length", "0");
    hsetup->add_history_value("bond_meeting_distance", "0");
    hsetup->add_history_value("bond_state", "0");
    cmb->add_history_offset("bond_bpm", offset_);
  }

  void registerSettings(Settings &) {}
  void postSettings(IContactHistorySetup *, ContactModelBase *) {}

  void connectToProperties(PropertyRegistry &) {
    bonds_ = BondEvents::find(lmp, "surface model bpm");
    if (!static_cast<PairGran *>(force->pair_match("gran", 1))->contact_match("cohesion", "bpm"))
      error->all(FLERR, "surface model bpm makes bonds whose forces 'cohesion bpm' computes: "
                        "write 'cohesion bpm surface bpm' in pair_style gran");
    bonds_->pairs().connect(offset_);
    spring_ = friction_history_offset(lmp, offset_);
  }

  // An intact bond that is not compressed has no contact: the host then passes it to surfacesClose
  // and spares the Hertz and friction models.
  bool checkSurfaceIntersect(SurfacesIntersectData &s) {
    const BondHistory bond(s.contact_history + offset_);
    return bonds_->creating() || bond.state() != kIntact || s.rsq < bond.length() * bond.length();
  }

  void surfacesIntersect(SurfacesIntersectData &s, ForceData &, ForceData &) {
    BondHistory bond(s.contact_history + offset_);
    if (bonds_->creating()) {
      bonds_->make_bond(s.i, s.j, s.r, bond);
      bonds_->make_bridge(s.i, s.j, s.r, bond);
    }
    contact_kinematics(s);
    s.deltan = bond.contact(s.r, s.radsum).overlap;
    if (s.deltan == 0.0)
      rest(s);
  }

  void surfacesClose(SurfacesCloseData &s, ForceData &, ForceData &) {
    if (!s.contact_history)
      return;
    BondHistory bond(s.contact_history + offset_);
    if (bonds_->creating()) {
      bonds_->make_bond(s.i, s.j, std::sqrt(s.rsq), bond);
      bonds_->make_bridge(s.i, s.j, std::sqrt(s.rsq), bond);
    }
    if (bond.state() == kBrokenTouching && s.computeflag && s.shearupdate)
      bonds_->mark_separated(s.i, s.j, bond);
  }

  void endSurfacesIntersect(SurfacesIntersectData &, TriMesh *, double *const) {}
  void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void endPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void tally_pp(double, int, int, int) {}
  void tally_pw(double, int, int, int) {}

private:
  BondEvents *bonds_;
  int offset_;
  int spring_; // first of the tangential model's three history values, -1 if it has none

  // Relative velocity at the contact point, as the host's default surface model defines it.
  static void contact_kinematics(SurfacesIntersectData &s) {
    const calendem::ContactMotion motion = calendem::contact_motion(
        {calendem::load(s.delta), calendem::load(s.v_i) - calendem::load(s.v_j),
         calendem::load(s.omega_i), calendem::load(s.omega_j), calendem::load(s.en), s.r},
        s.radi, s.radj);
    s.vn = motion.normal_velocity;
    s.cri = motion.arm_i;
    s.crj = motion.arm_j;
    s.wr1 = motion.spin.x;
    s.wr2 = motion.spin.y;
    s.wr3 = motion.spin.z;
    s.vtr1 = motion.sliding_velocity.x;
    s.vtr2 = motion.sliding_velocity.y;
    s.vtr3 = motion.sliding_velocity.z;
    s.P_diss = 0.0;
  }

  // No contact beyond the reference: no force, and no friction spring may wind up meanwhile.
  void rest(SurfacesIntersectData &s) const {
    s.vn = s.vtr1 = s.vtr2 = s.vtr3 = 0.0;
    if (spring_ >= 0)
      for (int k = 0; k < 3; ++k)
        s.contact_history[spring_ + k] = 0.0;
  }
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
