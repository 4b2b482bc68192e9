// SPDX-License-Identifier: GPL-2.0-or-later
// Single particles of a label image: where each label lies, its voxels with pores closed, its surface
// without the voxels' stairs; and its outer shape, coarse enough for a small file: cells inside or
// outside, and the distance to the surface made of them. And libraries of such shapes.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_MEASURED_SHAPE_H
#define CALENDEM_ELECTRODE_STRUCTURE_MEASURED_SHAPE_H

#include "electrode/structure/label_image.h"
#include <array>
#include <nlohmann/json_fwd.hpp>
#include <vector>

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

struct MeasuredShape {
  std::string name;
  std::int32_t label = 0;
  double volume = 0.0;              ///< envelope, pores closed; from all voxels [um3]
  double equivalent_diameter = 0.0; ///< [um]
  double sphericity = 0.0;
  double closed_pore_fraction = 0.0; ///< of the envelope
  double weight = 1.0;               ///< 1/chance that the image's border spares it
  std::array<int, 3> n = {0, 0, 0};  ///< cells, one empty all around
  double cell = 0.0;                 ///< side of a cell [um]
  std::vector<char> inside;          ///< x runs fastest
  std::vector<float> depth; ///< signed distance to the surface, < 0 inside, at cell centres [um]
  Eigen::Vector3d centre;   ///< of mass [um] from the corner of the box of cells
  double reach = 0.0;       ///< farthest cell's corner from the centre [um]

  /// Signed distance [um] at x [um] from the centre; beyond the box it grows with the distance.
  double depth_at(const Eigen::Vector3d &x) const;
};

/// At most `cells` cells along the longest side. Name, label and weight are the caller's.
MeasuredShape make_shape(const ParticleMask &mask, int cells = 48);

nlohmann::json to_json(const MeasuredShape &shape);
/// Throws std::exception where a field is missing or the cells do not fill the box.
MeasuredShape shape_from_json(const nlohmann::json &j);

// Exact distance transform on voxels.

/// Distance [unit of `cell`] from every cell's centre to the face between inside and outside: > 0
/// outside, < 0 inside; half a cell is taken off because the face lies between two centres.
/// Saito and Toriwaki, Pattern Recognition 27 (1994) 1551, as VTK has it.
std::vector<float> signed_distance(const std::vector<char> &inside, const std::array<int, 3> &n,
                                   double cell);

// Shapes of measured particles: made from a label image, kept as a folder (one JSON per shape,
// shapes.csv as a list) that electrodes of any size are packed from without the image.

struct ShapeLibrary {
  std::vector<MeasuredShape> shapes; ///< by equivalent diameter, smallest first
  std::string source;                ///< file name of the image
  std::string source_hash;
  int labels = 0;                   ///< in the image
  std::vector<std::int32_t> cut;    ///< labels dropped because the border cuts them
  std::vector<std::int32_t> coarse; ///< labels dropped because they have too few voxels
  long loose_voxels = 0;            ///< dropped: not connected to their particle

  /// Equivalent diameter [um] below which the fraction q of the number lies, each shape counted
  /// with its weight; between shapes linear in ln d.
  double quantile(double q) const;
  /// Fraction of the number below `diameter` [um].
  double number_below(double diameter) const;
  /// Fraction of the volume in shapes larger than `diameter` [um].
  double volume_above(double diameter) const;
  /// Equivalent diameter [um] below which the fraction q of the volume lies.
  double volume_quantile(double q) const;
};

/// Labels with fewer voxels than this have no measurable shape.
constexpr long kFewestVoxels = 200;

/// Throws Failure(2) if no particle is left.
ShapeLibrary make_library(const LabelImage &image, std::int32_t background,
                          const std::string &source);

void write_library(const ShapeLibrary &library, const std::string &folder);
/// Throws Failure(2) with every file that cannot be read.
ShapeLibrary read_library(const std::string &folder);

} // namespace calendem

#endif
