// SPDX-License-Identifier: GPL-2.0-or-later
// Slurry and drying of a recipe by LIGGGHTS: the particles, in.slurry, in.drying, checks, hand-over
// to pack.
#ifndef CALENDEM_ELECTRODE_SLURRY_DRY_H
#define CALENDEM_ELECTRODE_SLURRY_DRY_H

#include "base/recipe.h"
#include "electrode/pack/electrode_files.h"
#include "electrode/pack/packing_state.h"
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace calendem {

// What `calendem dry` makes a film of: an electrode's recipe, and how its slurry is made and dried.

/// Keys of a recipe without [structure], and [slurry] and [drying].
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

// The particles of a slurry (a sphere for each secondary particle of the recipe, and its CBD), what
// slurry and drying leave in their folder, and whether it is what the recipe asks for.

/// Variables that in.slurry and in.drying include; the cell starts `height` [um] high.
std::string film_variables(const FilmRecipe &film, double height);

/// Takes positions from a dump with columns id x y z radius. Throws Failure(3) if a particle is
/// missing, there twice, or has not its diameter: the script did not swell or shrink it.
void read_state(const FilmRecipe &film, const std::string &dump, std::vector<Particle> &particles);

/// `particles` where the stirring left them, CBD swollen; `end`: of slurry.csv.
nlohmann::json describe_slurry(const FilmRecipe &film, const std::vector<Particle> &particles,
                               const LastRow &end);
/// `particles` as dried; `stop`: when the surface stopped, `end`: when all was at rest.
nlohmann::json describe_film(const FilmRecipe &film, const std::vector<Particle> &particles,
                             const LastRow &stop, const LastRow &end);

/// Throw Failure(4) with every target missed and by how much.
void check_slurry(const nlohmann::json &slurry, const std::string &folder);
void check_film(const nlohmann::json &dried, const FilmRecipe &film, const std::string &folder);

/// The recipe with which `calendem pack` reads dried.data beside it.
std::string hand_over(const FilmRecipe &film);
/// id, phase, diameter, place in the slurry and in the film of every particle.
std::string film_table(const std::vector<Particle> &slurry, const std::vector<Particle> &dried);

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
