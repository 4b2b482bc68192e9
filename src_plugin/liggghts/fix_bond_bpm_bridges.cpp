// SPDX-License-Identifier: GPL-2.0-or-later
// fix bond/bpm: binder bridges, their settings, creation and counts.
#include "comm.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_energy_bpm.h"
#include "fix_time_bpm.h"
#include "modify.h"
#include "mpi_liggghts.h"
#include "registry/phases.h"
#include "update.h"
#include "wall_bridges.h"
#include "words.h"
#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using calendem::BinderBridges;
using calendem::BridgeKind;

int FixBondBpm::parse_bridges(int narg, char **arg) {
  const int words = 9;
  if (narg < words)
    error->fix_error(FLERR, this,
                     "'bridges' needs 8 numbers: modulus, Poisson's ratio, radius ratio, gap, "
                     "strengths to AM, CBD and the collector, shear over tensile strength");
  const NumberReader number(error, this);
  calendem::BondMaterial &m = bridge_settings_.material;
  m.youngs_modulus = number("bridges: modulus", arg[1], kPositive);
  const double poisson = number("bridges: Poisson's ratio", arg[2], between(0.0, 0.5));
  m.radius_ratio = number("bridges: radius ratio", arg[3], kBondRadius);
  bridges_.gap = number("bridges: gap", arg[4], between(0.0, BinderBridges::kMostGap));
  bridges_.tensile[int(BridgeKind::AmCbd)] =
      number("bridges: strength to AM", arg[5], kNotNegative);
  bridges_.tensile[int(BridgeKind::CbdCbd)] =
      number("bridges: strength to CBD", arg[6], kNotNegative);
  bridges_.tensile[int(BridgeKind::CbdCollector)] =
      number("bridges: strength to the collector", arg[7], kNotNegative);
  bridges_.shear_ratio = number("bridges: shear over tensile strength", arg[8], kPositive);
  m.shear_modulus = calendem::shear_modulus(m.youngs_modulus, poisson);
  m.damping = settings_.material.damping;
  bridge_settings_.strength = {1.0, bridges_.shear_ratio};
  check_bridges();
  return words;
}

void FixBondBpm::check_bridges() {
  const double E = bridge_settings_.material.youngs_modulus;
  check_modulus("the modulus of 'bridges'", E);
  char message[300];
  for (const double tensile : bridges_.tensile) {
    snprintf(message, sizeof message,
             "a tensile strength of 'bridges' is %g kPa, %.3g of their modulus; at most %g is "
             "allowed, or they stretch too far before they break. Lower it or raise the modulus",
             tensile, tensile / E, BinderBridges::kMostStrain);
    if (tensile > BinderBridges::kMostStrain * E)
      error->fix_error(FLERR, this, message);
  }
}

int FixBondBpm::parse_shrinkage(int narg, char **arg) {
  const int words = 3;
  if (narg < words)
    error->fix_error(FLERR, this, "'shrinkage' needs 2 numbers: strain and time [us]");
  const NumberReader number(error, this);
  shrinkage_.strain = number("shrinkage", arg[1], kNotNegative);
  shrinkage_.time = number("shrinkage: time", arg[2], kNotNegative);
  char message[256];
  snprintf(message, sizeof message,
           "'shrinkage' is %g; at most %g is allowed, where the strongest of bridges break",
           shrinkage_.strain, calendem::DryingShrinkage::kMost);
  if (shrinkage_.strain > calendem::DryingShrinkage::kMost)
    error->fix_error(FLERR, this, message);
  return words;
}

void FixBondBpm::check_shrinkage() {
  if (shrinkage_.strain <= 0.0)
    return;
  char message[256];
  snprintf(message, sizeof message,
           "'shrinkage' is %g, and there are no binder bridges that could shrink. Give 'bridges' "
           "with a strength above 0, or a shrinkage of 0",
           shrinkage_.strain);
  if (!bridges_.on())
    error->fix_error(FLERR, this, message);
  if (energy_ && modify->find_fix(energy_->id) < modify->find_fix(id))
    error->fix_error(FLERR, this, "with 'shrinkage' it must stand before fix energy/bpm");
  shrink(0.0);
  shrinking_ = 0.0;
}

void FixBondBpm::shrink(double dt) {
  const double before = bridge_settings_.material.rest;
  shrunk_ = shrinkage_.later(shrunk_, dt);
  bridge_settings_.material.rest = shrinkage_.rest(shrunk_);
  shrinking_ = before - bridge_settings_.material.rest;
}

