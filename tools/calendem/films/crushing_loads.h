// SPDX-License-Identifier: GPL-2.0-or-later
// At which load single particles of the simulation break, for any strength of their bonds
// (docs/validation/particle_strength.md).
#ifndef CALENDEM_FILMS_CRUSHING_LOADS_H
#define CALENDEM_FILMS_CRUSHING_LOADS_H

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace calendem {

/// ln(load) of particles whose grains are drawn by chance, fitted by least squares as linear in
/// ln(diameter) and ln(strength); in proportion to the strength where all have the same.
class CrushingLoads {
public:
  /// Reads diameter_um, strength_MPa and load_mN. Throws Failure(2) where they are no positive
  /// numbers, or of fewer than two diameters or four particles.
  explicit CrushingLoads(const std::string &file);

  bool covers(double diameter_um) const;
  const std::vector<double> &diameters() const { return diameters_; } ///< [um], increasing
  /// ln of the load [mN], mean of all drawings.
  double log_load(double diameter_um, double strength_MPa) const;
  /// Covariance of the errors of two such means of the strength that most particles had: few
  /// particles were crushed.
  double covariance(double diameter_um, double other_um) const;
  /// d ln(load) / d ln(strength).
  double power() const { return power_; }

private:
  std::vector<double> diameters_;
  double strength_ = 0.0, power_ = 1.0; ///< strength: median of the particles'
  Eigen::Vector2d line_;                ///< at that strength: 1 and ln(diameter / um)
  Eigen::Matrix2d line_covariance_;

  void fit(const std::vector<double> &diameters, const std::vector<double> &strengths,
           const std::vector<double> &loads);
};

} // namespace calendem

#endif
