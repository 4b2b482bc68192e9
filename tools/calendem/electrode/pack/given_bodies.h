// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies of an existing structure: of each AM sphere one of the same volume, or its own clusters.
#ifndef CALENDEM_ELECTRODE_PACK_GIVEN_BODIES_H
#define CALENDEM_ELECTRODE_PACK_GIVEN_BODIES_H

#include "electrode/pack/body.h"
#include "electrode/structure/given_structure.h"

namespace calendem {

/// Body k is at[k] and made of the structure's particles ids[k]: one sphere, or one per primary in
/// the order of Body::primaries.
struct GivenBodies {
  std::vector<Body> bodies; ///< largest first
  std::vector<Eigen::Vector3d> at;
  std::vector<std::vector<long>> ids;
};

/// A body of as many primaries.
using MakeBody = std::function<Body(int count, Random &random)>;

/// The primaries' total is that of the spheres' volume, to half a primary. Throws Failure(2) where
/// there are fewer of them than spheres.
GivenBodies bodies_of_spheres(const Recipe &recipe, const GivenStructure &structure,
                              const MakeBody &make);

/// Throws Failure(2) where a cluster does not hang together or is too wide for the cell.
GivenBodies bodies_of_clusters(const Recipe &recipe, const GivenStructure &structure);

} // namespace calendem

#endif
