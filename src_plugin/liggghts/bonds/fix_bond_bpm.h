// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all bond/bpm bodies FILE youngs_modulus E nu NU radius_ratio L tensile S shear T
//     criterion signed|unsigned|as_printed damping D weibull M SEED breakable yes|no log FILE
//     pressure PLATEN_FIX contact_diameter D surface_inset S inset_fading F LAW NUMBERS ...
// fix_modify ID LAW NUMBERS ...       with a further law of strength, see laws/bond_laws.h
// fix_modify ID bridges E NU L GAP S_AM S_CBD S_COLLECTOR RATIO
// fix_modify ID shrinkage EPS T
//
// Keeps positions and periodic sides on a grid on which shifts by a side are exact: both copies of
// a pair then do the same arithmetic, and find the same breaks, whichever ranks hold them. Owns the
// bonds of `pair_style gran ... cohesion bpm surface bpm`: their material, their creation (at the
// first set-up after the fix appears, between touching primaries of one body, once), the breaks,
// and the event log. Every copy of a pair breaks in the same step, without communication; the
// rank that owns the lower tag records the event, and events are gathered on
// request, at the latest after 100 steps. Contacts begin at a centre distance:
//   two spheres with a bond, or not apart since       its length at creation
//     it broke
//   two primaries of one body, never bonded or        D times the sum of their radii (default 1)
//     apart since their bond broke
//   any other two spheres                             the sum of their radii, less for a primary
//                                                     of a body the inset S [um] (default 0) times
//                                                     1 - F times the part of its bonds broken
//   a sphere and a wall                               its radius
// All stresses in kPa (units micro). Everything restarts, under the same fix ID. Bridges
// (physics/binder_bridge.h) of modulus E, radius ratio L and tensile strengths S between CBD and
// AM, CBD, collector (types as in laws/phases.h) are made with the bonds and damped as they
// are; the script gives them again after a restart. No bond of a body and nothing of bodies counts
// them. In the time T [us] from their creation they shrink by EPS (physics/drying_shrinkage.h); a
// restart with another EPS, T, D, S or F is refused. Global vector: 1-9 as compute bond/bpm; bridges
// made 10 to AM 11 to CBD 12 to the collector; broken 13 14 15; 16 their strain energy, 17 that
// released by breaks [fJ]; 18 how far they have shrunk [-].
#ifdef FIX_CLASS

FixStyle(bond/bpm, FixBondBpm)

#else
#ifndef LMP_FIX_BOND_BPM_H
#define LMP_FIX_BOND_BPM_H

#include "body_atoms.h"
#include "body_map.h"
#include "bond_events.h"
#include "bond_record.h"
#include "bond_watch.h"
#include "break_log.h"
#include "fix.h"
#include "position_grid.h"
#include "sphere_bridges.h"
#include "surface_insets.h"
#include <algorithm>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class FixBondBpm : public Fix, public BondEvents {
public:
  FixBondBpm(class LAMMPS *, int, char **);
  ~FixBondBpm();
  int setmask();
  void post_create();
  int modify_param(int narg, char **arg);
  void init();
  void setup_pre_exchange();
  void setup_pre_force(int);
  void setup(int);
  void pre_force(int);
  void post_integrate();
  void post_run();
  void post_force(int);
  double compute_vector(int);
  double memory_usage();

  void grow_arrays(int nmax) { atoms_.grow_arrays(nmax); }
  void copy_arrays(int i, int j, int) { atoms_.copy_arrays(i, j); }
  void set_arrays(int);
  int pack_exchange(int i, double *buf) { return atoms_.pack_exchange(i, buf); }
  int unpack_exchange(int nlocal, double *buf) { return atoms_.unpack_exchange(nlocal, buf); }
  int pack_restart(int i, double *buf) { return atoms_.pack_restart(i, buf); }
  void unpack_restart(int nlocal, int nth) { atoms_.unpack_restart(nlocal, nth); }
  int size_restart(int) { return BodyAtoms::kRestartSize; }
  int maxsize_restart() { return BodyAtoms::kRestartSize; }
  int pack_comm(int, int *, double *, int, int *);
  void unpack_comm(int, int, double *);
  void write_restart(FILE *);
  void restart(char *);

  /// The one fix bond/bpm of the run; an error that names `caller` if there is none or several.
  static FixBondBpm *find(class LAMMPS *lmp, const char *caller);

  // BondEvents
  BondPairs &pairs() { return pairs_; }
  const BondSettings &settings() const { return settings_; }
  const BondSettings &bridge_settings() const { return bridges_.settings(); }
  bool shrinks() const { return bridges_.shrinks(); }
  bool creating() const { return creating_; }
  void make_bond(int i, int j, double r, BondHistory &bond) const;
  void make_bridge(int i, int j, double r, BondHistory &bond) const {
    bridges_.make(i, j, r, bond);
  }
  void mark_separated(int i, int j, BondHistory &bond) const;
  void record_break(int i, int j, BondHistory bond, const calendem::BondPair &,
                    const calendem::BondLoads &);
  void check_stretch(double stretch) { watch_.check_stretch(stretch); }
  void count_acting(bigint bonds) { watch_.count_acting(bonds); }
  void report_overflow(int tag) { overflowed_ = tag; }
  double largest_radius(double now) { return largest_radius_ = std::max(largest_radius_, now); }

  const PositionGrid &grid() const { return grid_; }
  SphereBridges &bridges() { return bridges_; }
  /// Radii of this rank's atoms and of ghosts are other ones.
  void radii_have_changed();
  /// The bridge of atom i of this rank on the collector breaks; its energy in fJ.
  void bridge_breaks_on_wall(int i, double energy);

  // for computes and dumps
  int body(int i) const { return atoms_.body(i); }
  /// Highest number of a body, whether its spheres are still there or not.
  int bodies() const { return bodies_; }
  int broken_of(int i) const { return atoms_.broken(i); }
  /// All so far; all ranks must call.
  const std::vector<BreakEvent> &breaks() {
    log_.gather();
    return log_.events();
  }

private:
  /// A copy of a bond that fails in this step.
  struct Break {
    int i, j;
    BondHistory bond;
    BreakEvent event;
  };

  BondSettings settings_;
  BondPairs pairs_;
  PositionGrid grid_;
  BodyMap map_;
  BodyAtoms atoms_;
  SurfaceInsets insets_;
  SphereBridges bridges_;
  BondWatch watch_;
  BreakLog log_;
  std::string bodies_file_, log_file_, platen_id_;
  class WorkLedger *ledger_ = nullptr; // NULL when none is kept
  class FixTimeBpm *time_ = nullptr;
  int bodies_ = 0;
  bool created_ = false, creating_ = false, restarted_ = false;
  bigint initial_ = 0;
  RepeatedSettings earlier_;    // of the run that goes on
  std::vector<Break> failing_;  // of this step
  int overflowed_ = 0;          // tag of an atom whose forces are beyond the units of their sum
  double largest_radius_ = 0.0; // from which these units follow [um]

  bool are_to_bond(int i, int j, double r, const BondHistory &bond) const;
  void refuse_styles();
  void check_bridges();
  void check_radii();
  RepeatedSettings settings_to_repeat() const;
  double meeting_distance(int i, int j) const;
  bigint acting_pairs() const;
  void stop_if_wrong();
  void stop_if_overflowed();
  void apply_breaks();
  double platen_pressure() const;
};

} // namespace LAMMPS_NS

#endif
#endif
