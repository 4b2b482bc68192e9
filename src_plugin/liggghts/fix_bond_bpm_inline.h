// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of fix bond/bpm that run inside loops over pairs.
#ifndef CALENDEM_FIX_BOND_BPM_INLINE_H
#define CALENDEM_FIX_BOND_BPM_INLINE_H

#include "atom.h"
#include "force.h"
#include "neigh_list.h"
#include "pair_gran.h"

namespace LAMMPS_NS {

inline bool FixBondBpm::decides(int i, int j) const {
  const int nlocal = atom->nlocal;
  if (i < nlocal && j < nlocal)
    return true;
  return i < nlocal ? atom->tag[i] < atom->tag[j] : atom->tag[j] < atom->tag[i];
}

inline void FixBondBpm::create(int i, int j, double r, BondHistory &bond) const {
  if (bond.state() != kNeverBonded || body_[i] <= 0 || body_[i] != body_[j])
    return;
  const int body = body_[i];
  bond.create(
      r, settings_.strengths.factor({atom->tag[i], atom->tag[j], body, body_diameter_.at(body)}));
}

// As BondHistory::length.
inline double FixBondBpm::meeting_distance(int i, int j) const {
  const double D = settings_.contact_diameter;
  if (body_[i] > 0 && body_[i] == body_[j])
    return D < 1.0 ? D * (atom->radius[i] + atom->radius[j]) : 0.0;
  return settings_.surface_inset > 0.0 ? -(inset_[i] + inset_[j]) : 0.0;
}

inline void FixBondBpm::separate(int i, int j, BondHistory &bond) const {
  bond.set_state(kBrokenSeparated);
  bond.meet_at(meeting_distance(i, j));
}

template <class Visit> void FixBondBpm::for_each_neighbor(Visit visit) {
  PairGran *pair = static_cast<PairGran *>(force->pair_match("gran", 1));
  if (!pair || !pair->list || !pair->list->listgranhistory || history_offset_ < 0)
    return;
  const NeighList *list = pair->list;
  const int dnum = pair->dnum();
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    double *all = list->listgranhistory->firstdouble[i];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      BondHistory bond(all + dnum * jj + history_offset_);
      const int j = list->firstneigh[i][jj] & NEIGHMASK;
      visit(i, j, bond);
    }
  }
}

template <class Visit> void FixBondBpm::for_each_copy(Visit visit) {
  store_histories();
  for_each_neighbor([&](int i, int j, BondHistory &bond) {
    if (bond.state() == kIntact)
      visit(i, j, bond);
  });
}

template <class Visit> void FixBondBpm::for_each_acting_copy(Visit visit) {
  store_histories();
  for_each_neighbor([&](int i, int j, BondHistory &bond) {
    if (bond.acts())
      visit(i, j, bond);
  });
}

template <class Visit> void FixBondBpm::for_each_touching_copy(Visit visit) {
  store_histories();
  for_each_neighbor([&](int i, int j, const BondHistory &bond) {
    const double r = norm(calendem::load(atom->x[i]) - calendem::load(atom->x[j]));
    if (r < atom->radius[i] + atom->radius[j])
      visit(i, j, r, bond);
  });
}

template <class Visit> void FixBondBpm::for_each_touching(Visit visit) {
  for_each_touching_copy([&](int i, int j, double r, const BondHistory &bond) {
    if (decides(i, j))
      visit(i, j, r, bond);
  });
}

template <class Visit> void FixBondBpm::for_each_intact(Visit visit) {
  for_each_copy([&](int i, int j, const BondHistory &bond) {
    if (decides(i, j))
      visit(i, j, bond);
  });
}

} // namespace LAMMPS_NS

#endif
