// SPDX-License-Identifier: GPL-2.0-or-later
// Single particles of a label image: where each label lies, its voxels with pores closed, and its
// surface without the voxels' stairs.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_PARTICLE_MASK_H
#define CALENDEM_ELECTRODE_STRUCTURE_PARTICLE_MASK_H

#include "electrode/structure/label_image.h"

namespace calendem {

/// Box of a label, in voxels.
struct Region {
  std::int32_t label = 0;
  std::array<int, 3> low = {0, 0, 0}, high = {0, 0, 0}; ///< both included
  long voxels = 0;
  bool cut = false; ///< touches the border of the image
};

/// All labels but the background, by number.
std::vector<Region> find_regions(const LabelImage &image, std::int32_t background);

/// One particle in a box with one empty voxel all around.
struct ParticleMask {
  std::array<int, 3> n = {0, 0, 0};
  Eigen::Vector3d voxel = Eigen::Vector3d::Ones(); ///< [um]
  std::vector<char> inside;                        ///< x runs fastest
  long solid_voxels = 0;                           ///< of the largest connected part
  long pore_voxels = 0;                            ///< closed inside it, filled
  long loose_voxels = 0;                           ///< of the label but not connected, dropped

  size_t index(int i, int j, int k) const { return (size_t(k) * n[1] + j) * n[0] + i; }
  /// Envelope volume, pores closed [um3].
  double volume() const { return double(solid_voxels + pore_voxels) * voxel.prod(); }
};

/// The largest part of the label that is connected by faces; what it encloses is filled.
ParticleMask extract_particle(const LabelImage &image, const Region &region);

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
