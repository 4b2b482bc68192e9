// SPDX-License-Identifier: GPL-2.0-or-later
#include "sphere_bridges.h"
#include "bond_sums.h"
#include "error.h"
#include "fix.h"
#include "laws/phases.h"
#include "material_checks.h"
#include "modify.h"
#include "mpi_liggghts.h"
#include "words.h"
#include <algorithm>

using namespace LAMMPS_NS;
using calendem::BinderBridges;
using calendem::BridgeKind;

int SphereBridges::read(int narg, char **arg, double damping) {
  const int words = 9;
  if (narg < words)
    error->fix_error(FLERR, owner_,
                     "'bridges' needs 8 numbers: modulus, Poisson's ratio, radius ratio, gap, "
                     "strengths to AM, CBD and the collector, shear over tensile strength");
  const NumberReader number(error, owner_);
  calendem::BondMaterial &m = settings_.material;
  m.youngs_modulus = number("bridges: modulus", arg[1], kPositive);
  const double poisson = number("bridges: Poisson's ratio", arg[2], between(0.0, 0.5));
  m.radius_ratio = number("bridges: radius ratio", arg[3], kBondRadius);
  law_.gap = number("bridges: gap", arg[4], between(0.0, BinderBridges::kMostGap));
  law_.tensile[int(BridgeKind::AmCbd)] = number("bridges: strength to AM", arg[5], kNotNegative);
  law_.tensile[int(BridgeKind::CbdCbd)] = number("bridges: strength to CBD", arg[6], kNotNegative);
  law_.tensile[int(BridgeKind::CbdCollector)] =
      number("bridges: strength to the collector", arg[7], kNotNegative);
  law_.shear_ratio = number("bridges: shear over tensile strength", arg[8], kPositive);
  m.shear_modulus = calendem::shear_modulus(m.youngs_modulus, poisson);
  m.damping = damping;
  settings_.strength = {1.0, law_.shear_ratio};
  check_strengths();
  return words;
}

void SphereBridges::check_strengths() const {
  const double E = settings_.material.youngs_modulus;
  MaterialChecks(lmp, owner_).check_modulus("the modulus of 'bridges'", E);
  char message[300];
  for (const double tensile : law_.tensile) {
    snprintf(message, sizeof message,
             "a tensile strength of 'bridges' is %g kPa, %.3g of their modulus; at most %g is "
             "allowed, or they stretch too far before they break. Lower it or raise the modulus",
             tensile, tensile / E, BinderBridges::kMostStrain);
    if (tensile > BinderBridges::kMostStrain * E)
      error->fix_error(FLERR, owner_, message);
  }
}

int SphereBridges::read_shrinkage(int narg, char **arg) {
  const int words = 3;
  if (narg < words)
    error->fix_error(FLERR, owner_, "'shrinkage' needs 2 numbers: strain and time [us]");
  const NumberReader number(error, owner_);
  shrinkage_.strain = number("shrinkage", arg[1], kNotNegative);
  shrinkage_.time = number("shrinkage: time", arg[2], kNotNegative);
  char message[256];
  snprintf(message, sizeof message,
           "'shrinkage' is %g; at most %g is allowed, where the strongest of bridges break",
           shrinkage_.strain, calendem::DryingShrinkage::kMost);
  if (shrinkage_.strain > calendem::DryingShrinkage::kMost)
    error->fix_error(FLERR, owner_, message);
  return words;
}

void SphereBridges::check() const {
  if (on() && modify->n_fixes_style("cbd/collapse") > 0)
    error->fix_error(FLERR, owner_,
                     "'bridges' and fix cbd/collapse exclude each other: a bridge keeps its length "
                     "while its spheres would shrink");
  char message[256];
  snprintf(message, sizeof message,
           "'shrinkage' is %g, and there are no binder bridges that could shrink. Give 'bridges' "
           "with a strength above 0, or a shrinkage of 0",
           shrinkage_.strain);
  if (shrinkage_.strain > 0.0 && !law_.on())
    error->fix_error(FLERR, owner_, message);
}

void SphereBridges::begin_shrinking() {
  shrink(0.0);
  shrinking_ = 0.0;
}

void SphereBridges::shrink(double dt) {
  const double before = settings_.material.rest;
  shrunk_ = shrinkage_.later(shrunk_, dt);
  settings_.material.rest = shrinkage_.rest(shrunk_);
  shrinking_ = before - settings_.material.rest;
}

BridgeKind SphereBridges::kind_of(int i, int j) const {
  const int am = int(calendem::Phase::Am), cbd = int(calendem::Phase::Cbd);
  const int a = atom->type[i], b = atom->type[j];
  if (a == cbd && b == cbd)
    return BridgeKind::CbdCbd;
  return (a == am && b == cbd) || (a == cbd && b == am) ? BridgeKind::AmCbd : BridgeKind::None;
}

void SphereBridges::make(int i, int j, double r, BondHistory &bond) const {
  const double tensile = law_.tensile_of(kind_of(i, j));
  const double radius_sum = atom->radius[i] + atom->radius[j];
  if (bond.state() == kNeverBonded && tensile > 0.0 && law_.spans(radius_sum, r))
    bond.create(r, tensile, kBridge);
}

// Between the spheres of this rank.
void SphereBridges::count(const BondPairs &pairs, bigint *of_kind) const {
  std::fill_n(of_kind, calendem::kBridgeKinds, 0);
  pairs.for_each_acting_copy([&](int i, int j, const BondHistory &bond) {
    if (bond.state() == kBridge && pairs.decides(i, j))
      ++of_kind[int(kind_of(i, j))];
  });
}

void SphereBridges::count_made(const BondPairs &pairs) {
  bigint mine[calendem::kBridgeKinds];
  count(pairs, mine);
  MPI_Allreduce(mine, made_, calendem::kBridgeKinds, MPI_LMP_BIGINT, MPI_SUM, world);
}

void SphereBridges::check_sums(const BondPairs &pairs, const BreakTotals &broken) const {
  bigint mine[calendem::kBridgeKinds], intact[calendem::kBridgeKinds];
  count(pairs, mine);
  if (on_collector_)
    mine[int(BridgeKind::CbdCollector)] = on_collector_->intact();
  MPI_Allreduce(mine, intact, calendem::kBridgeKinds, MPI_LMP_BIGINT, MPI_SUM, world);
  for (int k = 0; k < calendem::kBridgeKinds; ++k) {
    char message[256];
    snprintf(message, sizeof message,
             "binder bridges do not add up: " BIGINT_FORMAT " made, " BIGINT_FORMAT
             " intact, " BIGINT_FORMAT " broken. One vanished without a break",
             made_[k], intact[k], broken.of_bridges[k]);
    if (intact[k] + broken.of_bridges[k] != made_[k])
      error->fix_error(FLERR, owner_, message);
  }
}

// Sum over all ranks [fJ].
double SphereBridges::energy_on_collector() const {
  const double mine = on_collector_ ? on_collector_->strain_energy() : 0.0;
  double all = 0.0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double SphereBridges::output(int n, BondEvents &bonds, const BreakTotals &broken) const {
  using calendem::kBridgeKinds;
  if (n == 0)
    check_sums(bonds.pairs(), broken);
  if (n < kBridgeKinds)
    return made_[n];
  switch (n - kBridgeKinds) {
  case kBridgeKinds:
    return energy_on_collector() + BondSums(lmp, bonds).strain_energy(kBridge);
  case kBridgeKinds + 1:
    return broken.bridge_energy;
  case kBridgeKinds + 2:
    return 1.0 - settings_.material.rest;
  default:
    return broken.of_bridges[n - kBridgeKinds];
  }
}
