// SPDX-License-Identifier: GPL-2.0-or-later
// An existing structure by phase: what slurry, drying or packing simulations left in a data file.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_EXISTING_STRUCTURE_H
#define CALENDEM_ELECTRODE_STRUCTURE_EXISTING_STRUCTURE_H

#include "base/recipe.h"
#include "physics/pi.h"
#include <Eigen/Core>

namespace calendem {

struct ExistingSphere {
  long id = 0;
  int type = 0;
  long cluster = 0; ///< 0: none
  double diameter = 0.0, density = 0.0;
  Eigen::Vector3d x; ///< inside the cell; z from the lowest point of the film

  double volume() const { return kPi / 6.0 * diameter * diameter * diameter; }
  double mass() const { return density * volume(); }
};

/// Lengths um, densities g/cm3, periodic in x and y.
struct ExistingStructure {
  double lx = 0.0, ly = 0.0;
  double extent = 0.0;    ///< from the lowest to the highest point of a sphere
  double thickness = 0.0; ///< of the film: the extent; at most the box where that is periodic in z
  std::vector<ExistingSphere> am, cbd; ///< by id
  long left_out = 0;                   ///< spheres of the types to leave out
};

/// Throws Failure(2) with every mistake of the data file and the body map.
ExistingStructure read_structure(const StructureSource &source);
/// Hash of what read_structure() reads; empty without a structure.
std::string hash_of_structure(const StructureSource &source);

} // namespace calendem

#endif
