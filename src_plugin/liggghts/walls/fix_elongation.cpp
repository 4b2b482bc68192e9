// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_elongation.h"
#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_time_bpm.h"
#include "fix_wall_gran_platen.h"
#include "modify.h"
#include "physics/fixed_point.h"
#include "update.h"
#include "words.h"
#include "work_ledger.h"
#include <algorithm>
#include <cstdlib>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {
constexpr double kMost = 0.05; // of physics/web_elongation.h
}

FixElongation::FixElongation(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), at_end_(0.0), platen_(NULL), bonds_(NULL), ledger_(NULL) {
  if (narg != 5)
    error->fix_error(FLERR, this, "takes two arguments: 'fix ID all elongation PLATEN E'");
  platen_id_ = arg[3];
  at_end_ = NumberReader(error, this)("elongation", arg[4], above_and_at_most(0.0, kMost));
  if (!domain->periodicity[0])
    error->fix_error(FLERR, this, "needs a cell that is periodic in x");
  vector_flag = 1;
  size_vector = 3;
  global_freq = 1;
  restart_global = 1;
  box_change_size = 1;
}

int FixElongation::setmask() { return INITIAL_INTEGRATE | POST_FORCE; }

void FixElongation::check_order(const char *style, int place) {
  if (place < modify->find_fix(id))
    return;
  const std::string message = std::string("must stand behind fix ") + style + " in the script";
  error->fix_error(FLERR, this, message.c_str());
}

void FixElongation::post_create() { FixTimeBpm::of(lmp)->claim_state(this); }

void FixElongation::init() {
  FixTimeBpm::of(lmp)->stop_if_state_is_lost(this);
  if (modify->n_fixes_style_strict("elongation") > 1)
    error->fix_error(FLERR, this, "there may be only one");
  const int place = modify->find_fix(platen_id_.c_str());
  platen_ = place < 0 ? NULL : dynamic_cast<FixWallGranPlaten *>(modify->fix[place]);
  if (!platen_ || !platen_->rolls()) {
    const std::string message =
        "'" + platen_id_ + "' is no fix wall/gran/platen with 'motion roll'";
    error->fix_error(FLERR, this, message.c_str());
  }
  bonds_ = FixBondBpm::find(lmp, "fix elongation");
  ledger_ = WorkLedger::find(lmp);
  check_order("wall/gran/platen", place);
  check_order("bond/bpm", modify->find_fix(bonds_->id));
  for (int k = 0; k < modify->nfix; ++k)
    if (!strncmp(modify->fix[k]->style, "nve", 3))
      check_order(modify->fix[k]->style, k);
  if (record_.side == 0.0)
    record_.side = domain->prd[0];
}

double FixElongation::growth_to_come() const {
  return (1.0 + at_end_) / (1.0 + record_.elongation) - 1.0;
}

// Positions are put on their grid afterwards, by fix bond/bpm.
void FixElongation::initial_integrate(int) {
  const calendem::WebElongation law = {at_end_, platen_->start(), platen_->last_gap()};
  record_.elongation = std::max(record_.elongation, law.at(platen_->position()));
  stretch(calendem::nearest_multiple((1.0 + record_.elongation) * record_.side,
                                     bonds_->grid().spacing(0)));
  if (ledger_)
    record_.work += record_.step.work_before(ledger_->moments().all);
}

void FixElongation::stretch(double side) {
  record_.step = calendem::ElongationStep(domain->prd[0], side);
  const double growth = record_.step.of_before, origin = domain->boxlo[0];
  if (growth == 0.0)
    return;
  for (int i = 0; i < atom->nlocal; ++i)
    atom->x[i][0] += growth * (atom->x[i][0] - origin);
  domain->boxhi[0] = origin + side;
  domain->set_global_box();
  domain->set_local_box();
}

void FixElongation::post_force(int) {
  if (ledger_)
    record_.work += record_.step.work_after(ledger_->moments().all);
}

double FixElongation::work_of_all() const {
  double all = 0.0;
  MPI_Allreduce(&record_.work, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixElongation::compute_vector(int n) {
  return n == 0 ? record_.elongation : n == 1 ? domain->prd[0] : work_of_all();
}

// The first rank goes on from the sum, as after a restart: both give the same bits.
void FixElongation::write_restart(FILE *fp) {
  record_.work = work_of_all();
  if (comm->me == 0) {
    const int bytes = sizeof(Record);
    fwrite(&bytes, sizeof(int), 1, fp);
    fwrite(&record_, sizeof(Record), 1, fp);
  } else
    record_.work = 0.0;
}

void FixElongation::restart(char *buf) {
  memcpy(&record_, buf, sizeof(Record));
  if (comm->me != 0)
    record_.work = 0.0;
}
