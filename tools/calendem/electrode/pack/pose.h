// SPDX-License-Identifier: GPL-2.0-or-later
// Where a body ended: its primaries joined again across the periodic faces, and the rigid motion
// that comes nearest to what happened to it.
#ifndef CALENDEM_ELECTRODE_PACK_POSE_H
#define CALENDEM_ELECTRODE_PACK_POSE_H

#include "electrode/pack/placement.h"

namespace calendem {

struct Pose {
  Eigen::Vector3d centre;  ///< of mass, inside the cell [um]
  Eigen::Quaterniond turn; ///< orientation of the cubic lattice; a single primary keeps its first
  double distortion = 0.0; ///< largest distance of a primary from the rigid body [um]
};

/// Poses in the order of `bodies`, whose primaries are the first particles, body by body.
std::vector<Pose> find_poses(const Recipe &recipe, const std::vector<Body> &bodies,
                             const std::vector<Particle> &particles);

} // namespace calendem

#endif
