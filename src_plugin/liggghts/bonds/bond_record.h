// SPDX-License-Identifier: GPL-2.0-or-later
// What fix bond/bpm writes into a restart file beside the histories of the pairs.
#ifndef CALENDEM_BOND_RECORD_H
#define CALENDEM_BOND_RECORD_H

#include "break_log.h"
#include <array>
#include <cstdio>
#include <vector>

namespace LAMMPS_NS {

struct BondRecord {
  double created = 0.0;
  bigint made = 0;
  BreakTotals totals;
  bigint bridges_made[calendem::kBridgeKinds] = {};
  double shrunk = 0.0;
  std::array<double, 5> repeated = {}; ///< settings that the run which goes on has to repeat
  int bodies = 0;
  double largest_radius = 0.0; ///< [um]
  std::vector<BreakEvent> events;

  void write(FILE *fp) const;
  void read(const char *buf);

private:
  template <class Visit> static void for_each_value(BondRecord &record, Visit visit);
};

} // namespace LAMMPS_NS

#endif
