// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all bond/bpm bodies FILE youngs_modulus E nu NU radius_ratio L tensile S shear T
//     criterion signed|unsigned|as_printed damping D weibull M SEED breakable yes|no log FILE
//     pressure PLATEN_FIX contact_diameter D surface_inset S inset_fading F LAW NUMBERS ...
// fix_modify ID LAW NUMBERS ...       with a further law of strength, see registry/bond_strengths.h
// fix_modify ID bridges E NU L GAP S_AM S_CBD S_COLLECTOR RATIO
// fix_modify ID shrinkage EPS T
//
// Keeps positions and periodic sides on a grid on which shifts by a side are exact: both copies of
// a pair then do the same arithmetic, and find the same breaks, whichever ranks hold them. Owns the
// bonds of `pair_style gran ... cohesion bpm surface bpm`: their material, their creation (at the
// first set-up after the fix appears, between touching primaries of one body, once), the breaks,
// and the event log. Every copy of a pair breaks in the same step, without communication; the
// rank that owns the lower tag records the event, and events are gathered on
// request, at the latest after 100 steps. Two primaries of one body that are not bonded, nor have
// touched since their bond broke, meet at D times the sum of their radii, 1 by default. For all
// other spheres, but not for walls, the surface of a body's primary lies S [um] inside it, 0 by
// default, and by the part F times the part of its bonds that is broken less; not with bridges. All
// stresses in kPa (units micro). Everything restarts, under the same fix ID. Bridges
// (physics/binder_bridge.h) of modulus E, radius ratio L and tensile strengths S between CBD and
// AM, CBD, collector (types as in registry/phases.h) are made with the bonds and damped as they
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

#include "bond_bpm_history.h"
#include "fix.h"
#include "physics/binder_bridge.h"
#include "physics/bond_pair.h"
#include "physics/drying_shrinkage.h"
#include "registry/bond_strengths.h"
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// What the user sets for all bonds; stresses in kPa.
struct BondSettings {
  calendem::BondMaterial material;
  calendem::BondStrength strength = {0.0, 0.0};
  calendem::FailureCriterion criterion = calendem::FailureCriterion::Signed;
  calendem::BondStrengths strengths; ///< from bond to bond
  bool breakable = true;
  double contact_diameter = 1.0; ///< of a body's primaries that meet, over the sum of radii
  double surface_inset = 0.0;    ///< how far inside a primary its surface is for others [um]
  double inset_fading = 0.0;     ///< part of it that goes as the primary's bonds break

  calendem::BondStrength strength_of(double factor) const {
    return {factor * strength.tensile, factor * strength.shear};
  }
};

/// One broken bond; the same list on every rank, ordered by step, then tags. Plain doubles, so that
/// it travels through MPI and restart files as it is. Of a bridge: `mode` is its kind, `body` -1,
/// and `tag_low` 0 on the collector; it is counted and not kept.
struct BreakEvent {
  double time, tag_low, tag_high, body, mode, sigma, tau, x, y, z, pressure, energy;

  bool operator<(const BreakEvent &o) const {
    return time != o.time         ? time < o.time
           : tag_low != o.tag_low ? tag_low < o.tag_low
                                  : tag_high < o.tag_high;
  }
  bool of_bridge() const { return body < 0.0; }
};

class FixBondBpm : public Fix {
public:
  FixBondBpm(class LAMMPS *, int, char **);
  ~FixBondBpm();
  int setmask();
  int modify_param(int narg, char **arg);
  void init();
  void setup_pre_exchange();
  void pre_exchange();
  void setup_pre_force(int);
  void setup(int);
  void pre_force(int);
  void post_integrate();
  void post_run();
  void post_force(int);
  void end_of_step();
  double compute_vector(int);
  double memory_usage();

