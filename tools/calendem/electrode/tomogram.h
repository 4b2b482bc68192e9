// SPDX-License-Identifier: GPL-2.0-or-later
// Synthetic label images whose truth is known: irregular particles that touch, pores inside them,
// ragged borders. They show what the way from an image to an electrode keeps and what it loses.
#ifndef CALENDEM_ELECTRODE_TOMOGRAM_H
#define CALENDEM_ELECTRODE_TOMOGRAM_H

#include "base/toml_reader.h"
#include "electrode/structure/label_image.h"

namespace calendem {

const std::vector<Key> &tomogram_keys();

/// Lengths um, fractions 0-1.
struct TomogramSpec {
  unsigned long seed;
  double voxel;
  Eigen::Vector3d size;
  double median, sigma_ln, min_diameter, max_diameter, irregularity;
  double solid_fraction; ///< of the image, at which particles stop being added
  double touching;       ///< share of particles that are pushed against another
  int pores;             ///< closed pores per particle
  double pore_diameter;  ///< over the particle's
  double noise;          ///< share of the voxels at a surface that change sides
};

/// Throws Failure(2) with every mistake of the file.
TomogramSpec read_tomogram_spec(const std::string &file);

/// What a particle is before it is cut into voxels. Centre and size [um].
struct TrueParticle {
  std::int32_t label = 0;
  Eigen::Vector3d centre;
  double volume = 0.0, equivalent_diameter = 0.0, sphericity = 0.0;
};

struct Tomogram {
  LabelImage image;
  std::vector<TrueParticle> truth; ///< by label, from 1
};

/// Same spec, same voxels. Throws Failure(2) if not one particle finds room.
Tomogram make_tomogram(const TomogramSpec &spec);

/// label,x_um,y_um,z_um,volume_um3,equivalent_diameter_um,sphericity
std::string truth_table(const std::vector<TrueParticle> &truth);

} // namespace calendem

#endif
