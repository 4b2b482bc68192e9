// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_contacthistory_bpm.h"
#include "bond_events.h"
#include "error.h"
#include "fix_contact_history.h"
#include "modify.h"
#include "neighbor.h"
#include "output.h"
#include "update.h"

using namespace LAMMPS_NS;
using namespace FixConst;

FixContacthistoryBpm::FixContacthistoryBpm(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), pairs_(NULL), saved_pages_() {}

int FixContacthistoryBpm::setmask() { return PRE_EXCHANGE | END_OF_STEP; }

// The host keeps what it has saved in pages of a size, and frees them when another is asked for.
void FixContacthistoryBpm::init() {
  pairs_ = NULL; // after 'unfix' of fix bond/bpm there is nothing to return
  if (modify->n_fixes_style_strict("bond/bpm") == 0)
    return;
  pairs_ = &BondEvents::find(lmp, "fix contacthistory/bpm")->pairs();
  const int host = modify->find_fix("contacthistory");
  if (host >= 0 && host < modify->find_fix(id))
    error->all(FLERR, "fix bond/bpm was defined after a run with this pair_style. Define it before "
                      "the first run, or give pair_style and pair_coeff again behind it");
  const std::array<int, 2> pages = {neighbor->oneatom, neighbor->pgsize};
  char message[300];
  snprintf(message, sizeof message,
           "'neigh_modify one %d page %d' after a run with 'one %d page %d': LIGGGHTS would lose "
           "the histories of all contacts and bonds. Give it before the first run",
           pages[0], pages[1], saved_pages_[0], saved_pages_[1]);
  if (saved_pages_[1] != 0 && pages != saved_pages_)
    error->all(FLERR, message);
}

FixContactHistory *FixContacthistoryBpm::of_host() const {
  const PairGran *pair = static_cast<PairGran *>(force->pair_match("gran", 1));
  return pair ? pair->get_fix_history() : NULL;
}

void FixContacthistoryBpm::setup_pre_exchange() { pre_exchange(); }
void FixContacthistoryBpm::pre_exchange() {
  if (pairs_)
    pairs_->release_histories();
}

void FixContacthistoryBpm::end_of_step() {
  if (!pairs_ || neighbor->ago != 0 || !output->restart_requested(update->ntimestep))
    return; // such a step always rebuilds the lists
  pairs_->store_histories();
  if (of_host())
    of_host()->pre_exchange();
}

void FixContacthistoryBpm::post_run() {
  if (!pairs_)
    return;
  pairs_->release_histories();
  if (of_host())
    of_host()->setup_pre_exchange();
  saved_pages_ = {neighbor->oneatom, neighbor->pgsize};
}
