// SPDX-License-Identifier: GPL-2.0-or-later
// Puts bpm_pair_loop.h in the place of the host's loop over pairs for the contact models that it
// computes. `pair_style gran ... fused off`, or any setting of the host's own models, keeps the
// host's.
#ifndef CALENDEM_GRANULAR_BPM_H
#define CALENDEM_GRANULAR_BPM_H

#include "bpm_pair_loop.h"
#include "error.h"
#include "granular_pair_style.h"
#include "lammps.h"
#include <cstring>
#include <string>

namespace LIGGGHTS {
namespace ContactModels {

template <int M, int T, int C, int R, int S> struct GranStyle;
template <typename Style> class ContactModel;

/// Contact objects under another name, which the host's own loop takes.
template <typename Style> class ReferenceModel : public ContactModel<Style> {
public:
  using ContactModel<Style>::ContactModel;
};

template <int M>
using BpmStyle = GranStyle<M, TANGENTIAL_HISTORY, COHESION_BPM, ROLLING_OFF, SURFACE_BPM>;

} // namespace ContactModels

namespace PairStyles {

template <typename ContactModel> class Granular;

template <int M>
class Granular<ContactModels::ContactModel<ContactModels::BpmStyle<M>>>
    : public Granular<ContactModels::ReferenceModel<ContactModels::BpmStyle<M>>> {
  typedef Granular<ContactModels::ReferenceModel<ContactModels::BpmStyle<M>>> Reference;

public:
  Granular(class LAMMPS_NS::LAMMPS *lmp, LAMMPS_NS::PairGran *parent, const int64_t hash)
      : Reference(lmp, parent, hash), lmp_(lmp), loop_(lmp), fused_(true) {}

  void settings(int nargs, char **args, IContactHistorySetup *hsetup) {
    if (nargs >= 2 && !strcmp(args[0], "fused")) {
      fused_ = !strcmp(args[1], "on");
      if (!fused_ && strcmp(args[1], "off") != 0) {
        const std::string message =
            std::string("pair_style gran: 'fused' is '") + args[1] + "'; it must be on or off";
        lmp_->error->all(FLERR, message.c_str());
      }
      nargs -= 2;
      args += 2;
    }
    fused_ = fused_ && nargs == 0;
    Reference::settings(nargs, args, hsetup);
  }

  void init_granular() {
    Reference::init_granular();
    loop_.connect(this->get_history_offset("bond_bpm"),
                  this->get_history_offset("contact_effects"));
  }

  void compute_force(LAMMPS_NS::PairGran *pair, int eflag, int vflag, int addflag) {
    loop_.prepare();
    if (!fused_ || addflag || !loop_.serves(pair)) {
      loop_.check_reference();
      loop_.release_histories();
      return Reference::compute_force(pair, eflag, vflag, addflag);
    }
    if (eflag || vflag)
      pair->ev_setup(eflag, vflag);
    else
      pair->evflag = pair->vflag_fdotr = 0;
    loop_.compute_force(pair);
  }

private:
  LAMMPS_NS::LAMMPS *lmp_;
  LAMMPS_NS::BpmPairLoop loop_;
  bool fused_;
};

} // namespace PairStyles
} // namespace LIGGGHTS

#endif
