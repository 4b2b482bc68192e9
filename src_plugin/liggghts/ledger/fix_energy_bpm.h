// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all energy/bpm
//
// Where the work of the platens goes. Elastic energies are summed over the pairs on request;
// dissipated work is summed every step with the trapezoid that the integrator itself exchanges
// kinetic energy by: over the step from x(n) to x(n+1) a force does the work
// (F(n) + F(n+1))/2 . (x(n+1) - x(n)). So work of the platens = change of kinetic energy, bond
// strain and terms 1-2, plus terms 3-8, less term 9, plus what fix bond/bpm counts as released by
// breaks; what is left over is the error of the conservative forces over a step and the work of
// gravity.
// Global vector [fJ]: 1 elastic energy of the Hertz contacts, walls included, 2 potential of SJKR
//   (<= 0), walls included, 3 dissipated by normal damping of contacts and by damping of bonds, 4
//   work against the tangential contact forces: slip, their damping, and what their springs hold at
//   the moment, 5 lost in breaks beyond the bonds' strain energy: the potential of the cohesion
//   that begins to act, and the last half step of the bond's force, 6 taken by plastic flow in
//   contacts, 7 by collapsing spheres, 8 by the dashpots of viscous contacts, 9 put in by binder
//   bridges that shrink: to be set against the others.
// Where the cell elongates, the work of fix elongation is beside that of the platens.
// Needs `pair_style gran model hertz|hertz_effects ... cohesion bpm surface bpm`; stands behind all
// fixes wall/gran/platen, the walls it knows; of their cohesion it knows `sjkr`. Sums restart under
// the same fix ID.
#ifdef FIX_CLASS

FixStyle(energy/bpm, FixEnergyBpm)

#else
#ifndef LMP_FIX_ENERGY_BPM_H
#define LMP_FIX_ENERGY_BPM_H

#include "atom.h"
#include "contact_effects.h"
#include "fix.h"
#include "physics/web_elongation.h"
#include "work_ledger.h"
#include <vector>

namespace LAMMPS_NS {

class FixEnergyBpm : public Fix, public WorkLedger {
public:
  FixEnergyBpm(class LAMMPS *, int, char **);
  ~FixEnergyBpm();
  int setmask();
  void post_create();
  void init();
  void setup_pre_force(int);
  void setup(int);
  void post_integrate();
  void pre_force(int);
  void post_force(int);
  double compute_vector(int);
  double memory_usage();
  void grow_arrays(int);
  void write_restart(FILE *);
  void restart(char *);

  /// The fix of the run, NULL if there is none.
  static FixEnergyBpm *find(class LAMMPS *lmp);

  using WorkLedger::add_shrinking;
  using WorkLedger::add_taken;
  void add_taken(int i, int j, double work, calendem::WorkTaken term);
  void add_shrinking(int i, int j, double work);
  void bond_breaks(int i, int j, const BondHistory &bond);

  /// Energy [fJ] in this rank's contacts, elastic and cohesive: before and after radii change.
  double stored_in_contacts() const;
  void add_collapse(double work) { sums_[kCollapse] += work; }

private:
  struct Wall {
    class FixWallGranPlaten *fix;
    bool sticks;
    double damping;  ///< sum of the damping forces along z on this rank's atoms [nN]
    double friction; ///< and of the friction along x
  };

  class FixBondBpm *bonds_;
  class CellGrowth *cell_; // NULL: it keeps its sides
  ContactEffects effects_;
  bool pairs_have_effects_;
  double **cohesion_energy_density_; // by type pair, from the host
  std::vector<Wall> walls_;
  double last_moment_; // of the bonds that have just broken

  void find_walls();
  void collect_walls();
  void collect(Wall &wall, int i, const double *force);
  void add_half_step();
  void add_half_elongation(double (calendem::ElongationStep::*work)(double) const);
  double work_in_half_step(const ForceAndTorque &a, int i) const;
  double cohesion(int i, int j, double r) const;
  double pair_energy(bool of_cohesion) const;
  double wall_cohesion(const Wall &wall, int i) const;
  double wall_energy(bool of_cohesion) const;
};

} // namespace LAMMPS_NS

#endif
#endif
