// SPDX-License-Identifier: GPL-2.0-or-later
// What each atom carries of its body: the body's number and how many of the atom's bonds have
// broken. Grows, moves and restarts with the atoms: the calls of a fix with the same names.
#ifndef CALENDEM_BODY_ATOMS_H
#define CALENDEM_BODY_ATOMS_H

#include "pointers.h"

namespace LAMMPS_NS {

class BodyAtoms : protected Pointers {
public:
  static constexpr int kRestartSize = 3;

  explicit BodyAtoms(class LAMMPS *lmp) : Pointers(lmp) {}
  ~BodyAtoms();

  /// 0: of none.
  int body(int i) const { return body_[i]; }
  int broken(int i) const { return broken_[i]; }
  const int *bodies() const { return body_; }
  bool in_one(int i, int j) const { return body_[i] > 0 && body_[i] == body_[j]; }
  void set_body(int i, int body) { body_[i] = body; }
  void count_break(int i) { ++broken_[i]; }

  void grow_arrays(int nmax);
  void copy_arrays(int i, int j);
  void set_arrays(int i, int body);
  int pack_exchange(int i, double *buf) const;
  int unpack_exchange(int nlocal, const double *buf);
  int pack_restart(int i, double *buf) const;
  void unpack_restart(int nlocal, int nth);

private:
  int *body_ = nullptr, *broken_ = nullptr;
  int nmax_ = 0;
};

} // namespace LAMMPS_NS

#endif