void FixBondBpm::check_radii() {
  if (bridges_.on() && modify->n_fixes_style("cbd/collapse") > 0)
    error->fix_error(FLERR, this,
                     "'bridges' and fix cbd/collapse exclude each other: a bridge keeps its length "
                     "while its spheres would shrink");
  if (bridges_.on() && settings_.surface_inset > 0.0)
    error->fix_error(
        FLERR, this,
        "'bridges' and 'surface_inset' exclude each other: of a pair with a bridge the "
        "spheres' own surfaces meet");
  double least = HUGE_VAL, all = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    least = std::fmin(least, atom->radius[i]);
  MPI_Allreduce(&least, &all, 1, MPI_DOUBLE, MPI_MIN, world);
  if (settings_.surface_inset > 0.5 * all)
    error->fix_error(FLERR, this, "'surface_inset' is more than half of the smallest radius");
}

BridgeKind FixBondBpm::kind_of_bridge(int i, int j) const {
  const int am = int(calendem::Phase::Am), cbd = int(calendem::Phase::Cbd);
  const int a = atom->type[i], b = atom->type[j];
  if (a == cbd && b == cbd)
    return BridgeKind::CbdCbd;
  return (a == am && b == cbd) || (a == cbd && b == am) ? BridgeKind::AmCbd : BridgeKind::None;
}

void FixBondBpm::bridge(int i, int j, double r, BondHistory &bond) const {
  const double tensile = bridges_.tensile_of(kind_of_bridge(i, j));
  if (bond.state() == kNeverBonded && tensile > 0.0 &&
      r <= atom->radius[i] + atom->radius[j] + bridges_.gap)
    bond.create(r, tensile, kBridge);
}

// Between the spheres of this rank.
void FixBondBpm::count_bridges(bigint *of_kind) {
  std::fill_n(of_kind, calendem::kBridgeKinds, 0);
  for_each_acting_copy([&](int i, int j, const BondHistory &bond) {
    if (bond.state() == kBridge && decides(i, j))
      ++of_kind[int(kind_of_bridge(i, j))];
  });
}

void FixBondBpm::count_bridges_made() {
  bigint mine[calendem::kBridgeKinds];
  count_bridges(mine);
  MPI_Allreduce(mine, bridges_made_, calendem::kBridgeKinds, MPI_LMP_BIGINT, MPI_SUM, world);
}

void FixBondBpm::bridge_breaks_on_wall(int i, double energy) {
  BreakEvent e = {};
  e.time = time_->now();
  e.tag_high = static_cast<double>(atom->tag[i]);
  e.body = -1.0;
  e.mode = static_cast<double>(BridgeKind::CbdCollector);
  e.energy = energy;
  mine_.push_back(e);
}

/// Intact pairs, by what was made and what is known to have broken.
bigint FixBondBpm::acting_pairs() const {
  bigint pairs = initial_ - broken();
  for (const BridgeKind kind : {BridgeKind::AmCbd, BridgeKind::CbdCbd})
    pairs += bridges_made_[int(kind)] - bridges_broken_[int(kind)];
  return pairs;
}

void FixBondBpm::check_bridges_add_up() {
  bigint mine[calendem::kBridgeKinds], intact[calendem::kBridgeKinds];
  count_bridges(mine);
  if (const WallBridges *wall = WallBridges::find(lmp))
    mine[int(BridgeKind::CbdCollector)] = wall->intact();
  MPI_Allreduce(mine, intact, calendem::kBridgeKinds, MPI_LMP_BIGINT, MPI_SUM, world);
  for (int k = 0; k < calendem::kBridgeKinds; ++k) {
    char message[256];
    snprintf(message, sizeof message,
             "binder bridges do not add up: " BIGINT_FORMAT " made, " BIGINT_FORMAT
             " intact, " BIGINT_FORMAT " broken. One vanished without a break",
             bridges_made_[k], intact[k], bridges_broken_[k]);
    if (intact[k] + bridges_broken_[k] != bridges_made_[k])
      error->fix_error(FLERR, this, message);
  }
}

double FixBondBpm::bridge_vector(int n) {
  if (n == 0)
    check_bridges_add_up();
  if (n < calendem::kBridgeKinds)
    return bridges_made_[n];
  if (n < 2 * calendem::kBridgeKinds)
    return bridges_broken_[n - calendem::kBridgeKinds];
  if (n == 2 * calendem::kBridgeKinds + 1)
    return bridge_energy_lost_;
  if (n == 2 * calendem::kBridgeKinds + 2)
    return 1.0 - bridge_settings_.material.rest;
  const WallBridges *wall = WallBridges::find(lmp);
  double mine = wall ? wall->strain_energy() : 0.0, all = 0.0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all + strain_energy_of(kBridge);
}
