// SPDX-License-Identifier: GPL-2.0-or-later
// Shapes of measured particles: made from a label image, kept as a folder (one JSON per shape,
// shapes.csv as a list) that electrodes of any size are packed from without the image.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_SHAPE_LIBRARY_H
#define CALENDEM_ELECTRODE_STRUCTURE_SHAPE_LIBRARY_H

#include "electrode/structure/measured_shape.h"

namespace calendem {

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
