// SPDX-License-Identifier: GPL-2.0-or-later
// What the script sets for all bonds of a kind, and how far a bond may stretch.
#ifndef CALENDEM_BOND_SETTINGS_H
#define CALENDEM_BOND_SETTINGS_H

#include "laws/bond_laws.h"
#include "physics/bond_pair.h"

namespace LAMMPS_NS {

// Neighbours are listed, and histories kept, up to this multiple of the sum of radii. 1.1 is ample
// for brittle bonds; 1.2 would list the lattice's diagonal neighbours.
constexpr double kContactDistanceFactor = 1.1;
constexpr double kStretchLimit = 0.98 * kContactDistanceFactor;

/// Stresses in kPa.
struct BondSettings {
  calendem::BondMaterial material;
  calendem::BondStrength strength = {0.0, 0.0};
  calendem::FailureCriterion criterion = calendem::FailureCriterion::Signed;
  calendem::BondStrengths strengths; ///< from bond to bond
  bool breakable = true;
  double reach = calendem::kBondReach; ///< of a bond when it is made, over the sum of radii
  double contact_diameter = 1.0;       ///< of a body's primaries that meet, over the sum of radii
  double surface_inset = 0.0;          ///< how far inside a primary its surface is for others [um]
  double inset_fading = 0.0;           ///< part of it that goes as the primary's bonds break

  calendem::BondStrength strength_of(double factor) const {
    return {factor * strength.tensile, factor * strength.shear};
  }
};

} // namespace LAMMPS_NS

#endif
