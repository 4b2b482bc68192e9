// SPDX-License-Identifier: GPL-2.0-or-later
// The event log of broken bonds: gathered from all ranks, counted by mode, and written. The same on
// every rank, ordered by step, then tags.
#ifndef CALENDEM_BREAK_LOG_H
#define CALENDEM_BREAK_LOG_H

#include "physics/binder_bridge.h"
#include "pointers.h"
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// One broken bond. Plain doubles, so that it travels through MPI and restart files as it is. Of a
/// bridge: `mode` is its kind, `body` -1, and `tag_low` 0 on the collector; it is counted and not
/// kept. Time in us, stresses and pressure in kPa, places in um, energy in fJ.
struct BreakEvent {
  double time, tag_low, tag_high, body, mode, sigma, tau, x, y, z, pressure, energy;

  bool operator<(const BreakEvent &o) const {
    return time != o.time         ? time < o.time
           : tag_low != o.tag_low ? tag_low < o.tag_low
                                  : tag_high < o.tag_high;
  }
  bool of_bridge() const { return body < 0.0; }
};

/// Counts and energies of all breaks that have been gathered.
struct BreakTotals {
  bigint of_mode[5] = {}; ///< by calendem::BreakMode
  double energy = 0.0;    ///< released by breaks [fJ]
  bigint of_bridges[calendem::kBridgeKinds] = {};
  double bridge_energy = 0.0; ///< [fJ]

  bigint broken() const { return of_mode[1] + of_mode[2] + of_mode[3] + of_mode[4]; }
};

class BreakLog : protected Pointers {
public:
  /// Messages name the fix `owner`.
  BreakLog(class LAMMPS *lmp, class Fix *owner) : Pointers(lmp), owner_(owner) {}

  /// Rewrites the file from memory, so that after a restart it holds exactly the breaks up to that
  /// moment. Does nothing the second time; "": there is no file.
  void open(const std::string &file);
  /// A break that this rank decides.
  void add(const BreakEvent &event) { mine_.push_back(event); }
  /// Bonds and bridges between spheres among those that have not been gathered yet.
  bigint waiting() const;
  /// Brings the ranks' events together; all ranks call.
  void gather();
  const BreakTotals &totals() const { return totals_; }
  const std::vector<BreakEvent> &events() const { return events_; }
  void restart(const BreakTotals &totals, const std::vector<BreakEvent> &events) {
    totals_ = totals;
    events_ = events;
  }
  double memory_usage() const { return events_.capacity() * sizeof(BreakEvent); }

private:
  class Fix *owner_;
  std::string file_;
  bool opened_ = false;
  std::vector<BreakEvent> mine_;   // decided here since the last gathering
  std::vector<BreakEvent> events_; // gathered
  BreakTotals totals_;

  void write(const std::vector<BreakEvent> &events);
};

} // namespace LAMMPS_NS

#endif
