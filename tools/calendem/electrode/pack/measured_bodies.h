// SPDX-License-Identifier: GPL-2.0-or-later
// Secondary particles with the shapes, and if asked the sizes, of a library of measured particles.
#ifndef CALENDEM_ELECTRODE_PACK_MEASURED_BODIES_H
#define CALENDEM_ELECTRODE_PACK_MEASURED_BODIES_H

#include "electrode/pack/body.h"
#include "electrode/structure/measured_shape.h"
#include <nlohmann/json_fwd.hpp>

namespace calendem {

/// The library that the recipe's [shapes] asks for: made from the image, or read. Throws
/// Failure(2).
ShapeLibrary library_of(const Recipe &recipe);
/// Writes the shapes of the recipe's image into folder/shapes and prints how many and which. Of an
/// image of phases also with a narrower and a wider neck, necks.csv, and what shows the particles:
/// slices.png with their outlines, particles.tif with their labels. Throws Failure(2).
void write_shapes(const Recipe &recipe, const std::string &folder);
/// Hash of what library_of() reads.
std::string hash_of_shapes(const Recipe &recipe);

/// Largest equivalent diameter [um] that fits the cell with shapes as elongated as the library's
/// are on average.
double largest_diameter(const Recipe &recipe, const ShapeLibrary &library);

/// The library's shape nearest to `count` lattice cells in size (one of the nine nearest, at
/// random), scaled to them and filled.
Body make_body(const Recipe &recipe, const ShapeLibrary &library, int count, Random &random);

/// Primaries per body, largest first: sizes from the library (each shape with its weight) or from
/// the recipe's law. Throws Failure(2) if none fits.
std::vector<int> draw_counts(const Recipe &recipe, const ShapeLibrary &library);

/// Bodies whose primaries add up to round(A * am_column / s^3), largest first; sizes from the
/// library (each shape with its weight) or from the recipe's law. Throws Failure(2) if none fits.
std::vector<Body> make_bodies(const Recipe &recipe, const ShapeLibrary &library);

/// For electrode.json: the library, what was cut off, measured against packed sizes.
nlohmann::json describe_shapes(const Recipe &recipe, const ShapeLibrary &library,
                               const std::vector<Body> &bodies);
/// body, shape, scale: which shape each body has.
std::string shapes_used(const ShapeLibrary &library, const std::vector<Body> &bodies);

} // namespace calendem

#endif
