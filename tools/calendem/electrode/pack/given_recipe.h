// SPDX-License-Identifier: GPL-2.0-or-later
// What an existing structure says of cell, loading, composition and densities, in place of the
// recipe's defaults.
#ifndef CALENDEM_ELECTRODE_PACK_GIVEN_RECIPE_H
#define CALENDEM_ELECTRODE_PACK_GIVEN_RECIPE_H

#include "base/recipe.h"
#include "electrode/structure/given_structure.h"

namespace calendem {

/// The recipe with the structure's values. Throws Failure(2) with every value that the recipe gives
/// and the structure contradicts, and every one that is out of its key's range. The total porosity
/// is that of the structure unless the recipe gives one: then the film is packed to that.
Recipe adopt(const Recipe &recipe, const GivenStructure &structure);

/// The recipe and, if it names one, its structure: everything that `calendem pack` reads.
struct PackInput {
  Recipe recipe;
  GivenStructure structure; ///< empty without [structure]
};
PackInput read_input(const Recipe &recipe);

/// Masses [pg] that the packing must have: the file's, or by the recipe's densities.
double am_mass(const Recipe &recipe, const GivenStructure &structure);
double cbd_mass(const Recipe &recipe, const GivenStructure &structure);

} // namespace calendem

#endif
