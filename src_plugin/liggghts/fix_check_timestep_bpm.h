// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all check/timestep/bpm N FRACTION [error yes|no]
// Every N steps (and at set-up) compares the time step with the bound of physics/time_step_bound.h
// over all intact bonds, damping included, and with the Rayleigh time; warns, or stops with `error
// yes`, when it exceeds FRACTION of the smaller. Global vector: 1 bound [us], 2 time step / bound,
// 3 smallest Rayleigh time [us], 4 time step / that.
#ifdef FIX_CLASS

FixStyle(check/timestep/bpm, FixCheckTimestepBpm)

#else
#ifndef LMP_FIX_CHECK_TIMESTEP_BPM_H
#define LMP_FIX_CHECK_TIMESTEP_BPM_H

#include "fix.h"

namespace LAMMPS_NS {

class FixCheckTimestepBpm : public Fix {
public:
  FixCheckTimestepBpm(class LAMMPS *, int, char **);
  int setmask();
  void setup(int);
  void end_of_step();
  double compute_vector(int);

private:
  double fraction_, bound_, rayleigh_;
  bool stop_;

  double bond_bound() const;
  double rayleigh_time() const;
};

} // namespace LAMMPS_NS

#endif
#endif
