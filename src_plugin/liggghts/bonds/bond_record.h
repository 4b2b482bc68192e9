// SPDX-License-Identifier: GPL-2.0-or-later
// What fix bond/bpm writes into a restart file beside the histories of the pairs.
#ifndef CALENDEM_BOND_RECORD_H
#define CALENDEM_BOND_RECORD_H

#include "break_log.h"
#include <cstdio>
#include <vector>

namespace LAMMPS_NS {

/// Settings that a run which goes on has to repeat: what pairs keep follows from them.
struct RepeatedSettings {
  double contact_diameter = 1.0, surface_inset = 0.0, inset_fading = 0.0;
  double shrinkage = 0.0, shrinkage_time = 0.0; ///< [-], [us]

  /// Stops the run, with a message that names the fix `owner`, if `now` is another.
  void check(const RepeatedSettings &now, class Error *error, class Fix *owner) const;
};

struct BondRecord {
  double created = 0.0;
  bigint made = 0;
  BreakTotals totals;
  bigint bridges_made[calendem::kBridgeKinds] = {};
  double shrunk = 0.0;
  RepeatedSettings repeated;
  int bodies = 0;
  double largest_radius = 0.0; ///< [um]
  std::vector<BreakEvent> events;

  void write(FILE *fp) const;
  /// Stops the run, with a message that names the fix `owner`, if another version wrote it.
  void read(const char *buf, class Error *error, class Fix *owner);

private:
  template <class Visit> static void for_each_value(BondRecord &record, Visit visit);
};

} // namespace LAMMPS_NS

#endif
