// SPDX-License-Identifier: GPL-2.0-or-later
// The laws of bond strength that fix bond/bpm can switch on, a row each, and the factor that all of
// them together put on sigma_c and tau_c of a bond at its creation.
#ifndef CALENDEM_LAWS_BOND_LAWS_H
#define CALENDEM_LAWS_BOND_LAWS_H

#include "physics/body_strength.h"
#include "physics/pre_cracks.h"
#include <vector>

namespace calendem {

/// What a law may know of a bond. All of it is the same on any number of ranks.
struct BondPlace {
  int tag_i, tag_j, body;
  double body_diameter; ///< of the sphere of the primaries' volume [um]
};

/// Numbers of all laws; as they are here none acts.
struct BondStrengths {
  double weibull_modulus = 0.0; ///< <= 0: no scatter; keyword `weibull` of the fix
  double pre_cracks = 0.0;      ///< fraction of the bonds that have no strength
  double body_scatter = 0.0;    ///< sd of the logarithm, from body to body
  double size_exponent = 0.0;   ///< of a body's strength with its diameter
  double reference_um = 1.0;    ///< diameter of a body whose strength is as set
  std::uint64_t seed = 0;       ///< of all laws

  double factor(const BondPlace &bond) const;
};

struct BondStrengthLaw {
  struct Number {
    double BondStrengths::*value;
    double least, most; ///< allowed
  };
  const char *keyword;         ///< of fix bond/bpm; its numbers follow it
  std::vector<Number> numbers; ///< in this order
  double (*factor)(const BondStrengths &, const BondPlace &);
};

inline const std::vector<BondStrengthLaw> &bond_strength_laws() {
  static const std::vector<BondStrengthLaw> rows = {
      {"pre_cracks",
       {{&BondStrengths::pre_cracks, 0.0, 0.9}},
       [](const BondStrengths &s, const BondPlace &bond) {
         return pre_crack_factor(s.pre_cracks, s.seed, bond.tag_i, bond.tag_j);
       }},
      {"body_scatter",
       {{&BondStrengths::body_scatter, 0.0, 1.0}},
       [](const BondStrengths &s, const BondPlace &bond) {
         return body_scatter_factor(s.body_scatter, s.seed, bond.body);
       }},
      {"body_size",
       {{&BondStrengths::size_exponent, 0.0, 3.0}, {&BondStrengths::reference_um, 0.1, 100.0}},
       [](const BondStrengths &s, const BondPlace &bond) {
         return body_size_factor(s.size_exponent, s.reference_um, bond.body_diameter);
       }}};
  return rows;
}

inline double BondStrengths::factor(const BondPlace &bond) const {
  double all = weibull_factor(weibull_modulus, seed, bond.tag_i, bond.tag_j);
  for (const BondStrengthLaw &law : bond_strength_laws())
    all *= law.factor(*this, bond);
  return all;
}

} // namespace calendem

#endif
