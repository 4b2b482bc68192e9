// SPDX-License-Identifier: GPL-2.0-or-later
// Cracks and pores that a secondary particle has before it is pressed: each bond of a body is
// cracked with probability `fraction`, independently of its neighbours, and then has next to no
// strength: it breaks, is logged and counted as soon as it carries anything.
//   factor on sigma_c and tau_c = kNoStrength with probability fraction, else 1
// Range: fraction 0 (off: factor 1 exactly) to below 1. Energy: a bond that breaks unloaded
// releases none. The draw depends on (seed, lower tag, higher tag) alone, as the Weibull scatter's,
// and not on that one's numbers. Source: intrinsic defects of NMC particles as independent bonds of
// a random network (the simplest percolation model); Deviations: real cracks follow grain
// boundaries and lie together, so a fraction here weakens less than the same area in one plane. The
// paper has none. Verified by tests/unit/physics/pre_cracks_test.cpp and
// tests/verification/strength.
#ifndef CALENDEM_PHYSICS_PRE_CRACKS_H
#define CALENDEM_PHYSICS_PRE_CRACKS_H

#include "weibull_strength.h"

namespace calendem {

constexpr double kNoStrength = 1e-9; ///< of the strength; not 0, by which a share is divided

inline double pre_crack_factor(double fraction, std::uint64_t seed, std::int64_t tag_a,
                               std::int64_t tag_b) {
  constexpr std::uint64_t kOwnStream = 0x63726163ULL;
  return fraction > 0.0 && pair_uniform(seed ^ (kOwnStream << 32), tag_a, tag_b) < fraction
             ? kNoStrength
             : 1.0;
}

} // namespace calendem

#endif
