// SPDX-License-Identifier: GPL-2.0-or-later
// Coordination numbers from overlaps of spheres; the same and broken bodies as voxels show them.
#ifndef CALENDEM_MEASURE_CONTACTS_H
#define CALENDEM_MEASURE_CONTACTS_H

#include "measure/voxelise.h"

namespace calendem {

/// Two bodies touch if a primary of one overlaps a primary of the other; fragments of a body count
/// as that body. Each partner counts once, however many primaries touch. Means; 0 where there is
/// nothing to count.
struct Coordination {
  int bodies = 0, cbd = 0;
  double am_am = 0.0;          ///< other bodies that a body touches
  double am_cbd = 0.0;         ///< CBD spheres that a body touches
  double cbd_am = 0.0;         ///< bodies that a CBD sphere touches
  double cbd_cbd = 0.0;        ///< other CBD spheres that a CBD sphere touches
  double am_without_am = 0.0;  ///< share of the bodies that touch no other body
  double am_without_any = 0.0; ///< share of the bodies that touch nothing
};

Coordination coordination(const std::vector<Sphere> &spheres, const Cell &cell);

/// What voxels show of the bodies, in a simulated structure as in a tomogram. It depends on the
/// size of the voxels: narrower gaps and cracks are not seen.
struct VoxelBodies {
  int bodies = 0;
  double am_am = 0.0; ///< mean number of other bodies that share a face of a voxel with a body
  int whole = 0;      ///< bodies that no side of the image cuts and of at least 200 voxels
  int in_pieces = 0;  ///< of those: the largest part connected by faces has less than 95 %
};

VoxelBodies bodies_on_voxels(const PhaseImage &image);

} // namespace calendem

#endif
