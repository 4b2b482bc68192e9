// SPDX-License-Identifier: GPL-2.0-or-later
// Secondary particles: sizes from the recipe's truncated lognormal law by number, irregular outer
// shapes, filled with primaries: irregular grains, or sites of a randomly turned cubic lattice.
#ifndef CALENDEM_ELECTRODE_PACK_BODY_H
#define CALENDEM_ELECTRODE_PACK_BODY_H

#include "base/particle_sizes.h"
#include "base/random.h"
#include "base/recipe.h"
#include "electrode/pack/hull.h"
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace calendem {

/// Diameters [um], largest first, that together fill `volume` [um^3] as nearly as whole bodies can:
/// quantiles of the law in equal steps of number, with one random offset (stratified sampling), so
/// that even a small cell has the right mix.
std::vector<double> draw_diameters(const Recipe &recipe, double volume, Random &random);

/// Sizes from any law, given as its quantile function [um].
using Quantile = std::function<double(double)>;
std::vector<double> draw_diameters(const Quantile &law, double volume, Random &random);

/// Primaries per body: N s^3 nearest to the sphere's volume, at least 1; rounding is carried on
/// from body to body so that the sum is exactly `total`.
std::vector<int> primary_counts(const std::vector<double> &diameters, double lattice, int total);

/// Star-shaped surface R(u) = R0 (1 + irregularity * f(u)), f a smooth random field of unit
/// variance made of Legendre terms of degree 2-5 about random axes.
class Shape {
public:
  Shape(Random &random, double irregularity);
  /// R(u)/R0 for a unit vector u.
  double radius(const Eigen::Vector3d &u) const;
  /// Surface of the sphere of equal volume over the surface of the shape, on a mesh of directions.
  double sphericity() const;
  /// Volume over that of the sphere of radius R0, on a finer mesh.
  double volume_ratio() const;

private:
  struct Term {
    Eigen::Vector3d axis;
    int degree;
    double weight;
  };
  std::vector<Term> terms_;

  struct Mesh {
    double area = 0.0, volume = 0.0;
  };
  Mesh measure(int nt, int np) const;
};

/// Simple cubic lattice with a random turn and offset.
struct Lattice {
  Eigen::Quaterniond turn;
  Eigen::Vector3d offset; ///< in spacings
  double spacing;         ///< [um]
  Eigen::Vector3d point(const std::array<int, 3> &site) const {
    return turn * (spacing * (Eigen::Vector3d(site[0], site[1], site[2]) + offset));
  }
};

struct Body {
  std::vector<Eigen::Vector3d> primaries; ///< about the centre of mass [um]
  Eigen::Quaterniond lattice;             ///< orientation of the cubic lattice; of grains: as made
  double facet = 0.0;                     ///< mean area between two bonded grains [um^2]
  double volume = 0.0;                    ///< of the envelope, N s^3 [um^3]
  double sphericity = 1.0;                ///< of the smooth shape; 1 for a single primary
  double width = 0.0;                     ///< largest distance on its primaries' surfaces [um]
  double reach = 0.0;                     ///< farthest surface of a primary from the centre [um]
  int redrawn = 0;                        ///< shapes drawn before because they were too wide
  std::string shape;                      ///< of the library; empty: generated
};

/// Largest distance between two points of the spheres' surfaces.
double width_of(const std::vector<Eigen::Vector3d> &centres, double diameter);

/// One body of exactly `count` primaries, not wider than the recipe's limit: shapes that are wider
/// are drawn again, the hundredth is cut off. Throws Failure(2) where even that has no room.
Body make_body(const Recipe &recipe, int count, Random &random, const DrawHull &draw);
/// Makes it with a generated Shape of the recipe's irregularity.
Body make_body(const Recipe &recipe, int count, Random &random);

/// Primaries per body by the recipe's law of sizes, largest first.
std::vector<int> draw_counts(const Recipe &recipe);

/// Bodies whose primaries add up to round(A * am_column / s^3), largest first. Bodies below about
/// 3 um are made of few primaries (1-7), those below 1 s^3 of one.
std::vector<Body> make_bodies(const Recipe &recipe);

} // namespace calendem

#endif
