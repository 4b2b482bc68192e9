// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all elongation PLATEN E
//
// The cell grows along x, by the fraction E of its side when the roll of fix PLATEN is in its last
// nip, and all particles move with it: physics/web_elongation.h. Velocities are those beside that
// motion; pairs see its gradient, walls stretch alike. Needs the fused loop of `pair_style gran ...
// cohesion bpm surface bpm`. Stands behind fix nve/sphere, fix bond/bpm and the platen.
// Global vector: 1 elongation [-], 2 side of the cell along x [um], 3 work of the elongation [fJ],
// which is known where there is a fix energy/bpm. Restarts under the same fix ID.
#ifdef FIX_CLASS

FixStyle(elongation, FixElongation)

#else
#ifndef LMP_FIX_ELONGATION_H
#define LMP_FIX_ELONGATION_H

#include "cell_growth.h"
#include "fix.h"
#include "physics/web_elongation.h"
#include <string>

namespace LAMMPS_NS {

class FixElongation : public Fix, public CellGrowth {
public:
  FixElongation(class LAMMPS *, int, char **);
  int setmask();
  void post_create();
  void init();
  void initial_integrate(int);
  void post_force(int);
  double compute_vector(int);
  void write_restart(FILE *);
  void restart(char *);

  // CellGrowth
  const calendem::ElongationStep &step() const { return record_.step; }
  double growth_to_come() const;

private:
  /// All that restarts. `work` is this rank's share; the sum over ranks restarts.
  struct Record {
    double side = 0.0; ///< at the beginning [um]; 0: not begun
    double elongation = 0.0;
    double work = 0.0;
    calendem::ElongationStep step;
  };

  std::string platen_id_;
  double at_end_;
  class FixWallGranPlaten *platen_;
  class FixBondBpm *bonds_;
  class WorkLedger *ledger_;
  Record record_;

  void check_order(const char *style, int place);
  void stretch(double side);
  double work_of_all() const;
};

} // namespace LAMMPS_NS

#endif
#endif
