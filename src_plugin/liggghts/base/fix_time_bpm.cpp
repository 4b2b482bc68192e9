// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_time_bpm.h"
#include "comm.h"
#include "error.h"
#include "modify.h"
#include "update.h"
#include <cstring>

using namespace LAMMPS_NS;

namespace {
const char *const kId = "simulated_time";
const char *const kStylesWithState[] = {"bond/bpm", "wall/gran/platen", "energy/bpm",
                                        "cbd/collapse", "elongation"};
} // namespace

FixTimeBpm::FixTimeBpm(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg), begun_(false) {
  if (narg != 3 || strcmp(id, kId) != 0)
    error->fix_error(FLERR, this, "is made by the fixes that need it; leave it out of the script");
  scalar_flag = 1;
  global_freq = 1;
  restart_global = 1;
}

FixTimeBpm *FixTimeBpm::of(LAMMPS *lmp) {
  if (lmp->modify->find_fix(kId) < 0) {
    const char *words[] = {kId, "all", "time/bpm"};
    lmp->modify->add_fix(3, const_cast<char **>(words));
  }
  return static_cast<FixTimeBpm *>(lmp->modify->fix[lmp->modify->find_fix(kId)]);
}

void FixTimeBpm::post_create() {
  for (const char *of : kStylesWithState)
    for (int n = 0; n < modify->n_restart_data_global_style(of); ++n)
      saved_.push_back({of, modify->id_restart_data_global_style(of, n), false});
}

void FixTimeBpm::claim_state(Fix *fix) {
  if (!modify->have_restart_data(fix)) {
    beginners_.insert(fix->id);
    return;
  }
  for (SavedState &state : saved_)
    state.taken |= state.style == fix->style && state.id == fix->id;
}

void FixTimeBpm::stop_if_state_is_lost(Fix *fix) {
  if (beginners_.erase(fix->id) == 0)
    return;
  for (const SavedState &state : saved_) {
    if (state.taken || state.style != fix->style)
      continue;
    const std::string message = "the restart file holds the state of this style under the ID '" +
                                state.id + "', which no fix of the script took before the first " +
                                "run: it would be lost, and '" + fix->id +
                                "' begin anew. Name the fix '" + state.id +
                                "' and define it before that run, or begin from a data file";
    error->fix_error(FLERR, fix, message.c_str());
  }
}

// The host counts the time of this process's runs. A minimizer's iterations are steps of no length.
void FixTimeBpm::init() {
  if (!begun_ && update->atime > 0.0) {
    count_.before = update->atime;
    count_.first = static_cast<double>(update->ntimestep);
  }
  const double length = update->whichflag == 2 ? 0.0 : update->dt;
  if (begun_)
    count_.set_length(static_cast<double>(update->ntimestep), length);
  else
    count_.length = length;
  begun_ = true;
}

int FixTimeBpm::setmask() { return FixConst::INITIAL_INTEGRATE; }

void FixTimeBpm::initial_integrate(int) {
  if (count_.length != update->dt)
    error->fix_error(FLERR, this,
                     "the time step was changed before 'run ... pre no', in which LIGGGHTS' "
                     "integrators keep the old one: leave out 'pre no'");
}

void FixTimeBpm::reset_dt() {
  count_.set_length(static_cast<double>(update->ntimestep), update->dt);
}

void FixTimeBpm::reset_timestep(bigint newstep, bigint oldstep) {
  count_.renumber(static_cast<double>(oldstep), static_cast<double>(newstep));
}

double FixTimeBpm::now() const { return count_.at(static_cast<double>(update->ntimestep)); }

void FixTimeBpm::write_restart(FILE *fp) {
  if (comm->me != 0)
    return;
  const int bytes = sizeof count_;
  fwrite(&bytes, sizeof(int), 1, fp);
  fwrite(&count_, sizeof count_, 1, fp);
}

void FixTimeBpm::restart(char *buf) {
  memcpy(&count_, buf, sizeof count_);
  begun_ = true;
}
