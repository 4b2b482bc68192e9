// SPDX-License-Identifier: GPL-2.0-or-later
// The [structure] table of a recipe: an existing structure that takes the place of the recipe's
// sizes and places.
#ifndef CALENDEM_BASE_STRUCTURE_SOURCE_H
#define CALENDEM_BASE_STRUCTURE_SOURCE_H

#include "base/toml_reader.h"
#include <set>

namespace calendem {

struct StructureSource {
  std::string file, body_map; ///< absolute
  std::string atom_style;
  double length_um = 1.0, density_g_cm3 = 1.0; ///< one unit of the file
  bool z_periodic = false;
  std::set<int> am_types, cbd_types, left_out_types;
  bool clusters = false;         ///< AM spheres are primaries of given bodies, else a body each
  bool densities_of_file = true; ///< else the recipe's
  bool given() const { return !file.empty(); }
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

} // namespace calendem

#endif
