// SPDX-License-Identifier: GPL-2.0-or-later
// Places bodies and CBD spheres without overlap in a tall cell, for the simulation to densify.
#ifndef CALENDEM_ELECTRODE_PACK_PLACEMENT_H
#define CALENDEM_ELECTRODE_PACK_PLACEMENT_H

#include "electrode/pack/body.h"

namespace calendem {

struct Particle {
  int tag = 0;
  int type = 0; ///< 1 primary sphere, 2 CBD
  double diameter = 0.0, density = 0.0;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  int body = 0; ///< 0: none
};

struct Placement {
  std::vector<Particle> particles; ///< by tag; primaries first, body by body
  double height = 0.0;             ///< of the tall cell [um]
};

/// Density [g/cm3] of a primary sphere with which a body weighs its envelope volume times
/// am_density.
double primary_density(const Recipe &recipe);
/// Density [g/cm3] of a CBD sphere, nanopores included.
double cbd_density(const Recipe &recipe);
int cbd_count(const Recipe &recipe);

/// a - b as it comes nearest in a cell that is periodic in x and y.
Eigen::Vector3d periodic_difference(const Recipe &recipe, const Eigen::Vector3d &a,
                                    const Eigen::Vector3d &b);
/// The image of x inside the cell.
Eigen::Vector3d in_cell(const Recipe &recipe, Eigen::Vector3d x);

/// Bodies (largest first) and then CBD spheres at random places without overlap, in a cell three
/// times as high as they need, or higher where they find no room.
Placement place(const Recipe &recipe, const std::vector<Body> &bodies);

} // namespace calendem

#endif
