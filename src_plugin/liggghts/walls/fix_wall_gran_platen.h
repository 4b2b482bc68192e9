// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all wall/gran/platen model hertz tangential history primitive type T zplane Z
//     side top|bottom motion hold bridges yes|no
//     side top motion pressure P | position Z2  touch_speed V load_speed V release_speed V
//          touch_pressure P wait T dwell T ramp T passes N first P spacing step|ratio lost F lowest Z average T
//          compliance C release yes|no
//     side top motion roll GAP roll_radius R counter_radius R2 slip S
//          touch_speed V load_speed V release_speed V ... as above
//
// A flat wall of fix wall/gran that moves along z by the programme of physics/platen_motion.h and
// measures what it carries; it rests at Z until the time `wait` and goes N times. All contact models of fix wall/gran can be used. Units micro.
// motion roll: as a roll passes over, with GAP in the nip (physics/roll_nip.h); lengths in um, R2
// 0: flat; S moves the surface along x; the first of N passes goes to `first`
// (a gap, or a pressure), the others by equal steps or ratios to the last; 0: all alike. load_speed is
// the largest speed of closing and of slip. Global vector: 1 stage (0 hold, 1 compression, 2 dwell,
// 3 relaxation, 4 done), 2 position,
//   3 displacement (> 0 down), 4 load [nN], 5 pressure averaged over `average` [kPa], 6 pressure
//   now, 7 work done on the particles [fJ], 8 closing speed, 9 largest averaged pressure, 10 target
//   reached, 11 1 when the dwell is over and `release no` holds the platen, 12 averaging window
//   [us], 13 position averaged as 5 is: what the averaged pressure is compared with, 14 passes
//   that are still to come, 15 speed of the surface along x. At stage 4, 5 and 13 stay those at
//   which contact was lost.
// bridges yes: the wall holds CBD by the binder bridges of fix bond/bpm, which stands before it.
// The machine shows a position that is `compliance` [um/kPa] times the pressure further down.
// Load is positive when the wall presses the film. State restarts under the same fix ID.
#ifdef FIX_CLASS

FixStyle(wall/gran/platen, FixWallGranPlaten)

#else
#ifndef LMP_FIX_WALL_GRAN_PLATEN_H
#define LMP_FIX_WALL_GRAN_PLATEN_H

#include "fix_wall_gran.h"
#include "physics/contact_pair.h"
#include "physics/fixed_point.h"
#include "physics/moving_average.h"
#include "physics/platen_motion.h"
#include "wall_bridges.h"
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Parts the command into what fix wall/gran understands and what the platen adds.
class PlatenArguments {
public:
  PlatenArguments(int narg, char **arg);

protected:
  std::vector<char *> host_;
  std::vector<std::string> own_;
};

class FixWallGranPlaten : private PlatenArguments, public FixWallGran {
public:
  FixWallGranPlaten(class LAMMPS *, int, char **);
  int setmask();
  void post_create();
  void pre_delete(bool);
  void init();
  void reset_dt() { set_window(); }
  void setup_pre_force(int);
  void setup(int);
  void initial_integrate(int);
  void pre_force(int);
  void post_force(int);
  double compute_vector(int);
  void write_restart(FILE *);
  void restart(char *);

  /// The platens and collectors of the script, in its order.
  static std::vector<FixWallGranPlaten *> all(const class Modify &modify);

  double position() const { return record_.state.position; }
  /// How atom i touches this wall.
  calendem::WallContact contact(int i) const;
  double start() const { return programme_.start; }
  bool rolls() const { return programme_.control == calendem::PlatenControl::Roll; }
  double last_gap() const { return programme_.target; } ///< of the last pass of a roll
  /// Over the window of pressure(), with its weights.
  double mean_position() const;
  double mean_displacement() const { return programme_.start - mean_position(); } ///< > 0 down
  double velocity() const { return -record_.state.speed; } ///< along z [um/us]
  double sliding() const { return sliding_; }              ///< along x [um/us]
  double pressure() const { return record_.average.value(); }
  double largest_pressure() const { return record_.state.max_pressure; } ///< of the averaged ones
  bool is_top() const { return sign_ < 0.0; }
  bool sticks() { return contact_match("cohesion", "sjkr"); }
  bool has_effects() const { return memory_offset_ >= 0; } ///< model hertz_effects
  /// Memory of atom i's contact under `model hertz_effects`, NULL under another model.
  const double *effect_memory(int i) const;

private:
  /// All that restarts. `load`, `block` and `work` are this rank's share; the sum over ranks
  /// restarts.
  struct Record {
    calendem::PlatenState state;
    calendem::MovingAverage average; ///< of the pressure
    calendem::MovingAverage height;  ///< of the position
    calendem::WideSum load;          ///< the same on any number of ranks
    calendem::WideSum block;         ///< of the loads since the average's last block
    double work = 0.0;
    double drag = 0.0; ///< force along x on this rank's particles
  };

  calendem::PlatenProgramme programme_;
  Record record_;
  double sign_; // of the wall's load against the force on the particles: -1 top, +1 bottom
  double window_;
  bool may_release_;
  bool moved_;
  double sliding_;
  class FixTimeBpm *time_ = nullptr;
  int memory_offset_; // -1: another model
  std::unique_ptr<WallBridges> bridges_;

  void parse();
  void set_keyword(const std::string &key, const std::string &value);
  bool set_bridges(const std::string &key, const std::string &value);
  bool set_number(const std::string &key, const std::string &value);
  bool set_roll_keyword(const std::string &key, const std::string &value);
  void check_roll();
  void set_window();
  void place_wall();
  bool slides() const;
  void measure();
  void measure_drag();
  double area() const;
  calendem::WideSum load_of_rank() const;
  calendem::WideSum over_ranks(const calendem::WideSum &sum) const;
  void add_up(Record &record) const;
  void keep_share();
};

} // namespace LAMMPS_NS

#endif
#endif
