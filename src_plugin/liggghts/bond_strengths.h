// SPDX-License-Identifier: GPL-2.0-or-later
// The laws of bond strength that fix bond/bpm can switch on: the keyword of each with its numbers,
// and the factor that all of them together put on sigma_c and tau_c of a bond at its creation.
#ifndef CALENDEM_BOND_STRENGTHS_H
#define CALENDEM_BOND_STRENGTHS_H

#include "physics/body_strength.h"
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
  double body_scatter = 0.0;    ///< sd of the logarithm, from body to body
  double size_exponent = 0.0;   ///< of a body's strength with its diameter
  double reference_um = 1.0;    ///< diameter of a body whose strength is as set
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
        {"pre_cracks", {{&BondStrengths::pre_cracks, 0.0, 0.9}}},
        {"body_scatter", {{&BondStrengths::body_scatter, 0.0, 1.0}}},
        {"body_size",
         {{&BondStrengths::size_exponent, 0.0, 3.0}, {&BondStrengths::reference_um, 0.1, 100.0}}}};
    return all;
  }

  double factor(const BondPlace &bond) const {
    return calendem::weibull_factor(weibull_modulus, seed, bond.tag_i, bond.tag_j) *
           calendem::pre_crack_factor(pre_cracks, seed, bond.tag_i, bond.tag_j) *
           calendem::body_scatter_factor(body_scatter, seed, bond.body) *
           calendem::body_size_factor(size_exponent, reference_um, bond.body_diameter);
  }
};

} // namespace LAMMPS_NS

#endif
