// SPDX-License-Identifier: GPL-2.0-or-later
// Irregular grains: the cells of a centroidal Voronoi tessellation of a body's hull, one primary at
// the centre of each. Source: Lloyd's iteration, IEEE Trans. Inf. Theory 28 (1982) 129; Du, Faber,
// Gunzburger, SIAM Review 41 (1999) 637. Verified by tests/unit/pack/grains_test.cpp.
#ifndef CALENDEM_ELECTRODE_PACK_GRAINS_H
#define CALENDEM_ELECTRODE_PACK_GRAINS_H

#include "electrode/pack/hull.h"
#include <vector>

namespace calendem {

/// Fewer grains than this are squeezed together by their hull: a body of so few is a lattice's.
constexpr int kFewestGrains = 5;

struct Grains {
  /// In an order in which each but the first is bonded to one before it [um]; empty where the
  /// tessellation fell apart.
  std::vector<Eigen::Vector3d> centres;
  double facet = 0.0; ///< area between two cells, mean over the bonds [um^2]
};

/// `count` grains of `volume` [um^3] each, no point of a cell beyond `farthest` [um] from the
/// origin; two are bonded up to `bond` [um] apart.
Grains make_grains(const Hull &hull, int count, double volume, double farthest, double bond,
                   Random &random);

/// Centres of a centroidal Voronoi tessellation of the points, which lie about evenly: `width` is
/// that of a cell [um]. As many as there are points at most.
std::vector<Eigen::Vector3d> spread_centres(const std::vector<Eigen::Vector3d> &points, int count,
                                            double width, Random &random);

} // namespace calendem

#endif
