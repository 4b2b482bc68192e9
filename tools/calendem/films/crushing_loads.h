// SPDX-License-Identifier: GPL-2.0-or-later
// At which load single particles of the simulation break, for any strength of their bonds: the load is proportional to
// it (docs/validation/particle_strength.md).
#ifndef CALENDEM_FILMS_CRUSHING_LOADS_H
#define CALENDEM_FILMS_CRUSHING_LOADS_H

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace calendem {

/// ln(load / strength) of particles whose lattice is turned by chance, fitted by least squares as
/// linear in ln(diameter).
class CrushingLoads {
public:
  /// Reads diameter_um, strength_MPa and load_mN. Throws Failure(2) where they are no positive
  /// numbers, or of fewer than two diameters or four particles.
  explicit CrushingLoads(const std::string &file);

  bool covers(double diameter_um) const;
  const std::vector<double> &diameters() const { return diameters_; } ///< [um], increasing
  /// ln of the load [mN], mean of all turns.
  double log_load(double diameter_um, double strength_MPa) const;
  /// Covariance of the errors of two such means: few particles were crushed.
  double covariance(double diameter_um, double other_um) const;

private:
  std::vector<double> diameters_;
  Eigen::Vector2d line_; ///< 1 and ln(diameter / um)
  Eigen::Matrix2d line_covariance_;
};

} // namespace calendem

#endif
