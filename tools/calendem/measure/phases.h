// SPDX-License-Identifier: GPL-2.0-or-later
// The phase image on which structures are measured: pore, AM or CBD in every voxel. A simulated
// frame is cut into one (measure_voxelise.h), a label image of an experiment becomes one; from
// there on both go through the same code.
#ifndef CALENDEM_MEASURE_PHASES_H
#define CALENDEM_MEASURE_PHASES_H

#include "electrode/structure/label_image.h"
#include <optional>

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

/// Number of the neighbour of voxel (i,j,k) at the offset (a,b,c); -1 outside the image. x and y
/// wrap around in a periodic image.
inline long neighbour(const PhaseImage &image, int i, int j, int k, int a, int b, int c) {
  i += a, j += b, k += c;
  if (image.periodic) {
    i = (i + image.n[0]) % image.n[0];
    j = (j + image.n[1]) % image.n[1];
  }
  const bool in = i >= 0 && j >= 0 && k >= 0 && i < image.n[0] && j < image.n[1] && k < image.n[2];
  return in ? long(image.index(i, j, k)) : -1;
}

/// `background` becomes pore, `cbd` CBD, every other label a body of AM, numbered from 1.
PhaseImage phases_of(const LabelImage &image, std::int32_t background,
                     std::optional<std::int32_t> cbd);

/// Shares of the voxels.
struct PhaseFractions {
  double pore = 0.0, am = 0.0, cbd = 0.0;
};
PhaseFractions phase_fractions(const PhaseImage &image);

/// Every `stride`-th voxel along each axis: the image that voxels so many times larger would give.
/// Throws Failure(2) if the image is not that wide.
PhaseImage every_nth(const PhaseImage &image, int stride);

} // namespace calendem

#endif
