// SPDX-License-Identifier: GPL-2.0-or-later
// fix simulated_time all time/bpm
//
// Owns the simulated time [us]: what has really passed, through changes of `timestep` and
// `reset_timestep` (physics/time_count.h), a minimizer and restarts. Fixes of the plugin that ask
// for the time make it themselves; scripts read it as f_simulated_time. Without any state in the
// restart file, earlier steps count with the length of the first one.
//
// As the first of the plugin's fixes it also knows which of their states the restart file holds. The
// host gives a fix its state by style and ID, and drops without a word what no fix of the script has
// asked for when the first run begins. A fix that begins anew while its style's state is left has
// lost it: an error. Without any fix of the plugin before the first run, nobody knows.
#ifdef FIX_CLASS

FixStyle(time/bpm, FixTimeBpm)

#else
#ifndef LMP_FIX_TIME_BPM_H
#define LMP_FIX_TIME_BPM_H

#include "fix.h"
#include "physics/time_count.h"
#include <set>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class FixTimeBpm : public Fix {
public:
  FixTimeBpm(class LAMMPS *, int, char **);
  int setmask();
  void post_create();
  void init();
  void initial_integrate(int);
  void reset_dt();
  void reset_timestep(bigint newstep, bigint oldstep);
  double compute_scalar() { return now(); }
  void write_restart(FILE *);
  void restart(char *);

  /// At the end of the step that is on [us].
  double now() const;

  /// The fix of the run. Makes it if there is none: to be called first where the host allows that,
  /// in post_create().
  static FixTimeBpm *of(class LAMMPS *lmp);

  /// In the post_create() of a fix with a state in restart files.
  void claim_state(Fix *fix);
  /// In its init(): by then the script has all its fixes.
  void stop_if_state_is_lost(Fix *fix);

private:
  /// What the restart file holds of a fix of the plugin.
  struct SavedState {
    std::string style, id;
    bool taken;
  };

  calendem::TimeCount count_;
  bool begun_;
  std::vector<SavedState> saved_;
  std::set<std::string> beginners_; // IDs of fixes that claimed a state and got none
};

} // namespace LAMMPS_NS

#endif
#endif
