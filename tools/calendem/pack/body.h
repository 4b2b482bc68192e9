// SPDX-License-Identifier: GPL-2.0-or-later
// Secondary particles: sizes from the recipe's lognormal law, irregular outer shapes, primaries on
// a randomly turned cubic lattice inside.
#ifndef CALENDEM_PACK_BODY_H
#define CALENDEM_PACK_BODY_H

#include "pack/random.h"
#include "spec/recipe.h"
#include <vector>

namespace calendem {

/// Star-shaped surface R(u) = R0 (1 + irregularity * f(u)), f a smooth random field of unit
/// variance made of Legendre terms of degree 2-5 about random axes.
class Shape {
public:
  Shape(Random &random, double irregularity);
  /// R(u)/R0 for a unit vector u.
  double radius(const Eigen::Vector3d &u) const;
  /// Surface of the sphere of equal volume over the surface of the shape, on a mesh of directions.
  double sphericity() const;

private:
  struct Term {
    Eigen::Vector3d axis;
    int degree;
    double weight;
  };
  std::vector<Term> terms_;
};

struct Body {
  std::vector<Eigen::Vector3d> primaries; ///< about the centre of mass [um]
  Eigen::Quaterniond lattice;             ///< orientation of the cubic lattice
  double volume = 0.0;                    ///< of the envelope, N s^3 [um^3]
  double sphericity = 1.0;
  double reach = 0.0; ///< farthest surface of a primary from the centre [um]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

struct BodyReport {
  double volume_cut_off_fraction = 0.0; ///< of the distribution's volume, above the size limit
  int below_3_um = 0;                   ///< bodies drawn below 3 um, made of 1-7 primaries
};

/// Diameters [um], largest first: stratified quantiles of the truncated law, as many as fill
/// `volume`.
std::vector<double> draw_diameters(const Recipe &recipe, double volume, Random &random,
                                   BodyReport &report);

/// Bodies whose primaries add up to round(A * am_column / s^3), largest first.
std::vector<Body> make_bodies(const Recipe &recipe, BodyReport &report);

} // namespace calendem

#endif
