// SPDX-License-Identifier: GPL-2.0-or-later
// The binder bridges between spheres (physics/binder_bridge.h) of fix bond/bpm: their settings and
// kinds, how far they have shrunk (physics/drying_shrinkage.h), how many were made. Those on the
// collector are counted here as well.
#ifndef CALENDEM_SPHERE_BRIDGES_H
#define CALENDEM_SPHERE_BRIDGES_H

#include "bond_pairs.h"
#include "bond_settings.h"
#include "break_log.h"
#include "physics/binder_bridge.h"
#include "physics/drying_shrinkage.h"
#include "pointers.h"

namespace LAMMPS_NS {

/// Bridges that a wall has; values of this rank.
class CollectorBridges {
public:
  virtual ~CollectorBridges() {}
  virtual bigint intact() const = 0;
  virtual double strain_energy() const = 0; ///< [fJ]
};

class SphereBridges : protected Pointers {
public:
  /// Messages name the fix `owner`.
  SphereBridges(class LAMMPS *lmp, class Fix *owner) : Pointers(lmp), owner_(owner) {}

  /// `fix_modify ID bridges ...` and `... shrinkage ...`; how many words they take. `damping`: of
  /// bonds.
  int read(int narg, char **arg, double damping);
  int read_shrinkage(int narg, char **arg);
  /// Before a run: what excludes bridges, and shrinkage without them.
  void check() const;

  bool on() const { return law_.on(); }
  const calendem::BinderBridges &law() const { return law_; }
  /// The factor of a bridge's strength is its sigma_c.
  const BondSettings &settings() const { return settings_; }

  /// Makes the bridge of i and j at the distance r [um], if they are to have one.
  void make(int i, int j, double r, BondHistory &bond) const;
  /// None unless one of the spheres is CBD and the other CBD or AM.
  calendem::BridgeKind kind_of(int i, int j) const;

  /// By a step of length dt [us].
  void shrink(double dt);
  void begin_shrinking();
  /// By how much of their length at creation bridges have shrunk in this step, and whether they do
  /// in this or the next one.
  double shrinking() const { return shrinking_; }
  bool shrinks() const { return shrinkage_.strain > 0.0 && (shrunk_ < 1.0 || shrinking_ > 0.0); }
  const calendem::DryingShrinkage &shrinkage() const { return shrinkage_; }
  double shrunk() const { return shrunk_; } ///< of `shrinkage`, 0-1

  /// NULL: no wall has any.
  void set_on_collector(const CollectorBridges *bridges) { on_collector_ = bridges; }
  const CollectorBridges *on_collector() const { return on_collector_; }
  void count_made(const BondPairs &pairs);
  bigint made(calendem::BridgeKind kind) const { return made_[int(kind)]; }
  void set_made(calendem::BridgeKind kind, bigint n) { made_[int(kind)] = n; }
  /// Value n, from 0, of those that fix bond/bpm shows of bridges.
  double output(int n, class BondEvents &bonds, const BreakTotals &broken) const;
  void restart(double shrunk) { shrunk_ = shrunk; }

private:
  class Fix *owner_;
  BondSettings settings_;
  calendem::BinderBridges law_;
  calendem::DryingShrinkage shrinkage_;
  double shrunk_ = 0.0, shrinking_ = 0.0; // of `shrinkage_`; in this step, of the length
  const CollectorBridges *on_collector_ = nullptr;
  bigint made_[calendem::kBridgeKinds] = {};

  void check_strengths() const;
  /// Stops the run unless made = intact + broken for each kind.
  void check_sums(const BondPairs &pairs, const BreakTotals &broken) const;
  double energy_on_collector() const;
  void count(const BondPairs &pairs, bigint *of_kind) const;
};

} // namespace LAMMPS_NS

#endif
