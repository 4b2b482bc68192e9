// SPDX-License-Identifier: GPL-2.0-or-later
// What the strength of a contact law may be between two phases, beside its key's own range: with
// the cohesion and the modulus that the phases have, some values let a packing collapse.
#ifndef CALENDEM_PHYSICS_LAW_LIMITS_H
#define CALENDEM_PHYSICS_LAW_LIMITS_H

#include <limits>

namespace calendem {

/// Two phases that meet: cohesion energy density [kPa] and effective modulus [kPa].
struct PhasePair {
  double cohesion, modulus;
};

/// Values that a law's first property may have where it acts, in the script's units, and why.
struct ContactLimits {
  double least = 0.0;
  double most = std::numeric_limits<double>::infinity();
  const char *why = "";
};

} // namespace calendem

#endif
