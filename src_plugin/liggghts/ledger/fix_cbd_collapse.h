// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all cbd/collapse type T initial PHI floor PHI yield P hardening H relaxation TIME every N
// fix ID all cbd/collapse type T initial PHI floor PHI imposed P relaxation TIME every N
//
// Nanopores of the spheres of atom type T collapse under the mean pressure of their contacts by
// physics/nanopore_collapse.h: every N steps (default 50), after the step, their radii shrink and
// their densities grow at constant mass; ghosts follow at once. The pressure is that of the forces
// which contacts exert, cohesion included (physics/acting_contact.h); bonds and bridges beside them
// are not counted. Units micro: pressures in kPa, times in us. Contacts with walls are those with
// fixes wall/gran/platen. Defaults: initial 0.5, floor 0.27, relaxation 0.1. Needs fix bond/bpm
// (for its lists); books in fix energy/bpm if there is one. `imposed`: all fall alike, to the floor
// as the largest pressure of the upper fix wall/gran/platen rises to P. Global vector: 1 mean
// nanoporosity, 2 lowest, 3 largest mean pressure of a sphere at the last update [kPa], 4 volume
// that has gone [um3]. State restarts under the same fix ID.
#ifdef FIX_CLASS

FixStyle(cbd/collapse, FixCbdCollapse)

#else
#ifndef LMP_FIX_CBD_COLLAPSE_H
#define LMP_FIX_CBD_COLLAPSE_H

#include "contact_effects.h"
#include "fix.h"
#include "physics/fixed_point.h"
#include "physics/nanopore_collapse.h"
#include "physics/time_count.h"
#include <string>
#include <vector>

namespace LAMMPS_NS {

class FixCbdCollapse : public Fix {
public:
  FixCbdCollapse(class LAMMPS *, int, char **);
  ~FixCbdCollapse();
  int setmask();
  void post_create();
  void init();
  void reset_dt();
  void reset_timestep(bigint newstep, bigint oldstep);
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

private:
  calendem::NanoporeCollapse law_;
  calendem::TimeCount since_; // the last update
  int type_;
  double imposed_until_;                   // 0: the spheres' own law [kPa]
  double *nanoporosity_, *initial_radius_; // of atoms of other types: unused
  double largest_pressure_;                // this rank's, at the last update
  double **cohesion_energy_density_;
  ContactEffects effects_;
  bool pairs_have_effects_;
  class FixBondBpm *bonds_;
  class FixEnergyBpm *energy_; // NULL when no ledger is kept
  std::vector<class FixWallGranPlaten *> walls_;
  class FixWallGranPlaten *upper_; // NULL: there is none

  void parse(int narg, char **arg);
  void check();
  bool is_mine(int i) const;
  void add_pair_forces(std::vector<calendem::WideSum> &sum) const;
  void add_wall_forces(std::vector<calendem::WideSum> &sum) const;
  void stop_no_number(int i);
  bool decide(const std::vector<calendem::WideSum> &sum, std::vector<double> &next);
  void shrink(const std::vector<double> &next);
  double rotational_energy() const;
};

} // namespace LAMMPS_NS

#endif
#endif
