// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies touch where the smooth particles that they stand for would (docs/model/particles.md).
#include "electrode/pack/body.h"
#include "electrode/pack/grains.h"
#include "physics/pi.h"
#include "physics/surface_inset.h"
#include "support.h"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {
using namespace calendem;
using calendem_test::cell;
using Points = std::vector<Eigen::Vector3d>;

constexpr double kInset = 0.09; // [um], for primaries of 1.59 um: input_scripts/materials
constexpr double kReach = 1.04; // of a bond, in sums of radii

struct Ball {
  Eigen::Vector3d center;
  double radius;
};
using Balls = std::vector<Ball>;

// Distance of the centres along z at which they touch.
double touching(const Balls &below, const Balls &above) {
  double most = 0.0;
  for (const Ball &a : below)
    for (const Ball &b : above) {
      const Eigen::Vector3d d = a.center - b.center;
      const double square = std::pow(a.radius + b.radius, 2) - d.x() * d.x() - d.y() * d.y();
      if (square > 0.0)
        most = std::fmax(most, d.z() + std::sqrt(square));
    }
  return most;
}

Balls turned(Balls balls, Random &random) {
  const Eigen::Quaterniond turn = random.rotation();
  for (Ball &b : balls)
    b.center = turn * b.center;
  return balls;
}

struct Clearance {
  double mean, sd; ///< of the cube of the distance at which two touch, in units of `diameter` cubed
};

Clearance clearance(const std::vector<Balls> &bodies, double diameter) {
  constexpr int kPairs = 200;
  Random random(1, 2);
  double sum = 0.0, square = 0.0;
  for (int k = 0; k < kPairs; ++k) {
    const Balls a = turned(bodies[k % bodies.size()], random);
    const Balls b = turned(bodies[(k * 7 + 3) % bodies.size()], random);
    const double volume = std::pow(touching(a, b) / diameter, 3);
    sum += volume / kPairs;
    square += volume * volume / kPairs;
  }
  return {sum, std::sqrt(square - sum * sum)};
}

std::vector<Balls> of_one_radius(const std::vector<Points> &bodies, double radius) {
  std::vector<Balls> out;
  for (const Points &body : bodies) {
    out.emplace_back();
    for (const Eigen::Vector3d &p : body)
      out.back().push_back({p, radius});
  }
  return out;
}

// As the reference material has it: each primary's inset goes with its bonds.
std::vector<Balls> inset(const std::vector<Points> &bodies, const Recipe &recipe) {
  const double d = recipe.primary_diameter;
  std::vector<Balls> out = of_one_radius(bodies, 0.5 * d);
  for (Balls &body : out)
    for (Ball &one : body) {
      const long bonds = std::count_if(body.begin(), body.end(), [&](const Ball &other) {
        return &other != &one && (other.center - one.center).norm() < kReach * d;
      });
      one.radius = 0.5 * d - surface_inset(kInset, 1.0, bonds);
    }
  return out;
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

} // namespace

// The mean of 200 pairs of 8 bodies has a standard error of 1 %.
TEST(Surface, GrainsKeepAsMuchVolumeAsSmoothSpheres) {
  const Recipe recipe = cell(30.0);
  for (const double diameter : {4.4, 6.0, 10.0}) {
    const Bodies grains = make(GrainShape::Voronoi, diameter, 0.0, recipe),
                 lattice = make(GrainShape::Lattice, diameter, 0.0, recipe);
    const double R = 0.5 * recipe.primary_diameter;
    const Clearance flush = clearance(inset(grains.primaries, recipe), diameter),
                    tips = clearance(of_one_radius(grains.primaries, R), diameter),
                    steps = clearance(of_one_radius(lattice.primaries, R), diameter);
    std::printf("%.1f um: %.3f (sd %.2f), at the tips %.3f; lattice %.3f (sd %.2f)\n", diameter,
                flush.mean, flush.sd, tips.mean, steps.mean, steps.sd);
    EXPECT_NEAR(flush.mean, 1.0, 0.05);
    EXPECT_GT(tips.mean, flush.mean + 0.05);
    EXPECT_GT(steps.mean, tips.mean + 0.05);
  }
}

// Bodies of 2 to 4 primaries are chains and plates that stand for no sphere.
TEST(Surface, FewGrainsKeepTheirVolumeToo) {
  const Recipe recipe = cell(30.0);
  for (const int count : {1, 5, 6, 8, 12, 16}) {
    const double diameter = recipe.lattice * std::cbrt(6.0 * count / kPi);
    const Bodies bodies = make(GrainShape::Voronoi, diameter, 0.0, recipe);
    const Clearance faded = clearance(inset(bodies.primaries, recipe), diameter),
                    whole = clearance(
                        of_one_radius(bodies.primaries, 0.5 * recipe.primary_diameter - kInset),
                        diameter);
    std::printf("%d grains: %.3f, with the whole inset %.3f\n", count, faded.mean, whole.mean);
    EXPECT_NEAR(faded.mean, 1.0, 0.1);
    EXPECT_LT(std::fabs(faded.mean - 1.0), std::fabs(whole.mean - 1.0));
  }
}

// 800 points of a surface lie about a tenth of the radius apart; spheres of that size around them
// close it.
TEST(Surface, GrainsKeepAsMuchVolumeAsTheirRoughShape) {
  const Recipe recipe = cell(30.0);
  for (const double diameter : {4.4, 6.0}) {
    const Bodies bodies = make(GrainShape::Voronoi, diameter, 0.05, recipe);
    constexpr double kPoint = 0.1; // so that pairs of points are found
    const Clearance flush = clearance(inset(bodies.primaries, recipe), diameter);
    const double shape =
        clearance(of_one_radius(bodies.surface, 0.5 * kPoint * diameter), diameter).mean /
        std::pow(1.0 + kPoint, 3);
    std::printf("%.1f um: %.3f, the shapes %.3f\n", diameter, flush.mean, shape);
    EXPECT_NEAR(flush.mean / shape, 1.0, 0.05);
  }
}
