// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/body.h"
#include "electrode/pack/grains.h"
#include "physics/pi.h"
#include "support.h"
#include <algorithm>

namespace {
using namespace calendem;

constexpr double kBond = 1.04 * 1.59, kVolume = 1.28 * 1.28 * 1.28; // um, um^3

Grains grains_of_sphere(int count, unsigned long seed) {
  const double R = std::cbrt(count * kVolume / (4.0 / 3.0 * kPi));
  const Hull hull{[](const Eigen::Vector3d &p) { return p.norm(); }, 1.5 * R, [] { return 1.0; },
                  ""};
  Random random(seed, 1);
  return make_grains(hull, count, kVolume, HUGE_VAL, kBond, random);
}

double nearest_neighbour(const Grains &g, size_t i) {
  double least = HUGE_VAL;
  for (size_t j = 0; j < g.centres.size(); ++j)
    if (j != i)
      least = std::min(least, (g.centres[i] - g.centres[j]).norm());
  return least;
}

// 4.4 and 7 um are sizes at which the middle grain has no neighbour within 1.59 um.
TEST(Grains, NoneIsLoose) {
  for (const int count : {5, 6, 8, 13, 21, 60, 86, 250})
    for (unsigned long seed = 1; seed <= 5; ++seed) {
      const Grains g = grains_of_sphere(count, seed);
      ASSERT_EQ(g.centres.size(), size_t(count));
      for (size_t i = 1; i < g.centres.size(); ++i)
        EXPECT_TRUE(std::any_of(g.centres.begin(), g.centres.begin() + long(i),
                                [&](auto &p) { return (p - g.centres[i]).norm() < kBond; }));
    }
}

// Cells of one volume whose centres lay on a lattice would be 1.28 um apart (cubic) to 1.44 (fcc).
// Lloyd's iteration ends between; a hull of few grains pushes them together.
TEST(Grains, AreSpacedAsTheirVolumeAsks) {
  for (const int count : {5, 8, 60, 250}) {
    double least = HUGE_VAL, mean = 0.0;
    const Grains g = grains_of_sphere(count, 1);
    for (size_t i = 0; i < g.centres.size(); ++i) {
      const double d = nearest_neighbour(g, i);
      least = std::min(least, d);
      mean += d / count;
    }
    std::printf("%d grains: nearest %.3f um, mean %.3f, facet %.3f um2\n", count, least, mean,
                g.facet);
    EXPECT_GT(least, 1.0);
    EXPECT_GT(mean, 1.1);
    EXPECT_LT(mean, 1.44);
  }
}

// Fifty of Lloyd's iterations, from the points that a partial shuffle draws; every centre is asked.
std::vector<Eigen::Vector3d> by_all_distances(const std::vector<Eigen::Vector3d> &points, int count,
                                              Random &random) {
  std::vector<Eigen::Vector3d> left = points;
  for (size_t k = 0; k < size_t(count); ++k)
    std::swap(left[k], left[k + size_t(random.uniform() * double(left.size() - k))]);
  std::vector<Eigen::Vector3d> centres(left.begin(), left.begin() + count);
  for (int iteration = 0; iteration < 50; ++iteration) {
    std::vector<Eigen::Vector3d> sum(centres.size(), Eigen::Vector3d::Zero());
    std::vector<int> number(centres.size(), 0);
    for (const Eigen::Vector3d &p : points) {
      size_t nearest = 0;
      for (size_t c = 1; c < centres.size(); ++c)
        if ((p - centres[c]).squaredNorm() < (p - centres[nearest]).squaredNorm())
          nearest = c;
      sum[nearest] += p;
      ++number[nearest];
    }
    for (size_t c = 0; c < centres.size(); ++c)
      if (number[c] > 0)
        centres[c] = sum[c] / number[c];
  }
  return centres;
}

TEST(SpreadCentres, AreThoseThatAllDistancesGive) {
  for (const int count : {1, 2, 40, 200}) {
    Random random(7, std::uint64_t(count));
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 4000; ++k)
      points.push_back(random.uniform3().cwiseProduct(Eigen::Vector3d(3.0, 1.0, 1.0)));
    Random same = random;
    EXPECT_EQ(spread_centres(points, count, std::cbrt(3.0 / count), random),
              by_all_distances(points, count, same))
        << count;
  }
}

// Two cubes of side a share one face: so do two grains of a box of twice that length.
TEST(Grains, FacetHasTheAreaBetweenTwoCells) {
  const double a = 1.28;
  const Hull box{[&](const Eigen::Vector3d &p) {
                   return std::max({std::fabs(p.x()) / 2.0, std::fabs(p.y()), std::fabs(p.z())});
                 },
                 2.0 * a, [] { return 1.0; }, ""};
  Random random(1, 1);
  const Grains g = make_grains(box, 2, kVolume, HUGE_VAL, kBond, random);
  ASSERT_EQ(g.centres.size(), 2U);
  EXPECT_NEAR((g.centres[0] - g.centres[1]).norm(), a, 0.02 * a); // a seventh of a cell, averaged
  // staircases of a plane at one turn have 1 to 1.73 times its area, where 1.5 is taken
  EXPECT_GT(g.facet, a * a / 1.5);
  EXPECT_LT(g.facet, a * a * 1.16);
}

TEST(Grains, FollowTheSeedAlone) {
  EXPECT_EQ(grains_of_sphere(60, 3).centres, grains_of_sphere(60, 3).centres);
  EXPECT_NE(grains_of_sphere(60, 3).centres, grains_of_sphere(60, 4).centres);
}

TEST(Grains, SmallBodiesAreALatticeS) {
  const Recipe recipe =
      calendem_test::recipe_of("name = \"test\"\n[particles]\ngrains = \"voronoi\"\n");
  Random random(1, 1);
  const Body b = make_body(recipe, kFewestGrains - 1, random);
  for (size_t i = 1; i < b.primaries.size(); ++i)
    EXPECT_GE((b.primaries[i] - b.primaries[0]).norm(), recipe.lattice * (1.0 - 1e-9));
}

} // namespace
