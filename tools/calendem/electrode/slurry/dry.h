// SPDX-License-Identifier: GPL-2.0-or-later
// Slurry and drying of a recipe by LIGGGHTS: in.slurry, in.drying, checks, hand-over to pack.
#ifndef CALENDEM_ELECTRODE_SLURRY_DRY_H
#define CALENDEM_ELECTRODE_SLURRY_DRY_H

#include "electrode/slurry/film_recipe.h"

namespace calendem {

struct DryOptions {
  std::string folder;
  std::string liggghts;
  int ranks = 1;
};

/// Writes dried.data, electrode.toml (the recipe for pack), film.csv, film.json into the folder.
/// What is there of the same recipe is not made again. Throws Failure: 2 bad input, 3 the
/// simulation failed, 4 a target was missed (film.rejected.json says by how much).
void dry_film(const FilmRecipe &film, DryOptions options);

} // namespace calendem

#endif
