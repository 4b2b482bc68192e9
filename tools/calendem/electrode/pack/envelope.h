// SPDX-License-Identifier: GPL-2.0-or-later
// Volume of the union of what a tomogram shows as solid (physics.md, section 4): envelopes of the
// bodies (a cube of the lattice per primary) and CBD spheres, counted in voxels of at most 0.2 um.
#ifndef CALENDEM_ELECTRODE_PACK_ENVELOPE_H
#define CALENDEM_ELECTRODE_PACK_ENVELOPE_H

#include "electrode/pack/pose.h"

namespace calendem {

struct Envelope {
  double am = 0.0;    ///< union of the bodies' envelopes [um^3]
  double total = 0.0; ///< union of those and the CBD spheres [um^3]
};

Envelope measure_envelope(const Recipe &recipe, const std::vector<Particle> &particles,
                          const std::vector<Pose> &poses, double voxel = 0.2);

} // namespace calendem

#endif
