// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all contacthistory/bpm
//
// Made by fix bond/bpm. The plugin's loop over pairs keeps histories while it runs; this returns
// them to the host's lists before anything saves them or changes atoms. The host calls fixes whose
// style begins with `contacthistory` before all others, in the order of their making, and makes its
// own with the first run: this one stands before it.
#ifdef FIX_CLASS

FixStyle(contacthistory/bpm, FixContacthistoryBpm)

#else
#ifndef LMP_FIX_CONTACTHISTORY_BPM_H
#define LMP_FIX_CONTACTHISTORY_BPM_H

#include "fix.h"

namespace LAMMPS_NS {

class FixContacthistoryBpm : public Fix {
public:
  FixContacthistoryBpm(class LAMMPS *, int, char **);
  int setmask();
  void init();
  void setup_pre_exchange();
  void pre_exchange();
  void min_setup_pre_exchange();
  void min_pre_exchange();

private:
  class FixBondBpm *bonds_;
};

} // namespace LAMMPS_NS

#endif
#endif
