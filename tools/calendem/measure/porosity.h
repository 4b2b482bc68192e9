// SPDX-License-Identifier: GPL-2.0-or-later
// Porosity by its three definitions, and what changes through the thickness.
#ifndef CALENDEM_MEASURE_POROSITY_H
#define CALENDEM_MEASURE_POROSITY_H

#include "measure/phases.h"

namespace calendem {

/// Volumes [um3] that the definitions ask for.
struct Volumes {
  double cell = 0.0;         ///< A h, h the gap between collector and platen
  double am = 0.0;           ///< AM envelopes: lattice volume N s^3, or the closing on voxels
  double cbd_solid = 0.0;    ///< carbon and binder without their nanopores
  double cbd_envelope = 0.0; ///< part of the CBD spheres outside the AM envelopes
};

/// physics.md, section 4.
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

} // namespace calendem

#endif
