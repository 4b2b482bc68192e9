// SPDX-License-Identifier: GPL-2.0-or-later
// Binder bridges: what the dried binder holds together beside the contacts. A bridge is a parallel
// bond (physics/parallel_bond.h, eqs 4-5) of the carbon-binder domain with its own modulus, radius
// and strengths, from CBD to CBD, to active material and to the collector.
//
//   made     once, at the start, where the film as packed has the spheres at most `gap` apart:
//              r <= R_i + R_j + gap;  on the collector height <= R + gap
//   length   l = r, the distance of the centres then; on the collector the height of the centre
//            above it. There a bridge has no load: forces of a fresh film are those without bridges
//   radius   lambda min(R_i, R_j); on the collector lambda R
//   breaks   sigma >= sigma_c or tau >= tau_c of eqs 6-7, tension positive (bond_failure.h), with
//            sigma_c by the phases that it joins and tau_c = ratio sigma_c
//
// The pair's contact goes on beside it as if there were no bridge: Hertz or the law of an effect,
// friction, and SJKR, all from the reference d_0 of acting_contact.h, e.g. the inset S of a body's
// surface, which neither the making of a bridge nor its break changes. So nothing jumps when a
// bridge breaks but its own force; what is left is an ordinary contact. Where the bridges alone
// shall hold, the cohesion energy density is to be 0. The bridge itself has no d_0: a parallel bond
// goes from centre to centre, and its strain counts from its creation.
// A bridge on the collector ends at the point of the wall below the centre at its creation, which
// stands for the second sphere: at rest, without spin.
// Signs and energy: as in parallel_bond.h; a break loses the strain energy.
// Range: sigma_c/E <= 0.03 (kMostStrain), so that a bridge breaks before its history ends; gaps up
// to 0.05 um (kMostGap). Spheres keep their radii: nanopores must not collapse.
// Source: Potyondy & Cundall 2004, doi:10.1016/j.ijrmms.2004.09.011. Failure of coatings on their
// foil under tension and shear: Luo et al. 2018, doi:10.1039/c7ra12382e (shear strength almost
// twice the tensile one). PVDF and its composites with carbon black break below 10 % elongation:
// Chen, Christensen & Dahn, J. Electrochem. Soc. 2003.
// Deviations: none from parallel_bond.h; the collector's foil does not bend. A packing knows no
// inset and leaves CBD at the tips of primaries: there a bridge joins surfaces up to S + gap apart.
// One of surfaces in touch is shorter by S than one of tips, and stiffer by S/l: 7 % at 0.09 um.
// Verified by tests/verification/binder_bridges.
#ifndef CALENDEM_PHYSICS_BINDER_BRIDGE_H
#define CALENDEM_PHYSICS_BINDER_BRIDGE_H

#include "bond_failure.h"

namespace calendem {

/// Numbers are those of what the host writes; None: the phases have no bridge.
enum class BridgeKind { None = -1, AmCbd = 0, CbdCbd = 1, CbdCollector = 2 };
inline constexpr int kBridgeKinds = 3;

struct BinderBridges {
  static constexpr double kMostStrain = 0.03; ///< sigma_c / E [-]
  static constexpr double kMostGap = 0.05;    ///< [um]

  double gap = 0.0;                  ///< [um]
  double tensile[kBridgeKinds] = {}; ///< sigma_c by kind [kPa]; 0: none are made
  double shear_ratio = 1.0;          ///< tau_c / sigma_c [-]

  bool on() const { return tensile[0] > 0.0 || tensile[1] > 0.0 || tensile[2] > 0.0; }
  /// True where a bridge is made: `contact` is the sum of radii, or the radius at the collector.
  bool spans(double contact, double distance) const { return distance <= contact + gap; }
  double tensile_of(BridgeKind kind) const {
    return kind == BridgeKind::None ? 0.0 : tensile[static_cast<int>(kind)];
  }
};

/// Motion against a wall at rest: `arm` from the bridge's point of the wall to the centre [um].
inline PairMotion motion_on_wall(const Vec3 &arm, const Vec3 &v, const Vec3 &spin) {
  return pair_motion(arm, norm(arm), v, spin, {});
}

} // namespace calendem

#endif
