// SPDX-License-Identifier: GPL-2.0-or-later
// An electrode from an existing structure: what the structure says of cell, loading, composition
// and densities in place of the recipe; its bodies; their places.
#ifndef CALENDEM_ELECTRODE_PACK_FROM_STRUCTURE_H
#define CALENDEM_ELECTRODE_PACK_FROM_STRUCTURE_H

#include "base/recipe.h"
#include "electrode/pack/body.h"
#include "electrode/pack/packing_state.h"
#include "electrode/structure/existing_structure.h"
#include <memory>

namespace calendem {

struct FilmOfImage;

/// Body k is at[k] and made of the structure's particles ids[k]: one sphere, or one per primary in
/// the order of Body::primaries.
struct BodiesOfStructure {
  std::vector<Body> bodies; ///< largest first
  std::vector<Eigen::Vector3d> at;
  std::vector<std::vector<long>> ids;
};

/// A body of as many primaries in place of the sphere.
using MakeBody = std::function<Body(const ExistingSphere &sphere, int count, Random &random)>;

/// The primaries' total is that of the spheres' volume, to half a primary. Throws Failure(2) where
/// there are fewer of them than spheres.
BodiesOfStructure bodies_of_spheres(const Recipe &recipe, const ExistingStructure &structure,
                                    const MakeBody &make);

/// Throws Failure(2) where a cluster does not hang together or is too wide for the cell.
BodiesOfStructure bodies_of_clusters(const Recipe &recipe, const ExistingStructure &structure);

struct PlacementOfStructure {
  Placement loose;              ///< primaries body by body, then CBD in the structure's order
  double stretch = 1.0;         ///< of all heights; in.pack lets them fall back in proportion
  long moved = 0;               ///< bodies and CBD that found their place taken
  double largest_move_um = 0.0; ///< in the structure's heights
};

/// All heights are stretched, so that most neighbours come free of each other and the fall of
/// in.pack brings them back. A body or CBD sphere that still hits another is put to the nearest
/// free place found, bodies made of spheres turned as well (`bodies` are changed).
PlacementOfStructure place_as_in_structure(const Recipe &recipe, const ExistingStructure &structure,
                                           BodiesOfStructure &given);

/// At the places that bodies and CBD have, in the recipe's thickness. Where they overlap by more than
/// 0.4 of a primary's radius they are pushed apart, each body as a whole and without a turn.
PlacementOfStructure place_in_place(const Recipe &recipe, const ExistingStructure &structure,
                                    const BodiesOfStructure &given);

/// The recipe with the structure's values. Throws Failure(2) with every value that the recipe gives
/// and the structure contradicts, and every one that is out of its key's range. The total porosity
/// is that of the structure unless the recipe gives one: then the film is packed to that.
Recipe adopt(const Recipe &recipe, const ExistingStructure &structure);

/// The recipe and, if it names one, its structure: everything that `calendem pack` reads.
struct PackInput {
  Recipe recipe;
  ExistingStructure structure;              ///< empty without [structure] and shapes.places
  std::shared_ptr<const FilmOfImage> image; ///< that the structure comes from
};
PackInput read_input(const Recipe &recipe);

/// Masses [pg] that the packing must have: the file's, or by the recipe's densities.
double am_mass(const Recipe &recipe, const ExistingStructure &structure);
double cbd_mass(const Recipe &recipe, const ExistingStructure &structure);

} // namespace calendem

#endif