  void grow_arrays(int);
  void copy_arrays(int, int, int);
  void set_arrays(int);
  int pack_exchange(int, double *);
  int unpack_exchange(int, double *);
  int pack_comm(int, int *, double *, int, int *);
  void unpack_comm(int, int, double *);
  int pack_restart(int, double *);
  void unpack_restart(int, int);
  int size_restart(int) { return 3; }
  int maxsize_restart() { return 3; }
  void write_restart(FILE *);
  void restart(char *);

  /// The one fix bond/bpm of the run; an error that names `caller` if there is none or several.
  static FixBondBpm *find(class LAMMPS *lmp, const char *caller);

  /// Of the grid of positions along axis k [um], 0 along a side that is not periodic.
  double spacing(int k) const { return spacing_[k]; }

  // for the contact models, per pair and step
  const BondSettings &settings() const { return settings_; }
  const BondSettings &bridge_settings() const { return bridge_settings_; }
  const BondSettings &settings_of(const BondHistory &bond) const {
    return bond.state() == kBridge ? bridge_settings_ : settings_;
  }
  /// The pair's bond or bridge where its spheres stand now.
  calendem::BondPair pair_of(int i, int j, const BondHistory &bond) const;
  const calendem::BinderBridges &bridges() const { return bridges_; }
  /// By how much of their length at creation bridges have shrunk in this step, and whether they do
  /// in this or the next one.
  double shrinking() const { return shrinking_; }
  bool shrinks() const { return shrinkage_.strain > 0.0 && (shrunk_ < 1.0 || shrinking_ > 0.0); }
  bool creating() const { return creating_; }
  void create(int i, int j, double r, BondHistory &bond) const;
  /// The spheres of a broken pair have separated, or were bridged.
  void separate(int i, int j, BondHistory &bond) const;
  void bridge(int i, int j, double r, BondHistory &bond) const;
  /// On the collector: all that were made; one of this rank has broken.
  void bridges_made_on_wall(bigint n) {
    bridges_made_[int(calendem::BridgeKind::CbdCollector)] = n;
  }
  void bridge_breaks_on_wall(int i, double energy);
  void record_break(int i, int j, BondHistory bond, const calendem::BondPair &,
                    const calendem::BondLoads &);
  void check_stretch(double stretch) {
    if (stretch > kStretchLimit && overstretched_ == 0.0)
      overstretched_ = stretch;
  }
  void acts(int i, int j) { acting_ += decides(i, j); }
  void count_acting(bigint bonds) { acting_ += bonds; }
  void force_overflows(int tag) { overflowed_ = tag; }
  int friction_history_offset(int bond_offset);
  /// Who keeps values of histories from step to step, NULL for nobody.
  void set_loop(class BpmPairLoop *loop) { loop_ = loop; }

  // Neighbours are listed, and histories kept, up to this multiple of the sum of radii. 1.1 is
  // ample for brittle bonds; 1.2 would list the lattice's diagonal neighbours.
  static constexpr double kContactDistanceFactor = 1.1;
  static constexpr double kStretchLimit = 0.98 * kContactDistanceFactor;

