// SPDX-License-Identifier: GPL-2.0-or-later
// Failure of a parallel bond (Xu et al., eqs 6-7).
//   sigma = F*/A + |M_t| R / I      tau = |F_t|/A + |M_n| R / J
// The bond breaks when sigma >= sigma_c or tau >= tau_c. F* depends on the criterion:
//   signed      F* = +F_n   (tension positive; Potyondy & Cundall 2004, eq. 16)
//   unsigned    F* = |F_n|  (also breaks in pure compression, as public LIGGGHTS bond forks do)
//   as_printed  F* = -|F_n| (eq. 6 to the letter: pure tension can never break the bond)
// Mode = the largest of the four shares: tension and bending over sigma_c, shear and torsion over
// tau_c (tension only where it adds to sigma).
// Deviations: R is the bond's radius, the paper writes R_min (equal at lambda = 1).
// Verified by tests/unit/physics/bond_failure_test.cpp and tests/verification/pair.
#ifndef CALENDEM_PHYSICS_BOND_FAILURE_H
#define CALENDEM_PHYSICS_BOND_FAILURE_H

#include "parallel_bond.h"

namespace calendem {

enum class FailureCriterion { Signed, Unsigned, AsPrinted };

/// Numbers are those of the break log and of restart files.
enum class BreakMode { None = 0, Tension = 1, Bending = 2, Shear = 3, Torsion = 4 };

inline const char *name_of(BreakMode mode) {
  switch (mode) {
  case BreakMode::Tension:
    return "tension";
  case BreakMode::Bending:
    return "bending";
  case BreakMode::Shear:
    return "shear";
  case BreakMode::Torsion:
    return "torsion";
  default:
    return "none";
  }
}

/// Strengths of one bond [kPa].
struct BondStrength {
  double tensile;
  double shear;
};

/// Stresses of one bond [kPa]; the four shares add up to sigma and tau.
struct BondStress {
  double axial;   ///< F*/A
  double bending; ///< |M_t| R / I
  double shear;   ///< |F_t| / A
  double torsion; ///< |M_n| R / J

  double sigma() const { return axial + bending; }
  double tau() const { return shear + torsion; }
};

inline double effective_tension(double tension, FailureCriterion criterion) {
  switch (criterion) {
  case FailureCriterion::Unsigned:
    return std::fabs(tension);
  case FailureCriterion::AsPrinted:
    return -std::fabs(tension);
  default:
    return tension;
  }
}

inline BondStress bond_stress(const BondLoads &loads, double tension, const BondSection &s,
                              FailureCriterion criterion) {
  return {effective_tension(tension, criterion) / s.area, norm(loads.bending) * s.radius / s.I,
          norm(loads.shear) / s.area, std::fabs(loads.twist) * s.radius / (2.0 * s.I)};
}

/// sigma >= sigma_c or tau >= tau_c, without a square root or a branch: this runs for every bond
/// and step, for several bonds at once.
inline bool fails(const BondLoads &loads, double tension, const BondSection &s,
                  const BondStrength &strength, FailureCriterion criterion) {
  const double spare_force = strength.tensile * s.area - effective_tension(tension, criterion);
  const double spare_moment = 0.25 * spare_force * s.radius; // I/(R A) = R/4
  const double spare_shear =
      strength.shear * s.area - 2.0 * std::fabs(loads.twist) / s.radius; // A R/J = 2/R
  const bool bent = norm_squared(loads.bending) >= spare_moment * spare_moment;
  const bool sheared = norm_squared(loads.shear) >= spare_shear * spare_shear;
  return (spare_force <= 0.0) | bent | (spare_shear <= 0.0) | sheared;
}

inline BreakMode break_mode(const BondStress &stress, const BondStrength &strength) {
  const double share[4] = {stress.axial / strength.tensile, stress.bending / strength.tensile,
                           stress.shear / strength.shear, stress.torsion / strength.shear};
  int largest = 0;
  for (int i = 1; i < 4; ++i)
    if (share[i] > share[largest])
      largest = i;
  return static_cast<BreakMode>(largest + 1);
}

} // namespace calendem

#endif
