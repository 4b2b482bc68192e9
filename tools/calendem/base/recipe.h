// SPDX-License-Identifier: GPL-2.0-or-later
// The recipe of an electrode (electrode.toml): what `calendem pack` makes.
#ifndef CALENDEM_BASE_RECIPE_H
#define CALENDEM_BASE_RECIPE_H

#include "base/material.h"
#include "base/toml_reader.h"
#include "physics/cbd_gradient.h"
#include <cstdint>
#include <set>

namespace calendem {

// The [structure] table: an existing structure that takes the place of the recipe's sizes and places.

struct StructureSource {
  std::string file, body_map; ///< absolute
  std::string atom_style;
  double length_um = 1.0, density_g_cm3 = 1.0; ///< one unit of the file
  bool z_periodic = false;
  std::set<std::string> am_types, cbd_types, left_out_types; ///< numbers, or labels of the file
  bool clusters = false;         ///< AM spheres are primaries of given bodies, else a body each
  bool densities_of_file = true; ///< else the recipe's
  std::string frame = "last";    ///< of a dump, or its time step
  double side_x = 0.0,
         side_y = 0.0;   ///< of the recipe's cell, for a table or image without a box [um]; 0: none
  bool of_image = false; ///< [shapes] has the places: the film is cut out of its image
  bool given() const { return !file.empty() || of_image; }
};

const std::vector<Key> &structure_keys();

/// One unit of length [um] and of density [g/cm3]; "micro", "si" or "cgs".
struct DataUnits {
  double length_um, density_g_cm3;
};
DataUnits units_named(const std::string &units);

/// Paths are relative to the recipe `file`.
StructureSource read_structure_source(const Settings &settings, const std::string &file,
                                      Mistakes &mistakes);

const std::vector<Key> &recipe_keys();

/// Labels of an image of phases.
struct PhaseLabels {
  std::int32_t pore = 0;
  std::int32_t am = 0;  ///< that of the pores: the labels are particles, not phases
  std::int32_t cbd = 0; ///< that of the pores: there is none
  bool given() const { return am != pore; }
};

/// Where the outer shapes of bodies come from; both paths empty: generated.
struct ShapeSource {
  std::string image, library; ///< absolute
  double voxel_um = 0.0;      ///< 0: from the image
  std::int32_t background = 0;
  PhaseLabels phases;
  double neck = 0.9;          ///< see separate_particles()
  bool measured_sizes = true; ///< else the recipe's lognormal law
  bool in_place = false;      ///< the image is the electrode, its particles are where they are
  std::string upwards = "z";  ///< axis of that image from the collector up; -z: it runs down
  double middle_x = 0.0, middle_y = 0.0; ///< of the crop, from the image's [um]
  double low = 0.0, high = 0.0;          ///< heights of the crop [um]; 0: of the image's top
  bool given() const { return !image.empty() || !library.empty(); }
};

/// Lengths um, densities g/cm3 (= pg/um3), loading mg/cm2, fractions 0-1.
/// What a body's primaries are.
enum class GrainShape { Lattice, Voronoi };

struct Recipe {
  std::string file;
  Settings settings;
  double am_weight, am_density, cbd_solid_density;
  double loading, porosity_total;
  double median, sigma_ln, min_diameter, max_diameter, max_width_fraction, irregularity;
  GrainShape grains = GrainShape::Lattice;
  double primary_diameter, lattice; ///< lattice^3: volume that a primary stands for
  double nanoporosity, cbd_diameter;
  CbdGradient cbd_gradient;
  double cell_x, cell_y;
  unsigned long seed;
  ShapeSource shapes;
  StructureSource structure;
  ReferenceMaterial material;

  double area() const { return cell_x * cell_y; }
  double am_column() const;        ///< solid AM per area [um]
  double cbd_solid_column() const; ///< solid carbon + binder per area [um]
  double thickness() const;        ///< of the coating [um]
  double bond_distance() const;    ///< up to which two primaries of a body are bonded [um]
  double widest_body() const;      ///< largest width of a body that the cell allows [um]
  /// The largest equivalent diameter [um]: the distribution's, or that of a body within the width.
  /// It is wider than its equivalent sphere by about a primary and, at the worst, by its
  /// irregularity; the width itself is kept by drawing the shape again (make_bodies).
  double largest_body() const;
};

/// Distance [um] up to which LIGGGHTS lists neighbours of the widest particle: contact distance
/// factor 1.1 and the skin. A periodic side must be at least twice as long.
double neighbour_cut_off(double diameter);
/// Ranks that a cell can be shared by, each part at least a cut-off wide (z is not split).
int most_ranks(double lx, double ly, double diameter);

/// The [shapes] section; paths are relative to `file`.
ShapeSource read_shapes(const Settings &settings, const std::string &file, Mistakes &mistakes);

/// The material of the file's settings, whose values they take.
ReferenceMaterial take_material(Settings &settings, const std::string &file,
                                const std::vector<Key> &keys, Mistakes &mistakes);

/// With shapes.places = "image" the film comes from the image as from a structure.
void take_places_of_image(const Settings &settings, Recipe &recipe, Mistakes &mistakes);

/// The recipe's numbers, without shapes, structure and material; what they contradict.
Recipe recipe_of(const Settings &settings);
void check_recipe(const Settings &settings, const Recipe &recipe, Mistakes &mistakes);

/// Throws Failure(2) with every mistake of the file.
Recipe read_recipe(const std::string &file);

/// In what a recipe's settings make another electrode than `wanted`, by more than 2 %: composition,
/// densities, porosity before calendering, sizes, CBD. "key: 2.2 instead of 4.65". Loading, cell
/// and seed may differ. `recipe` has what its structure changed, but sizes, which do not count then;
/// an image's particles, and other than those of the structure that is wanted, differ.
std::vector<std::string> other_electrode(const std::map<std::string, std::string> &wanted,
                                         const std::map<std::string, std::string> &recipe);

} // namespace calendem

#endif
