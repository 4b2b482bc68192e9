// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all contacthistory/bpm
//
// Made by fix bond/bpm. The plugin's loop over pairs keeps histories while it runs; this returns
// them to the host's lists before anything saves them or changes atoms. The host calls fixes whose
// style begins with `contacthistory` before all others, in the order of their making, and makes its
// own with the first run: this one stands before it, and stays when fix bond/bpm is given anew. At the end of a run it has them saved as well,
// since commands between runs put new atoms into the places of ghosts; and again in a step of
// `restart N`, for which the host has saved them before the step's forces: its file would heal the
// bonds that broke in that step.
#ifdef FIX_CLASS

FixStyle(contacthistory/bpm, FixContacthistoryBpm)

#else
#ifndef LMP_FIX_CONTACTHISTORY_BPM_H
#define LMP_FIX_CONTACTHISTORY_BPM_H

#include "fix.h"
#include <array>

namespace LAMMPS_NS {

class FixContacthistoryBpm : public Fix {
public:
  FixContacthistoryBpm(class LAMMPS *, int, char **);
  int setmask();
  void init();
  void setup_pre_exchange();
  void pre_exchange();
  void end_of_step();
  void post_run();

private:
  class BondPairs *pairs_;
  std::array<int, 2> saved_pages_; // neigh_modify one, page at the end of the last run

  class FixContactHistory *of_host() const;
};

} // namespace LAMMPS_NS

#endif
#endif
