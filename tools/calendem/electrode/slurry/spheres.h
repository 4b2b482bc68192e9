// SPDX-License-Identifier: GPL-2.0-or-later
// The particles of a slurry: a sphere for each secondary particle of the recipe, and its CBD.
#ifndef CALENDEM_ELECTRODE_SLURRY_SPHERES_H
#define CALENDEM_ELECTRODE_SLURRY_SPHERES_H

#include "electrode/pack/placement.h"
#include "electrode/slurry/film_recipe.h"

namespace calendem {

/// Types 1 (AM, largest first) and 2 (CBD, dry), by tag, at random places without overlap in a cell
/// of half again the slurry's thickness. An AM sphere has the volume of `counts` whole primaries,
/// so that the electrode that `pack` makes of the film has the recipe's mass to half a primary.
Placement place_spheres(const FilmRecipe &film, const std::vector<int> &counts);

/// How well two kinds of particles are mixed in z: Lacey's index over `slabs` slices of the height,
/// (s0^2 - s^2)/(s0^2 - sr^2) with s^2 the variance of the CBD's share of the number, s0^2 = p(1-p)
/// when separated and sr^2 = p(1-p)/n when mixed at random; 1 +- its scatter when mixed.
/// Source: Lacey, J. Appl. Chem. 4, 257 (1954).
double mixing_index(const std::vector<Particle> &particles, double height, int slabs);

} // namespace calendem

#endif
