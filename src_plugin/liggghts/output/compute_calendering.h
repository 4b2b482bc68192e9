// SPDX-License-Identifier: GPL-2.0-or-later
// compute ID all calendering PLATEN COLLECTOR
//   PLATEN, COLLECTOR: IDs of fixes wall/gran/platen (side top, side bottom). Needs fix bond/bpm.
// Global vector, for thermo_style custom, fix ave/time and fix print (units micro):
//   1 pressure on the platen, averaged [kPa]   2 pressure on the collector, averaged [kPa]
//   3 gap between them, averaged [um]   4 displacement of the platen, averaged [um]   5 bonds made
//   6 intact   7 broken 8 tension  9 bending  10 shear  11 torsion (broken, by mode) 12 strain
//   energy of intact bonds [fJ]  13 strain energy released by breaks [fJ] 14 work of the platen
//   [fJ]  15 work of the collector [fJ]
// 1 to 4 are averages over the same window, so that pressure and gap belong together.
#ifdef COMPUTE_CLASS

ComputeStyle(calendering, ComputeCalendering)

#else
#ifndef LMP_COMPUTE_CALENDERING_H
#define LMP_COMPUTE_CALENDERING_H

#include "compute.h"
#include <string>

namespace LAMMPS_NS {

class ComputeCalendering : public Compute {
public:
  ComputeCalendering(class LAMMPS *, int &, int, char **);
  ~ComputeCalendering();
  void init();
  void compute_vector();

private:
  std::string platen_id_, collector_id_;
  class FixWallGranPlaten *platen_, *collector_;
  class FixBondBpm *bonds_;

  class FixWallGranPlaten *wall(const std::string &id);
};

} // namespace LAMMPS_NS

#endif
#endif
