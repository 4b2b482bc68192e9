// SPDX-License-Identifier: GPL-2.0-or-later
// The pairs of a rank in tiles: intact bonds, other pairs that touch or may soon, and far ones.
// They are sorted when the host has built its lists and, as far as spheres have come nearer, again
// between two builds. Loads of bonds and displacements of contacts are kept in the tiles meanwhile;
// store_histories() writes them, and the contact flags, back to the host's lists, which alone hold
// all the rest: at the end of a run, before the host saves its histories, whenever something of the
// plugin reads them, and after each step in which a style of the host could (contact_readers.h).
#ifndef CALENDEM_PAIR_TABLE_H
#define CALENDEM_PAIR_TABLE_H

#include "bond_bpm_history.h"
#include "bond_events.h"
#include "pair_tile.h"
#include "pointers.h"
#include <vector>

namespace LAMMPS_NS {

/// Tiles of which all but the last are full.
template <class Tile> class TileList {
public:
  int tiles() const { return (pairs_ + kTilePairs - 1) / kTilePairs; }
  int pairs() const { return pairs_; }
  Tile &tile(int n) { return tiles_[n]; }
  Tile &of(int pair) { return tiles_[pair / kTilePairs]; }
  static int at(int pair) { return pair % kTilePairs; }

  void clear() { pairs_ = 0; }
  /// Room for one more, at the end.
  int add() {
    if (pairs_ == static_cast<int>(tiles_.size()) * kTilePairs)
      tiles_.resize(tiles_.size() + tiles_.size() / 8 + 1);
    of(pairs_).size = at(pairs_) + 1;
    return pairs_++;
  }
  /// The last pair takes its place.
  void remove(int pair) {
    const int last = --pairs_;
    if (pair != last)
      of(pair).copy(at(pair), of(last), at(last));
    --of(last).size;
  }

private:
  std::vector<Tile> tiles_;
  int pairs_ = 0;
};

class PairTable : protected Pointers {
public:
  explicit PairTable(class LAMMPS *lmp) : Pointers(lmp) {}

  /// Offsets in a pair's history.
  void connect(BondEvents *bonds, int bond_offset, int effects_offset, int spring_offset);

  /// False before adopt_lists() and after release_histories().
  bool holds_histories() const { return holds_; }
  /// All pairs of the lists; makes the bonds if it is time.
  void adopt_lists(class PairGran *pair);
  /// To be called before each use: pairs whose bond has broken are contacts, and far ones that have
  /// come near are among them. `resized`: radii have changed.
  void update(bool resized);
  /// Values of the tiles have changed.
  void mark_changed() { stored_ = false; }
  /// Writes the tiles' values into the histories.
  void store_histories();
  /// Writes them, and leaves them to the host.
  void release_histories();

  /// Bonds of one kind, and those that have failed since, in ascending order.
  struct Bonds : TileList<BondTile> {
    std::vector<int> failed;
  };
  Bonds bonds, bridges;
  TileList<ContactTile> contacts;
  int deciding() const { return deciding_; } ///< bonds and bridges that this rank decides
  void store_loads(const BondTile &tile, int p) const;
  /// Spheres of what was a bond have separated.
  void mark_separated(ContactTile &tile, int p);
  /// The spheres do not touch: the effect of the contact forgets.
  void clear_effect(double *history) const;

private:
  struct FarPair {
    int i, j;
    double *history;
    int *flags;
  };

  BondEvents *bonds_ = nullptr;
  int bond_ = 0, memory_ = -1, spring_ = -1;
  bool holds_ = false, stored_ = true;
  int deciding_ = 0;
  std::vector<FarPair> far_;
  double gap_ = 0.0;              // of far pairs at least, when the pairs were sorted [um]
  std::vector<double> positions_; // then

  BondHistory bond(double *history) const { return BondHistory(history + bond_); }
  bool spheres_moved() const;
  void remember_positions();
  void sort_far_pairs();
  void sort_contacts();
  void update_reference(PairTile &t, int p) const;
  void update_references();
  bool has_broken(Bonds &list);
  void drop_broken();
  void drop_bond(Bonds &list, int bond);
  void store_contact(const PairTile &tile, int p) const;
  int contact_flags(int i, int j) const;
  double distance_squared(int i, int j) const;
  bool is_near(int i, int j, double gap) const;
  void sort_pair(const FarPair &pair);
  void make_far(const FarPair &pair);
  void place_pair(PairTile &tile, int p, const FarPair &pair) const;
  void make_bonds(int i, int j, BondHistory &history) const;
  void add_bond(Bonds &list, const FarPair &pair);
  void add_contact(const FarPair &pair);
};

} // namespace LAMMPS_NS

#endif
