// SPDX-License-Identifier: GPL-2.0-or-later
// The pairs of this rank in the host's lists, with what their histories hold of bonds: loops over
// them, and which copy of a pair counts.
#ifndef CALENDEM_BOND_PAIRS_H
#define CALENDEM_BOND_PAIRS_H

#include "atom.h"
#include "bond_bpm_history.h"
#include "force.h"
#include "neigh_list.h"
#include "pair_gran.h"
#include "physics/bond_pair.h"
#include "pointers.h"

namespace LAMMPS_NS {

/// What the rest knows of the loop over pairs, which keeps values of histories from step to step.
class PairLoop {
public:
  virtual ~PairLoop() {}
  /// Writes them into the host's lists; release_histories() leaves them there too.
  virtual void store_histories() = 0;
  virtual void release_histories() = 0;
  /// Stops the run: forces on the atom with that tag are beyond the units of their sum.
  virtual void stop_overflow(int tag) const = 0;
};

class BondPairs : protected Pointers {
public:
  explicit BondPairs(class LAMMPS *lmp) : Pointers(lmp) {}

  /// Where the bond's values begin in a pair's history.
  void connect(int bond_offset) { offset_ = bond_offset; }
  /// NULL: there is none.
  void set_loop(PairLoop *loop) { loop_ = loop; }
  const PairLoop *loop() const { return loop_; }
  void store_histories() const {
    if (loop_)
      loop_->store_histories();
  }
  void release_histories() const {
    if (loop_)
      loop_->release_histories();
  }

  /// True on the rank (and copy) that counts the pair and decides its fate.
  bool decides(int i, int j) const {
    const int nlocal = atom->nlocal;
    if (i < nlocal && j < nlocal)
      return true;
    return i < nlocal ? atom->tag[i] < atom->tag[j] : atom->tag[j] < atom->tag[i];
  }

  /// From one centre to the other.
  double distance(int i, int j) const {
    return norm(calendem::load(atom->x[i]) - calendem::load(atom->x[j]));
  }
  /// The pair's bond where its spheres stand now.
  calendem::BondPair bond_of(const calendem::BondMaterial &material, int i, int j,
                             const BondHistory &bond) const {
    const calendem::Vec3 d = calendem::load(atom->x[i]) - calendem::load(atom->x[j]);
    return {material, atom->radius[i], atom->radius[j], bond.length(), calendem::pair_at_rest(d)};
  }

  /// Calls visit(i, j, history) for every pair of the lists, as the lists hold it.
  template <class Visit> void for_each_neighbor(Visit visit) const;
  /// Calls visit(i, j, history) for every intact bond, each once over all ranks.
  template <class Visit> void for_each_intact(Visit visit) const;
  /// Calls it for every copy on this rank: each local atom meets all its bonds.
  template <class Visit> void for_each_copy(Visit visit) const;
  /// Calls it for bridges between spheres as well.
  template <class Visit> void for_each_acting_copy(Visit visit) const;
  /// Calls visit(i, j, r, history) for every pair whose spheres overlap, each once over all ranks.
  template <class Visit> void for_each_touching(Visit visit) const;
  /// Calls it for every copy on this rank.
  template <class Visit> void for_each_touching_copy(Visit visit) const;

private:
  int offset_ = -1;
  PairLoop *loop_ = nullptr;
};

template <class Visit> void BondPairs::for_each_neighbor(Visit visit) const {
  PairGran *pair = static_cast<PairGran *>(force->pair_match("gran", 1));
  if (!pair || !pair->list || !pair->list->listgranhistory || offset_ < 0)
    return;
  const NeighList *list = pair->list;
  const int dnum = pair->dnum();
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    double *all = list->listgranhistory->firstdouble[i];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      BondHistory bond(all + dnum * jj + offset_);
      const int j = list->firstneigh[i][jj] & NEIGHMASK;
      visit(i, j, bond);
    }
  }
}

template <class Visit> void BondPairs::for_each_copy(Visit visit) const {
  store_histories();
  for_each_neighbor([&](int i, int j, BondHistory &bond) {
    if (bond.state() == kIntact)
      visit(i, j, bond);
  });
}

template <class Visit> void BondPairs::for_each_acting_copy(Visit visit) const {
  store_histories();
  for_each_neighbor([&](int i, int j, BondHistory &bond) {
    if (bond.acts())
      visit(i, j, bond);
  });
}

template <class Visit> void BondPairs::for_each_touching_copy(Visit visit) const {
  store_histories();
  for_each_neighbor([&](int i, int j, const BondHistory &bond) {
    const double r = distance(i, j);
    if (r < atom->radius[i] + atom->radius[j])
      visit(i, j, r, bond);
  });
}

template <class Visit> void BondPairs::for_each_touching(Visit visit) const {
  for_each_touching_copy([&](int i, int j, double r, const BondHistory &bond) {
    if (decides(i, j))
      visit(i, j, r, bond);
  });
}

template <class Visit> void BondPairs::for_each_intact(Visit visit) const {
  for_each_copy([&](int i, int j, const BondHistory &bond) {
    if (decides(i, j))
      visit(i, j, bond);
  });
}

} // namespace LAMMPS_NS

#endif
