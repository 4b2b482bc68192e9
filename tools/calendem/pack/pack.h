// SPDX-License-Identifier: GPL-2.0-or-later
// Makes an electrode of a recipe: places, densifies and relaxes it by running LIGGGHTS, checks it.
#ifndef CALENDEM_PACK_PACK_H
#define CALENDEM_PACK_PACK_H

#include "spec/recipe.h"
#include <string>

namespace calendem {

struct PackOptions {
  std::string folder;
  std::string liggghts;
  int ranks = 2;
};

/// Throws Failure: 2 bad recipe or folder, 3 the simulation failed, 4 the packing misses its
/// targets.
void pack_electrode(const Recipe &recipe, PackOptions options);

/// What is checked of a packing; see physics.md, section 5, for the reference overlap.
struct PackingState {
  double largest_body_force_nN = 0.0; ///< Hertz less SJKR between primaries of different bodies
  double largest_bond_strain = 0.0;   ///< |r/s - 1| over lattice neighbours
  double cbd_overlap_mean = 0.0;      ///< over diameters, touching CBD pairs
  double cbd_overlap_max = 0.0;
  double highest_particle_um = 0.0;
};

} // namespace calendem

#endif
