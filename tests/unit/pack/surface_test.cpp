// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies touch where the smooth particles that they stand for would (docs/model/particles.md).
#include "electrode/pack/body.h"
#include "electrode/pack/grains.h"
#include "physics/pi.h"
#include "support.h"
#include <cmath>
#include <cstdio>

namespace {
using namespace calendem;
using calendem_test::cell;
using Points = std::vector<Eigen::Vector3d>;

// Distance of the centres along z at which spheres of that diameter touch.
double touching(const Points &below, const Points &above, double diameter) {
  double most = 0.0;
  for (const Eigen::Vector3d &a : below)
    for (const Eigen::Vector3d &b : above) {
      const double x = a.x() - b.x(), y = a.y() - b.y();
      const double square = diameter * diameter - x * x - y * y;
      if (square > 0.0)
        most = std::fmax(most, a.z() - b.z() + std::sqrt(square));
    }
  return most;
}

Points turned(Points points, Random &random) {
  const Eigen::Quaterniond turn = random.rotation();
  for (Eigen::Vector3d &p : points)
    p = turn * p;
  return points;
}

struct Clearance {
  double mean, sd; ///< of the cube of the distance at which two touch, in units of `diameter` cubed
};

Clearance clearance(const std::vector<Points> &bodies, double touch, double diameter) {
  constexpr int kPairs = 200;
  Random random(1, 2);
  double sum = 0.0, square = 0.0;
  for (int k = 0; k < kPairs; ++k) {
    const Points a = turned(bodies[k % bodies.size()], random);
    const Points b = turned(bodies[(k * 7 + 3) % bodies.size()], random);
    const double volume = std::pow(touching(a, b, touch) / diameter, 3);
    sum += volume / kPairs;
    square += volume * volume / kPairs;
  }
  return {sum, std::sqrt(square - sum * sum)};
}

// Bodies of shapes as rough as that; the shapes' own points as well.
struct Bodies {
  std::vector<Points> primaries, surface;
};

Bodies make(GrainShape grains, double diameter, double roughness, const Recipe &given) {
  constexpr int kBodies = 8, kOnSurface = 800;
  Recipe recipe = given;
  recipe.grains = grains;
  const int count =
      static_cast<int>(std::lround(kPi / 6.0 * std::pow(diameter / recipe.lattice, 3)));
  Random random(1, 1);
  Bodies out;
  for (int k = 0; k < kBodies; ++k) {
    const Shape shape(random, roughness);
    const double R = 0.5 * diameter / std::cbrt(shape.volume_ratio());
    const auto depth = [&](const Eigen::Vector3d &p) {
      return p.norm() > 0.0 ? p.norm() / shape.radius(p.normalized()) : 0.0;
    };
    const DrawHull draw = [&](Random &) { return Hull{depth, 1.8 * R, [] { return 1.0; }, ""}; };
    out.primaries.push_back(make_body(recipe, count, random, draw).primaries);
    Points points;
    for (int p = 0; p < kOnSurface; ++p) {
      const Eigen::Vector3d u = random.direction();
      points.push_back(R * shape.radius(u) * u);
    }
    out.surface.push_back(points);
  }
  return out;
}

constexpr double kInset = 0.09; // [um], for primaries of 1.59 um: input_scripts/materials

} // namespace

// The mean of 200 pairs of 8 bodies has a standard error of 1 %.
TEST(Surface, GrainsKeepAsMuchVolumeAsSmoothSpheres) {
  const Recipe recipe = cell(30.0);
  for (const double diameter : {4.4, 6.0, 10.0}) {
    const Bodies grains = make(GrainShape::Voronoi, diameter, 0.0, recipe),
                 lattice = make(GrainShape::Lattice, diameter, 0.0, recipe);
    const double touch = recipe.primary_diameter;
    const Clearance flush = clearance(grains.primaries, touch - 2.0 * kInset, diameter),
                    tips = clearance(grains.primaries, touch, diameter),
                    steps = clearance(lattice.primaries, touch, diameter);
    std::printf("%.1f um: %.3f (sd %.2f), at the tips %.3f; lattice %.3f (sd %.2f)\n", diameter,
                flush.mean, flush.sd, tips.mean, steps.mean, steps.sd);
    EXPECT_NEAR(flush.mean, 1.0, 0.05);
    EXPECT_GT(tips.mean, flush.mean + 0.05);
    EXPECT_GT(steps.mean, tips.mean + 0.05);
  }
}

// 800 points of a surface lie about a tenth of the radius apart; spheres of that size around them
// close it.
TEST(Surface, GrainsKeepAsMuchVolumeAsTheirRoughShape) {
  const Recipe recipe = cell(30.0);
  for (const double diameter : {4.4, 6.0}) {
    const Bodies bodies = make(GrainShape::Voronoi, diameter, 0.05, recipe);
    constexpr double kPoint = 0.1; // so that pairs of points are found
    const Clearance flush =
        clearance(bodies.primaries, recipe.primary_diameter - 2.0 * kInset, diameter);
    const double shape =
        clearance(bodies.surface, kPoint * diameter, diameter).mean / std::pow(1.0 + kPoint, 3);
    std::printf("%.1f um: %.3f, the shapes %.3f\n", diameter, flush.mean, shape);
    EXPECT_NEAR(flush.mean / shape, 1.0, 0.05);
  }
}
