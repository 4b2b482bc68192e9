// SPDX-License-Identifier: GPL-2.0-or-later
// What contacts, bonds and walls book in the energy ledger while they compute forces. fix
// energy/bpm stands behind it and makes work of it.
#ifndef CALENDEM_WORK_LEDGER_H
#define CALENDEM_WORK_LEDGER_H

#include "bond_bpm_history.h"
#include "physics/law_interface.h"
#include "physics/parallel_bond.h"
#include <vector>

namespace LAMMPS_NS {

/// On one atom [nN], [nN um].
struct ForceAndTorque {
  calendem::Vec3 force, torque;
};

inline ForceAndTorque operator+(const ForceAndTorque &a, const ForceAndTorque &b) {
  return {a.force + b.force, a.torque + b.torque};
}
inline ForceAndTorque operator-(const ForceAndTorque &a, const ForceAndTorque &b) {
  return {a.force - b.force, a.torque - b.torque};
}

/// Sums over this rank's pairs of f_x d_x, f on i, d = x_i - x_j [fJ]: of all forces, of damping, of
/// friction.
struct PairMoments {
  double all = 0.0, damped = 0.0, friction = 0.0;
};

class WorkLedger {
public:
  virtual ~WorkLedger() {}

  /// The one of the run, NULL if none is kept.
  static WorkLedger *find(class LAMMPS *lmp);

  // per pair; the owner of a ghost adds its part itself
  void add_damping(int i, const ForceAndTorque &a) { loads_[i].damping = loads_[i].damping + a; }
  void add_damping(int i, const calendem::Vec3 &force) {
    loads_[i].damping.force = loads_[i].damping.force + force;
  }
  void add_damping(int i, int j, const calendem::BondAction &a) {
    add_damping(i, {a.force, a.torque_i});
    add_damping(j, {-a.force, a.torque_j});
  }
  void add_friction(int i, const ForceAndTorque &a) { loads_[i].friction = loads_[i].friction + a; }

  /// Moments of the latest force computation; summed where there is a fix elongation.
  PairMoments &moments() { return moments_; }

  /// What the law of a contact has taken [fJ].
  void add_taken(double work, calendem::WorkTaken term) {
    sums_[term == calendem::WorkTaken::PlasticFlow ? kPlastic : kViscous] += work;
  }
  /// Adds what a shrinking bridge does [fJ]: its tension times its length at creation.
  void add_shrinking(double work) { shrinking_ += work; }
  // Each copy of a pair calls these, one counts.
  virtual void add_taken(int i, int j, double work, calendem::WorkTaken term) = 0;
  virtual void add_shrinking(int i, int j, double work) = 0;
  void shrinking_ends(double work) { ended_ += work; }
  /// A force on atom i acts in this step for the last time: a bridge on a wall has broken.
  void force_ends(int i, const ForceAndTorque &action) { last_forces_.push_back({i, action}); }

  /// For fix bond/bpm, once per copy of the pair, while the history still holds the bond's loads.
  virtual void bond_breaks(int i, int j, const BondHistory &bond) = 0;

protected:
  enum Sum { kDamped, kFriction, kBreaks, kPlastic, kCollapse, kViscous, kShrinking, kSums };
  struct AtomLoads {
    ForceAndTorque damping, friction;
  };
  struct LastForce {
    int atom;
    ForceAndTorque action;
  };

  std::vector<AtomLoads> loads_; // of the latest force computation
  PairMoments moments_;
  std::vector<LastForce> last_forces_;   // of bonds that have just broken
  double sums_[kSums] = {};              // this rank's
  double shrinking_ = 0.0, ended_ = 0.0; // of the latest forces; of the bridges that broke in them
};

} // namespace LAMMPS_NS

#endif
