// SPDX-License-Identifier: GPL-2.0-or-later
// The laws of bond strength that fix bond/bpm can switch on: the keyword of each with its numbers,
// and the factor that all of them together put on sigma_c and tau_c of a bond at its creation.
#ifndef CALENDEM_BOND_STRENGTHS_H
#define CALENDEM_BOND_STRENGTHS_H

#include "physics/pre_cracks.h"
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// What a law may know of a bond. All of it is the same on any number of ranks.
struct BondPlace {
  int tag_i, tag_j, body;
  double body_diameter; ///< of the sphere of the primaries' volume [um]
};

struct BondStrengths {
  double weibull_modulus = 0.0; ///< <= 0: no scatter
  double pre_cracks = 0.0;      ///< fraction of the bonds that have no strength
  std::uint64_t seed = 0;       ///< of all laws

  /// A number of a keyword, and what it may be.
  struct Number {
    double BondStrengths::*value;
    double least, most;
  };
  struct Keyword {
    const char *name;
    std::vector<Number> numbers;
  };

  static const std::vector<Keyword> &keywords() {
    static const std::vector<Keyword> all = {
        {"pre_cracks", {{&BondStrengths::pre_cracks, 0.0, 0.9}}}};
    return all;
  }

  double factor(const BondPlace &bond) const {
    return calendem::weibull_factor(weibull_modulus, seed, bond.tag_i, bond.tag_j) *
           calendem::pre_crack_factor(pre_cracks, seed, bond.tag_i, bond.tag_j);
  }
};

} // namespace LAMMPS_NS

#endif
