// SPDX-License-Identifier: GPL-2.0-or-later
// All forces of `pair_style gran model hertz|hertz_effects tangential history cohesion bpm surface
// bpm` in one pass over the neighbours: Hertz-Mindlin, SJKR, bonds, effects. Pairs are sorted by
// kind into tiles, the laws of physics/ run over a tile at a time, and forces are summed as whole
// numbers: they are the same on any number of ranks. The host's loop over its contact objects is
// the reference, with the same arithmetic for every pair; it serves where this one does not.
#ifndef CALENDEM_BPM_PAIR_LOOP_H
#define CALENDEM_BPM_PAIR_LOOP_H

#include "contact_effects.h"
#include "pair_tile.h"
#include "pointers.h"
#include <memory>
#include <vector>

namespace LAMMPS_NS {

/// What the laws need of an atom beside its place: one line of the cache.
struct alignas(64) Sphere {
  double v[3], omega[3], radius, mass;
};

/// Sums of forces and torques on an atom, in units of a FixedPoint; unsigned, as they may pass
/// through numbers that are too large on their way.
struct alignas(64) WholeForce {
  unsigned long long sum[6];
};

/// Of a pair of atom types.
struct PairMaterial {
  double modulus, shear_modulus, damping, friction, cohesion;
};

class BpmPairLoop : protected Pointers {
public:
  explicit BpmPairLoop(class LAMMPS *lmp) : Pointers(lmp) {}

  /// Offsets of the bond and of the effects' memory in a pair's history; the latter -1 without.
  void connect(int bond_offset, int effects_offset);

  /// True if this call can be served: not where the host writes down single contacts, or treats
  /// some atoms in a way of its own.
  bool serves(class PairGran *pair) const;
  void compute_force(class PairGran *pair);

private:
  /// A pressed bond touches as well; a bridge is a contact, or apart, beside.
  enum Kind { kBond, kPressedBond, kContact, kBridged, kApart, kKinds };

  /// Two spheres within the range of histories.
  struct Pair {
    int i, j, kind, at; // at: in the tile of its kind
    double *history;
    int *flags;
    double r_squared;
    calendem::Vec3 d;
  };

  class FixBondBpm *fix_ = nullptr;
  class FixEnergyBpm *energy_ = nullptr; // NULL when no ledger is kept
  ContactEffects effects_;
  double **friction_ = nullptr, **cohesion_ = nullptr;
  double **modulus_ = nullptr, **shear_modulus_ = nullptr, **damping_ = nullptr;
  std::vector<PairMaterial> materials_; // of atom types a, b at a * types_ + b
  int types_ = 0;
  int bond_ = 0, memory_ = -1, spring_ = -1;             // offsets in the history
  std::vector<Sphere> spheres_;                          // atoms and ghosts in this step
  std::vector<WholeForce> forces_;                       // on them
  calendem::FixedPoint force_unit_, torque_unit_;        // of these [nN], [nN um]
  std::vector<double> dx_, dy_, dz_, r_squared_, limit_; // of the neighbours of one atom
  std::vector<int> near_;
  std::unique_ptr<PairTile[]> tiles_; // one of each kind but kApart
  Pair pairs_[kTilePairs];            // as they come
  int found_ = 0;
  int of_kind_[kKinds][kTilePairs], count_[kKinds];
  bool update_ = true; // histories advance: not during set-up
  bigint acting_ = 0;  // intact bonds of this step, each once over all ranks

  void copy_materials();
  void copy_spheres();
  int find_near(int i, const int *neighbors, int count, double factor_squared);
  void work_off();
  void sort();
  void sort_bridges();
  const struct BondSettings &settings_of(Kind kind) const;
  void leave(const Pair &pair) const;
  void fill(Kind kind);
  void put_spheres(PairTile &tile, int p, const Pair &pair) const;
  void put_bond(PairTile &tile, int p, const Pair &pair) const;
  void put_contact(PairTile &tile, int p, const Pair &pair) const;
  void act_effects();
  void keep_bonds(Kind kind);
  void keep_contacts(Kind kind);
  void choose_units();
  void sum_forces(Kind kind);
  void add_forces(class PairGran *pair);
  void stop_force(int i) const;
  void book();
};

} // namespace LAMMPS_NS

#endif
