// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all check/timestep/bpm N FRACTION [error yes|no] [pressure P]
// Every N steps (and at set-up) compares the time step with the bound of physics/time_step_bound.h
// and with the Rayleigh time; warns, or stops with `error yes`, when it exceeds FRACTION of the
// smaller. The bound is over all intact bonds, damping included; over the contacts that `model
// hertz_effects` changes, each as stiff as its largest area so far makes it (its unloading is not
// stiffer); and with `pressure` over those that this pressure [kPa] will make, for a step that must
// last. Global vector: 1 bound [us], 2 time step / bound, 3 smallest Rayleigh time [us], 4 time
// step / that.
#ifdef FIX_CLASS

FixStyle(check/timestep/bpm, FixCheckTimestepBpm)

#else
#ifndef LMP_FIX_CHECK_TIMESTEP_BPM_H
#define LMP_FIX_CHECK_TIMESTEP_BPM_H

#include "contact_effects.h"
#include "fix.h"
#include "physics/time_step_bound.h"
#include <vector>

namespace LAMMPS_NS {

class FixCheckTimestepBpm : public Fix {
public:
  FixCheckTimestepBpm(class LAMMPS *, int, char **);
  int setmask();
  void init();
  void setup(int);
  void end_of_step();
  double compute_vector(int);

private:
  double fraction_, bound_, rayleigh_, pressure_;
  double warned_; ///< limit of the last warning; again when it has fallen by a tenth [us]
  ContactEffects effects_;
  bool stop_;

  double bond_bound() const;
  double contact_bound() const;
  void add_contacts(std::vector<calendem::BondRowSum> &stiffness,
                    std::vector<calendem::BondRowSum> &damping) const;
  double rayleigh_time() const;
};

} // namespace LAMMPS_NS

#endif
#endif
