// SPDX-License-Identifier: GPL-2.0-or-later
// The binder bridges of a wall at rest (physics/binder_bridge.h), for fix wall/gran/platen.
// Settings and counts are those of fix bond/bpm. What a bridge remembers is kept with its atom, in
// a fix property/atom of the host, which migrates and restarts it.
#ifndef CALENDEM_WALL_BRIDGES_H
#define CALENDEM_WALL_BRIDGES_H

#include "bond_bpm_history.h"
#include "physics/binder_bridge.h"
#include "physics/time_step_bound.h"
#include "pointers.h"
#include "sphere_bridges.h"
#include <string>
#include <vector>

namespace LAMMPS_NS {

class WallBridges : protected Pointers, public CollectorBridges {
public:
  /// Bridges on the wall with this ID at height z [um].
  WallBridges(class LAMMPS *lmp, const std::string &wall, double z);

  void add_storage(const char *caller);
  void delete_storage();
  /// `wall`: place of its fix among the fixes.
  void init(int wall);
  /// Before the forces of a set-up: is it the one in which fix bond/bpm makes its bonds?
  void note_creation();
  /// Makes the bridges. Call it after the set-up: the host clears property/atom before that.
  /// `type`: of the wall.
  void create(int type);
  /// Adds the bridges' forces; with `update` they follow the step's motion and may break.
  void act(bool update);
  /// Force along z on atom i in the latest act() [nN].
  double force(int i) const { return force_[i]; }

  /// Number of this rank's.
  bigint intact() const;
  double strain_energy() const; ///< [fJ]
  /// Adds the bridge of atom i, if there is one, to what the bound of the time step sums.
  void add_to_blocks(calendem::SphereBlock *stiffness, calendem::SphereBlock *damping, int i) const;

private:
  /// A bridge as its law sees it.
  struct Bridge;

  std::string name_;
  double z_;
  bool creating_;
  class FixBondBpm *bonds_;
  class FixPropertyAtom *storage_;
  std::vector<double> force_;

  double *values(int i) const;
  bool stands(int i) const;
  const calendem::BondMaterial &material() const;
  calendem::PairMotion motion(int i) const;
  void break_if_it_fails(int i, Bridge &bridge);
};

} // namespace LAMMPS_NS

#endif
