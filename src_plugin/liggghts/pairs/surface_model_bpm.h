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
      bonds_->create(s.i, s.j, s.r, bond);
      bonds_->bridge(s.i, s.j, s.r, bond);
    }
    contact_kinematics(s, s.radsum - s.r);
    s.deltan = bond.contact(s.r, s.radsum).overlap;
    if (s.deltan == 0.0)
      rest(s);
  }

  void surfacesClose(SurfacesCloseData &s, ForceData &, ForceData &) {
    if (!s.contact_history)
      return;
    BondHistory bond(s.contact_history + offset_);
    if (bonds_->creating())
      bonds_->bridge(s.i, s.j, std::sqrt(s.rsq), bond);
    if (bond.state() == kBrokenTouching && s.computeflag && s.shearupdate)
      bonds_->separate(s.i, s.j, bond);
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
  static void contact_kinematics(SurfacesIntersectData &s, double overlap) {
    s.vn = (s.v_i[0] - s.v_j[0]) * s.en[0] + (s.v_i[1] - s.v_j[1]) * s.en[1] +
           (s.v_i[2] - s.v_j[2]) * s.en[2];
    s.cri = s.radi - 0.5 * overlap;
    s.crj = s.radj - 0.5 * overlap;
    s.wr1 = (s.cri * s.omega_i[0] + s.crj * s.omega_j[0]) * s.rinv;
    s.wr2 = (s.cri * s.omega_i[1] + s.crj * s.omega_j[1]) * s.rinv;
    s.wr3 = (s.cri * s.omega_i[2] + s.crj * s.omega_j[2]) * s.rinv;
    s.vtr1 = s.v_i[0] - s.v_j[0] - s.vn * s.en[0] - (s.delta[2] * s.wr2 - s.delta[1] * s.wr3);
    s.vtr2 = s.v_i[1] - s.v_j[1] - s.vn * s.en[1] - (s.delta[0] * s.wr3 - s.delta[2] * s.wr1);
    s.vtr3 = s.v_i[2] - s.v_j[2] - s.vn * s.en[2] - (s.delta[1] * s.wr1 - s.delta[0] * s.wr2);
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
