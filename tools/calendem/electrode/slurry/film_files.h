// SPDX-License-Identifier: GPL-2.0-or-later
// The particles of a slurry (a sphere for each secondary particle of the recipe, and its CBD), what
// slurry and drying leave in their folder, and whether it is what the recipe asks for.
#ifndef CALENDEM_ELECTRODE_SLURRY_FILM_FILES_H
#define CALENDEM_ELECTRODE_SLURRY_FILM_FILES_H

#include "electrode/pack/description.h"
#include "electrode/pack/packing_state.h"
#include "electrode/slurry/dry.h"
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace calendem {

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
