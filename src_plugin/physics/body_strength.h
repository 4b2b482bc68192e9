// SPDX-License-Identifier: GPL-2.0-or-later
// Strength of whole bodies: factors on sigma_c and tau_c of all bonds of a body, beside those from
// bond to bond.
//   size:    (d/d_ref)^(-a), a = 3/m with flaws all over the volume and a Weibull modulus m
//   scatter: exp(s z - s^2/2), z standard normal: lognormal, sd of the logarithm s, mean 1
// d [um]: diameter of the sphere of the body's volume. A body of diameter d_ref has on average the
// strength that is set for the bonds; there is no correction for the sizes that an electrode has.
// Range: a from 0 (off: factor 1 exactly) to 3 (m = 1); s from 0 (off) to 1; d, d_ref > 0. Energy:
// strength stores none. z depends on (seed, body) alone, and on numbers of its own, not the bonds':
// the same on any number of ranks and in any order. Normal numbers: Box & Muller 1958.
// Source: Weibull 1939, weakest link of a volume V: sigma ~ V^(-1/m); McDowell & Bolton 1998
// (Geotechnique 48, 667) for grains crushed one by one: sigma ~ d^(-3/m). Spheres of glass follow
// it from 30 um to 100 mm, minerals with two slopes (J. Soc. Powder Technol. Japan 16, 714). No
// figures for NMC were found. The scatter is lognormal, not Weibull's, so that scatter and size can
// be set apart; a Weibull law of modulus m has s = pi/(m sqrt 6).
// Deviations: flaws in the surface would give a = 2/m. A scatter from bond to bond gives bodies of
// many bonds a size effect of its own. The paper has neither. Verified by
// tests/unit/physics/body_strength_test.cpp and tests/verification/strength.
#ifndef CALENDEM_PHYSICS_BODY_STRENGTH_H
#define CALENDEM_PHYSICS_BODY_STRENGTH_H

#include "pi.h"
#include "weibull_strength.h"

namespace calendem {

/// @param exponent a [-] @param reference d_ref [um] @param diameter d [um]
inline double body_size_factor(double exponent, double reference, double diameter) {
  return exponent > 0.0 ? std::pow(diameter / reference, -exponent) : 1.0;
}

/// @param scatter s [-] @param body its number
inline double body_scatter_factor(double scatter, std::uint64_t seed, std::int64_t body) {
  if (scatter <= 0.0)
    return 1.0;
  constexpr std::uint64_t kRadius = 0x626f6479ULL << 32, kAngle = 0x626f647aULL << 32;
  const double radius = std::sqrt(-2.0 * std::log(pair_uniform(seed ^ kRadius, body, body)));
  const double turn = 2.0 * kPi * pair_uniform(seed ^ kAngle, body, body);
  return std::exp(scatter * radius * std::cos(turn) - 0.5 * scatter * scatter);
}

} // namespace calendem

#endif
