// SPDX-License-Identifier: GPL-2.0-or-later
// Surface of a voxelised particle without the voxels' stairs.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_SMOOTH_SURFACE_H
#define CALENDEM_ELECTRODE_STRUCTURE_SMOOTH_SURFACE_H

#include "electrode/structure/particle_mask.h"

namespace calendem {

struct SurfaceMeasures {
  double area = 0.0;       ///< [um2]
  double volume = 0.0;     ///< enclosed by that surface [um3]
  double sphericity = 0.0; ///< surface of the sphere of equal volume over the area
};

/// Flying edges, then a windowed-sinc filter (VTK). A voxelised sphere of radius 4 voxels and more
/// has a sphericity of 1 within 2 % (test structure.SmoothSurface).
SurfaceMeasures measure_surface(const ParticleMask &mask);

} // namespace calendem

#endif
