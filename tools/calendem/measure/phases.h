// SPDX-License-Identifier: GPL-2.0-or-later
// What is counted on a phase image: porosity by its three definitions, profiles, surface. A label
// image of an experiment becomes one, a simulated frame by voxelise().
#ifndef CALENDEM_MEASURE_PHASES_H
#define CALENDEM_MEASURE_PHASES_H

#include "electrode/structure/phase_image.h"
#include <optional>

namespace calendem {

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

/// Volumes [um3] that the definitions ask for.
struct Volumes {
  double cell = 0.0;         ///< A h, h the gap between collector and platen
  double am = 0.0;           ///< AM envelopes: lattice volume N s^3, or the closing on voxels
  double cbd_solid = 0.0;    ///< carbon and binder without their nanopores
  double cbd_envelope = 0.0; ///< part of the CBD spheres outside the AM envelopes
};

/// See docs/model/porosity.md.
struct Porosity {
  double total = 0.0; ///< 1 - (V_AM + V_CBD,solid)/(A h)
  double macro = 0.0; ///< 1 - (V_AM + V_CBD,envelope)/(A h): what a tomogram resolves
  double nano = 0.0;  ///< total - macro: inside CBD
};
Porosity porosity(const Volumes &volumes);

/// Solid share of what the voxels show: true volume over that of the voxels.
struct Density {
  double am = 1.0, cbd = 1.0;
};

struct Slice {
  double from = 0.0, to = 0.0; ///< [um] above the collector
  PhaseFractions fraction;     ///< of its voxels; .pore is its macro porosity
  double porosity_total = 0.0; ///< 1 - the solid in AM and CBD
  long bonds = 0, broken = 0;  ///< whose mid-point lies in it
};

/// Slices of whole layers of voxels, as near to `thickness` [um] as they come: their thicknesses
/// differ by one layer at most. Their means, weighted with the thickness, are those of the image.
std::vector<Slice> profile(const PhaseImage &image, const Density &density, double thickness);

/// A bond by the height of its mid-point [um].
struct BondAt {
  double z;
  bool broken;
};
/// Bonds below the first or above the last slice count there.
void count_bonds(const std::vector<BondAt> &bonds, std::vector<Slice> &slices);

/// Area per volume of the image [1/um]. Collector, platen and the image's sides are no surfaces.
struct SurfaceArea {
  double pore_am = 0.0, pore_cbd = 0.0, am_cbd = 0.0;
  double pore_solid() const { return pore_am + pore_cbd; }
};

/// Cauchy-Crofton: S/V = 2 x the mean number of intersections per length of a line, here along the
/// 13 directions between a voxel and its 26 neighbours, each with the share of directions that are
/// nearest to it (Lehmann & Legland, Efficient N-dimensional surface estimation using Crofton
/// formula and run-length encoding, 2012; the shares are found for the voxel's own sides).
/// *Deviations*: none. Parts thinner than about 4 voxels are missed in part. Errors (test
/// structure.SurfaceArea): spheres 7 % at 4 voxels radius, 2 % from 5, 1 % from 12; planes,
/// whatever their direction, 8 % (12 % on slices twice as thick as a pixel is wide). Beyond the
/// image's sides it is taken to go on as inside.
SurfaceArea surface_area(const PhaseImage &image);

} // namespace calendem

#endif
