// SPDX-License-Identifier: GPL-2.0-or-later
// All forces of `pair_style gran model hertz|hertz_effects tangential history cohesion bpm surface
// bpm` in one pass over the pairs: Hertz-Mindlin, SJKR, bonds, effects. Pairs stay in the tiles of
// pair_table.h, the laws of physics/ run over a tile at a time, and forces are summed as whole
// numbers: they are the same on any number of ranks. The host's loop over its contact objects is
// the reference, with the same arithmetic for every pair; it serves where this one does not.
#ifndef CALENDEM_BPM_PAIR_LOOP_H
#define CALENDEM_BPM_PAIR_LOOP_H

#include "bond_events.h"
#include "contact_effects.h"
#include "force_sums.h"
#include "known_types.h"
#include "pair_table.h"
#include "pair_tile.h"
#include "pointers.h"
#include <memory>
#include <vector>

namespace LAMMPS_NS {

/// What the laws need of an atom beside its place: one line of the cache.
struct alignas(64) Sphere {
  double v[3], omega[3], radius, mass;
};

class BpmPairLoop : protected Pointers, public PairLoop {
public:
  explicit BpmPairLoop(class LAMMPS *lmp);
  ~BpmPairLoop();

  /// Offsets of the bond and of the effects' memory in a pair's history; the latter -1 without.
  void connect(int bond_offset, int effects_offset);

  /// True if this call can be served: not where the host writes down single contacts, or treats
  /// some atoms in a way of its own.
  bool serves(class PairGran *pair) const;
  /// Stops the run if what the host's loop is to compute is not in it.
  void check_reference() const;
  /// Before either loop: stops the run if an atom has a type whose properties are not known; with
  /// new lists or other radii, chooses units that hold the forces on all atoms.
  void prepare();
  void compute_force(class PairGran *pair);

  // PairLoop
  void store_histories() { table_.store_histories(); }
  void release_histories() { table_.release_histories(); }

  void stop_overflow(int tag) const { forces_.stop_overflow(tag); }

private:
  BondEvents *bonds_ = nullptr;
  class WorkLedger *ledger_ = nullptr; // NULL when none is kept
  class CellGrowth *cell_ = nullptr;   // NULL: it keeps its sides
  ContactEffects effects_;
  double **friction_ = nullptr, **cohesion_ = nullptr;
  double **modulus_ = nullptr, **shear_modulus_ = nullptr, **damping_ = nullptr;
  KnownTypes known_;
  std::vector<PairMaterial> materials_;      // of known types a, b at a * types_ + b
  int types_ = 0;                            // of the box, and 1
  int bond_ = 0, memory_ = -1, spring_ = -1; // offsets in the history
  bool contacts_are_read_ = false;           // by a style of the host, in every step
  bool radii_vary_ = false;                  // by a fix of the host, between two lists
  std::vector<Sphere> spheres_;              // atoms and ghosts in this step
  ForceSums forces_;                         // on them
  PairTable table_;
  const std::unique_ptr<PairStep> step_;
  bool update_ = true;           // histories advance: not during set-up
  class Pair *virial_ = nullptr; // who adds up the step's virial, NULL for nobody

  void copy_materials();
  bool copy_spheres();
  void gather_spheres(const PairTile &tile);
  int compute_tile(PairTable::Bonds &list, int tile, const struct BondSettings &);
  void compute_tile(ContactTile &tile);
  int watch_bonds(PairTable::Bonds &list, int tile, const BondSettings &);
  void mark_separated(ContactTile &tile);
  void apply_effects(const ContactTile &tile);
  void add_gradient(int size);
  double moment(const PairTile &tile, const VectorRow &force) const;
  void book_moment(const PairTile &tile);
  void sum_forces(const PairTile &tile);
  void book_bonds(const BondTile &tile);
  void book_shrinking(const BondTile &tile, const calendem::BondMaterial &);
  void book_contacts(const PairTile &tile);
};

} // namespace LAMMPS_NS

#endif
