// SPDX-License-Identifier: GPL-2.0-or-later
// The phase image on which structures are measured: pore, AM or CBD in every voxel. A packing or a
// simulated frame is cut into one.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_PHASE_IMAGE_H
#define CALENDEM_ELECTRODE_STRUCTURE_PHASE_IMAGE_H

#include "electrode/structure/label_image.h"
#include <vector>

namespace calendem {

enum class VoxelPhase : char { pore, am, cbd };
constexpr std::int32_t kPoreLabel = 0, kCbdLabel = -1;

/// Labels: 0 pore, -1 CBD, from 1 a body of AM each. z runs from the collector to the platen.
struct PhaseImage : LabelImage {
  bool periodic = false; ///< in x and y; an experiment's image is not

  VoxelPhase phase(size_t voxel) const {
    return label[voxel] == kPoreLabel  ? VoxelPhase::pore
           : label[voxel] == kCbdLabel ? VoxelPhase::cbd
                                       : VoxelPhase::am;
  }
  double side(int axis) const { return n[axis] * voxel[axis]; } ///< [um]
};

/// An empty image. Throws Failure(2) if it would have more than 4e8 voxels.
PhaseImage empty_phases(const std::array<int, 3> &n, const Eigen::Vector3d &voxel, bool periodic);

// Cuts a simulated frame into voxels: what a tomogram of that electrode would show.

/// A primary of AM or a CBD sphere.
struct Sphere {
  Eigen::Vector3d x;  ///< centre [um]; anywhere, the cell is periodic in x and y
  double radius;      ///< [um]
  int body;           ///< 0: CBD
  double inset = 0.0; ///< how far inside its tip its body's surface lies for others [um]
};

/// The cell between the collector at z = 0 and the platen at z = height [um].
struct Cell {
  double lx, ly, height;
};

/// AM is the envelope of each body, which holds its lattice volume N s^3 (docs/model/porosity.md):
/// every primary is a Gaussian of 0.4 lattice spacings s, and the voxels where their sum is largest
/// are the body, as many as fill N s^3. So gaps between the primaries are no pores, and a crack is
/// one once it is 0.6 s wide. CBD is what of its spheres lies outside. Bodies that overlap share
/// the voxels between them by number: what they overlap counts once. A voxel belongs to what holds
/// its centre; its sides are at most `voxel` [um], their numbers even. What lies below 0 or above
/// the platen is cut off.
/// The steps of the lattice are part of the surface: a ball of primaries has 16 % more of it than
/// the ball it stands for. A wider Gaussian (0.5 s: 7 %) reaches into the CBD between the primaries
/// (macro porosity of the demo at 150 MPa 0.7 points higher) and closes cracks; 0.3 s leaves holes.
PhaseImage voxelise(const std::vector<Sphere> &spheres, const Cell &cell, double lattice,
                    double voxel);

} // namespace calendem

#endif
