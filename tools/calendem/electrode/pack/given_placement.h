// SPDX-License-Identifier: GPL-2.0-or-later
// Places the bodies and the CBD of an existing structure where they were, without overlap.
#ifndef CALENDEM_ELECTRODE_PACK_GIVEN_PLACEMENT_H
#define CALENDEM_ELECTRODE_PACK_GIVEN_PLACEMENT_H

#include "electrode/pack/given_bodies.h"
#include "electrode/pack/placement.h"

namespace calendem {

struct GivenPlacement {
  Placement loose;              ///< primaries body by body, then CBD in the structure's order
  double stretch = 1.0;         ///< of all heights; in.pack lets them fall back in proportion
  long moved = 0;               ///< bodies and CBD that found their place taken
  double largest_move_um = 0.0; ///< in the structure's heights
};

/// All heights are stretched, so that most neighbours come free of each other and the fall of
/// in.pack brings them back. A body or CBD sphere that still hits another is put to the nearest
/// free place found, bodies made of spheres turned as well (`bodies` are changed).
GivenPlacement place_as_given(const Recipe &recipe, const GivenStructure &structure,
                              GivenBodies &given);

} // namespace calendem

#endif
