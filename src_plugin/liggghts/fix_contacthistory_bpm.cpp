// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_contacthistory_bpm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "modify.h"

using namespace LAMMPS_NS;
using namespace FixConst;

FixContacthistoryBpm::FixContacthistoryBpm(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), bonds_(NULL) {}

int FixContacthistoryBpm::setmask() { return PRE_EXCHANGE | MIN_PRE_EXCHANGE; }

void FixContacthistoryBpm::init() {
  bonds_ = FixBondBpm::find(lmp, "fix contacthistory/bpm");
  const int host = modify->find_fix("contacthistory");
  if (host >= 0 && host < modify->find_fix(id))
    error->all(FLERR, "fix bond/bpm was defined after a run with this pair_style. Define it before "
                      "the first run, or give pair_style and pair_coeff again behind it");
}

void FixContacthistoryBpm::setup_pre_exchange() { pre_exchange(); }
void FixContacthistoryBpm::pre_exchange() { bonds_->release_histories(); }
void FixContacthistoryBpm::min_setup_pre_exchange() { pre_exchange(); }
void FixContacthistoryBpm::min_pre_exchange() { pre_exchange(); }
