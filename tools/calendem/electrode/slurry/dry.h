// SPDX-License-Identifier: GPL-2.0-or-later
// Slurry and drying of a recipe by LIGGGHTS: in.slurry, in.drying, checks, hand-over to pack.
#ifndef CALENDEM_ELECTRODE_SLURRY_DRY_H
#define CALENDEM_ELECTRODE_SLURRY_DRY_H

#include "base/recipe.h"

namespace calendem {

// What `calendem dry` makes a film of: an electrode's recipe, and how its slurry is made and dried.

/// Those of a recipe without [structure], and [slurry] and [drying].
const std::vector<Key> &film_keys();

/// Lengths um, densities g/cm3, fractions 0-1.
struct FilmRecipe {
  Recipe recipe;
  double solid_content;    ///< mass of solids over mass of the slurry
  double solvent_density;  ///< g/cm3
  double sphere_fraction;  ///< of the slurry's volume: AM and swollen CBD spheres
  bool to_thickness;       ///< drying ends at the recipe's thickness, else when the film bears load
  double capillary_MPa;    ///< what the receding surface can press with
  double tolerance_points; ///< of the dried film's porosity, percentage points

  double solvent_column() const; ///< solvent per area [um]
  /// Thickness of the wet coating: solids and solvent, volumes added up (ideal mixing) [um].
  double slurry_thickness() const;
  double slurry_density() const;   ///< by the same rule [g/cm3]
  double cbd_dry_envelope() const; ///< CBD spheres with their nanopores, per area [um]
  double wet_diameter() const;     ///< of a CBD sphere that holds solvent [um]
  double wet_density() const;      ///< of that sphere with its solvent [g/cm3]
};

/// Throws Failure(2) with every mistake of the file.
FilmRecipe read_film_recipe(const std::string &file);

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
