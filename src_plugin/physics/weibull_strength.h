// SPDX-License-Identifier: GPL-2.0-or-later
// Scatter of bond strength: factor on sigma_c and tau_c of one bond, drawn from a Weibull law
//   P(factor <= x) = 1 - exp(-(x/x0)^m),  x0 = 1 / Gamma(1 + 1/m), so that the mean factor is 1.
// The draw depends on (seed, lower tag, higher tag) alone: the same on any number of ranks, after a
// restart and after any reneighbouring. Hash: SplitMix64 finaliser (Steele et al. 2014, public
// domain constants). m <= 0 switches the scatter off (factor 1); sensible m: 1-50.
// Deviations: the paper has no scatter. Verified by tests/unit/physics/weibull_strength_test.cpp.
#ifndef CALENDEM_PHYSICS_WEIBULL_STRENGTH_H
#define CALENDEM_PHYSICS_WEIBULL_STRENGTH_H

#include <cmath>
#include <cstdint>

namespace calendem {

inline std::uint64_t split_mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Uniform number in (0, 1), never 0 or 1, of a pair in either order.
inline double pair_uniform(std::uint64_t seed, std::int64_t tag_a, std::int64_t tag_b) {
  const auto low = static_cast<std::uint64_t>(tag_a < tag_b ? tag_a : tag_b);
  const auto high = static_cast<std::uint64_t>(tag_a < tag_b ? tag_b : tag_a);
  const std::uint64_t bits = split_mix(split_mix(split_mix(seed) ^ low) ^ high);
  return (static_cast<double>(bits >> 11) + 0.5) / 9007199254740992.0;
}

inline double weibull_factor(double modulus, std::uint64_t seed, std::int64_t tag_a,
                             std::int64_t tag_b) {
  if (modulus <= 0.0)
    return 1.0;
  const double scale = 1.0 / std::tgamma(1.0 + 1.0 / modulus);
  return scale * std::pow(-std::log(pair_uniform(seed, tag_a, tag_b)), 1.0 / modulus);
}

} // namespace calendem

#endif