  // for computes and dumps
  int body(int i) const { return body_[i]; }
  int broken_of(int i) const { return broken_[i]; }
  /// All so far; all ranks must call.
  const std::vector<BreakEvent> &breaks() {
    gather_breaks();
    return breaks_;
  }
  bigint initial() const { return initial_; }
  /// Calls visit(i, j, history) for every intact bond, each once over all ranks.
  template <class Visit> void for_each_intact(Visit visit);
  /// The same for every copy on this rank: each local atom meets all its bonds.
  template <class Visit> void for_each_copy(Visit visit);
  /// The same with bridges between spheres.
  template <class Visit> void for_each_acting_copy(Visit visit);
  /// Calls visit(i, j, r, history) for every pair whose spheres overlap, each once over all ranks.
  template <class Visit> void for_each_touching(Visit visit);
  /// The same for every copy on this rank.
  template <class Visit> void for_each_touching_copy(Visit visit);
  /// True on the rank (and copy) that counts the pair and decides its fate.
  bool decides(int i, int j) const;

private:
  BondSettings settings_, bridge_settings_; // of a bridge the strength's factor is sigma_c
  calendem::BinderBridges bridges_;
  calendem::DryingShrinkage shrinkage_;
  double shrunk_ = 0.0, shrinking_ = 0.0; // of `shrinkage_`; in this step, of the length
  bool restarted_ = false;
  std::array<double, 5> earlier_ = {}; // what remembered() was in the run that goes on
  class FixEnergyBpm *energy_;         // NULL when no ledger is kept
  std::string bodies_file_, log_file_, platen_id_;
  std::vector<int> body_of_tag_;        // from the body map; empty after a restart
  std::map<int, double> body_diameter_; // of the sphere of the primaries' volume; likewise
  int *body_, *broken_;
  int history_offset_;
  class BpmPairLoop *loop_ = nullptr;
  bool created_, creating_, log_ready_;
  bigint initial_;
  bigint by_mode_[5];
  double energy_lost_;
  std::vector<double> inset_; // of spheres and ghosts [um], found when neighbours are listed
  bigint bridges_made_[calendem::kBridgeKinds], bridges_broken_[calendem::kBridgeKinds];
  double bridge_energy_lost_;
  /// A setting that a restart has to repeat.
  struct Remembered {
    const char *name;
    double value;
  };
  /// A copy of a bond that fails in this step.
  struct Break {
    int i, j;
    BondHistory bond;
    BreakEvent event;
  };
  std::vector<Break> failing_;     // of this step
  std::vector<BreakEvent> mine_;   // decided here since the last gathering
  std::vector<BreakEvent> breaks_; // gathered
  double overstretched_;           // the first stretch beyond the limit, 0 if none
  int overflowed_ = 0;             // tag of an atom whose forces are beyond the units of their sum
  // intact bonds and bridges that this rank decides: acted in this step; are there; did not act
  // when they had to
  bigint acting_, expected_, missing_;
  double spacing_[3]; // of the grid of positions, 0 along sides that are not periodic

  void parse(int narg, char **arg);
  int parse_keyword(int iarg, int narg, char **arg);
  int parse_strength(int narg, char **arg);
  int parse_bridges(int narg, char **arg);
  int parse_shrinkage(int narg, char **arg);
  std::array<Remembered, 5> remembered() const;
  void check_remembered();
  void check_shrinkage();
  void shrink(double dt);
  void check_bridges();
  void check_radii();
  calendem::BridgeKind kind_of_bridge(int i, int j) const;
  void count_bridges(bigint *of_kind);
  void count_bridges_made();
  void check_bridges_add_up();
  bigint acting_pairs() const;
  double bridge_vector(int n);
  double strain_energy_of(BondState state);
  double not_into_contact(int i, int j, double before, double length) const;
  void find_insets();
  void check_settings();
  void check_modulus(const char *what, double value);
  void pair_error(const char *what, double value, int i, int j, const char *why);
  const double *property(const char *name, const char *kind, int pairs_of);
  void check_materials();
  void check_collapse(int i, int j, double ced, double effective_modulus);
  void read_bodies();
  void measure_bodies();
  void check_box();
  double meeting_distance(int i, int j) const;
  bigint count_intact();
  bool copies_agree();
  bigint broken() const;
  template <class Visit> void for_each_neighbor(Visit visit);
  void store_histories();
  void choose_grid();
  void put_on_grid();
  void check_acting(bool new_lists);
  void stop_if_wrong();
  void stop_if_overflowed();
  void apply_breaks();
  void gather_breaks();
  void open_log();
  double platen_pressure() const;
  void log_breaks(const std::vector<BreakEvent> &all);
  void stop_overstretched(double stretch);
  void stop_lost(bigint acting, bigint intact);
};

} // namespace LAMMPS_NS

#include "fix_bond_bpm_inline.h"

#endif
#endif
