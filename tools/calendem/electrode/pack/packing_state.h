// SPDX-License-Identifier: GPL-2.0-or-later
// What is measured of a finished packing, from positions alone: overlaps, forces, the volume that a
// tomogram shows as solid, and where each body ended.
#ifndef CALENDEM_ELECTRODE_PACK_PACKING_STATE_H
#define CALENDEM_ELECTRODE_PACK_PACKING_STATE_H

#include "electrode/pack/placement.h"

namespace calendem {

/// What a setting of the case is unless given.
double case_default(const std::string &key);

/// Stiffness and cohesion at which a packing is relaxed and its forces are judged: a case's unless
/// given. Handed to in.pack as variables.
struct FinalMaterial {
  double E_am_GPa = case_default("material.am.youngs_modulus_GPa");
  double E_cbd_GPa = case_default("material.cbd.youngs_modulus_GPa");
  double nu_am = case_default("material.am.poisson"), nu_cbd = case_default("material.cbd.poisson");
  double ced_am_J_m3 = case_default("material.am.ced_J_m3");
  double ced_cbd_J_m3 = case_default("material.cbd.ced_J_m3");
};

/// Overlaps of touching pairs over the radius of the CBD sphere.
struct Overlaps {
  int pairs = 0;
  double mean = 0.0, largest = 0.0;
};

struct PackingState {
  double body_force_nN = 0.0;   ///< largest |Hertz - SJKR| between primaries of different bodies
  double am_cbd_force_nN = 0.0; ///< the same between primaries and CBD
  /// In the plane, of the contacts between bodies and CBD, over the film's volume; positive: the
  /// film would spread. A film at rest has next to none.
  double film_stress_MPa = 0.0;
  Overlaps cbd_cbd, cbd_am;
  int bonds = 0;               ///< pairs of a body's primaries that touch
  int lattice_pairs = 0;       ///< that touch in the bodies as made: there must be as many bonds
  double bond_strain = 0.0;    ///< largest |r/r_made - 1| of them
  double highest_um = 0.0;     ///< top of the highest particle
  std::vector<int> body_bonds; ///< per body
};

PackingState examine(const Recipe &recipe, const std::vector<Body> &bodies,
                     const std::vector<Particle> &particles, const FinalMaterial &material = {});

/// Bonds of the lattice: index pairs of one body's particles that touch, periodic in x and y.
std::vector<std::pair<int, int>> bonds_by_distance(const std::vector<Particle> &particles,
                                                   double lx, double ly);

struct Pose {
  Eigen::Vector3d centre;  ///< of mass, inside the cell [um]
  Eigen::Quaterniond turn; ///< orientation of the cubic lattice; a single primary keeps its first
  double distortion = 0.0; ///< largest distance of a primary from the rigid body [um]
};

/// Poses in the order of `bodies`, whose primaries are the first particles, body by body.
std::vector<Pose> find_poses(const Recipe &recipe, const std::vector<Body> &bodies,
                             const std::vector<Particle> &particles);

struct Envelope {
  double am = 0.0;    ///< union of the bodies' envelopes [um^3]
  double total = 0.0; ///< union of those and the CBD spheres [um^3]
};

Envelope measure_envelope(const Recipe &recipe, const std::vector<Particle> &particles,
                          const std::vector<Pose> &poses, double voxel = 0.2);

} // namespace calendem

#endif
