// SPDX-License-Identifier: GPL-2.0-or-later
// compute ID all contact/range T ...
//   T: atom types of the phases (1 2: active material, carbon-binder domain)
// How far contacts are beyond the range of Hertz' and of their own law (physics/contact_range.h), measured on
// request; it does not affect the run. A contact is a pair, or a sphere and a fix
// wall/gran/platen, whose normal law pushes. Contacts inside a body, whose overlap counts from the
// bond's creation, hold the body's own stress: they have a row of their own and are in no other.
// Needs fix bond/bpm and `pair_style gran model hertz|hertz_effects`.
// Global array. Rows: 1 all contacts but those inside bodies, 2 with walls, 3 inside bodies
//   (bonded, or broken and not yet apart), 4 ... pairs of the phases: 1-1, 1-2, ..., 2-2, ...
// Columns: 1 contacts, 2 sum of their elastic normal forces, without cohesion [nN], 3 mean and
//   4 largest overlap over the smaller radius, 5-8 contacts and 9-12 force [nN] beyond 0.1, 0.2,
//   0.3 of it, and beyond the range of their law.
#ifdef COMPUTE_CLASS

ComputeStyle(contact/range, ComputeContactRange)

#else
#ifndef LMP_COMPUTE_CONTACT_RANGE_H
#define LMP_COMPUTE_CONTACT_RANGE_H

#include "compute.h"
#include "contact_effects.h"
#include "physics/contact_range.h"
#include <vector>

namespace LAMMPS_NS {

class ComputeContactRange : public Compute {
public:
  ComputeContactRange(class LAMMPS *, int &, int, char **);
  ~ComputeContactRange();
  void init();
  void compute_array();

private:
  enum Row { kAll, kWalls, kInsideBodies, kPairs };
  static constexpr int kColumns = calendem::ContactRange::kSums + 1;

  class FixBondBpm *bonds_;
  ContactEffects effects_;
  bool pairs_have_effects_;
  std::vector<class FixWallGranPlaten *> walls_;
  std::vector<int> phase_; // by atom type, -1: none of the phases
  int phases_;
  std::vector<calendem::ContactRange> mine_; // of this rank, by rows

  int row_of(int itype, int jtype) const;
  void add(int row, const EffectContact &contact, const double *memory);
  void add_pairs();
  void add_walls();
};

} // namespace LAMMPS_NS

#endif
#endif
