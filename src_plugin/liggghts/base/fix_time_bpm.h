// SPDX-License-Identifier: GPL-2.0-or-later
// fix simulated_time all time/bpm
//
// Owns the simulated time [us]: what has really passed, through changes of `timestep` and
// `reset_timestep` (physics/time_count.h), a minimizer and restarts. Fixes of the plugin that ask
// for the time make it themselves; scripts read it as f_simulated_time. Without any state in the
// restart file, earlier steps count with the length of the first one.
#ifdef FIX_CLASS

FixStyle(time/bpm, FixTimeBpm)

#else
#ifndef LMP_FIX_TIME_BPM_H
#define LMP_FIX_TIME_BPM_H

#include "fix.h"
#include "physics/time_count.h"

namespace LAMMPS_NS {

class FixTimeBpm : public Fix {
public:
  FixTimeBpm(class LAMMPS *, int, char **);
  int setmask() { return 0; }
  void init();
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

private:
  calendem::TimeCount count_;
  bool begun_;
};

} // namespace LAMMPS_NS

#endif
#endif
