// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/packing_state.h"
#include "physics/pi.h"
#include "support.h"
#include <algorithm>

namespace {
using namespace calendem;
using calendem_test::cell;

class PlacedCell : public testing::Test {
protected:
  void SetUp() override {
    recipe = cell(10.0);
    bodies = make_bodies(recipe);
    placed = place(recipe, bodies);
  }
  Recipe recipe;
  std::vector<Body> bodies;
  Placement placed;
};

TEST_F(PlacedCell, NothingOverlapsAcrossPeriodicFacesEither) {
  for (const Particle &p : placed.particles)
    for (const Particle &q : placed.particles)
      if (p.tag < q.tag && (p.body == 0 || p.body != q.body)) {
        const double gap =
            periodic_difference(recipe, p.x, q.x).norm() - 0.5 * (p.diameter + q.diameter);
        ASSERT_GE(gap, -1e-9) << p.tag << " " << q.tag;
      }
}

TEST_F(PlacedCell, EverythingIsInsideTheTallCell) {
  for (const Particle &p : placed.particles) {
    EXPECT_GE(p.x.x(), 0.0);
    EXPECT_LE(p.x.x(), recipe.cell_x);
    EXPECT_GE(p.x.z(), 0.5 * p.diameter - 1e-9);
    EXPECT_LE(p.x.z(), placed.height - 0.5 * p.diameter + 1e-9);
  }
}

TEST_F(PlacedCell, TagsRunFromOneWithPrimariesFirstBodyByBody) {
  size_t k = 0;
  for (size_t body = 0; body < bodies.size(); ++body)
    for (size_t n = 0; n < bodies[body].primaries.size(); ++n, ++k) {
      EXPECT_EQ(placed.particles[k].tag, static_cast<int>(k) + 1);
      EXPECT_EQ(placed.particles[k].body, static_cast<int>(body) + 1);
      EXPECT_EQ(placed.particles[k].type, 1);
    }
  for (; k < placed.particles.size(); ++k) {
    EXPECT_EQ(placed.particles[k].body, 0);
    EXPECT_EQ(placed.particles[k].type, 2);
  }
}

TEST_F(PlacedCell, MassGivesTheLoadingAndTheWeightFractions) {
  double am = 0.0, cbd = 0.0;
  for (const Particle &p : placed.particles)
    (p.type == 1 ? am : cbd) += p.density * kPi / 6.0 * std::pow(p.diameter, 3);
  EXPECT_NEAR((am + cbd) / recipe.area() / 10.0, 17.46, 0.01 * 17.46);
  EXPECT_NEAR(am / (am + cbd), 0.96, 0.002);
}

TEST(Place, SameSeedSamePlaces) {
  const auto positions = [](int seed) {
    const Recipe recipe = cell(8.0, seed);
    std::vector<double> z;
    for (const Particle &p : place(recipe, make_bodies(recipe)).particles)
      z.push_back(p.x.z());
    return z;
  };
  EXPECT_EQ(positions(3), positions(3));
  EXPECT_NE(positions(3), positions(4));
}

/// Heights of the CBD spheres from the lowest place they can have, 0, to the highest, 1; rising.
std::vector<double> heights(const Recipe &recipe, const std::vector<Body> &bodies, double slope) {
  Recipe graded = recipe;
  graded.cbd_gradient.slope = slope;
  const Placement placed = place(graded, bodies);
  std::vector<double> out;
  for (const Particle &p : placed.particles)
    if (p.type == 2)
      out.push_back((p.x.z() - 0.5 * p.diameter) / (placed.height - p.diameter));
  std::sort(out.begin(), out.end());
  return out;
}

// Kolmogorov and Smirnov's distance is below 1.63 / sqrt(N) in 99 % of all draws; places draw back
// from each other, which makes it less.
TEST(Place, HeightsOfCbdFollowTheGradient) {
  const Recipe recipe = cell(40.0);
  for (const double slope : {-1.0, -0.4, 0.0, 0.5, 1.0}) {
    const std::vector<double> z = heights(recipe, {}, slope);
    ASSERT_EQ(int(z.size()), cbd_count(recipe));
    double distance = 0.0;
    for (size_t k = 0; k < z.size(); ++k) {
      const double due = CbdGradient{slope}.share_below(z[k]);
      distance = std::max({distance, std::fabs(due - double(k) / double(z.size())),
                           std::fabs(due - double(k + 1) / double(z.size()))});
    }
    EXPECT_LT(distance, 1.63 / std::sqrt(double(z.size()))) << slope;
  }
}

// Between bodies the content is the gradient's times what it is there without one.
TEST(Place, TheGradientCountsBesideTheRoomThatBodiesLeave) {
  const Recipe recipe = cell(20.0);
  const std::vector<Body> bodies = make_bodies(recipe);
  const std::vector<double> even = heights(recipe, bodies, 0.0);
  for (const double slope : {-0.8, 0.8}) {
    double due = 0.0, weight = 0.0, mean = 0.0;
    for (const double z : even) {
      due += z * CbdGradient{slope}.content(z);
      weight += CbdGradient{slope}.content(z);
    }
    const std::vector<double> graded = heights(recipe, bodies, slope);
    for (const double z : graded)
      mean += z / double(graded.size());
    // two draws of N heights each
    EXPECT_NEAR(mean, due / weight,
                3.0 * std::sqrt(2.0) * CbdGradient{slope}.scatter(double(even.size())) / 6.0);
  }
}

TEST(Densities, MakeABodyWeighItsEnvelope) {
  const Recipe recipe = cell(15.0);
  const double sphere = kPi / 6.0 * std::pow(1.59, 3);
  EXPECT_NEAR(primary_density(recipe) * sphere, 4.65 * std::pow(1.28, 3), 1e-12);
  EXPECT_NEAR(cbd_density(recipe), 0.915, 1e-12);
  EXPECT_NEAR(cbd_count(recipe), 1440, 2);
}

TEST(PeriodicDifference, TakesTheNearestImageInXAndYOnly) {
  const Recipe recipe = cell(10.0);
  const Eigen::Vector3d d = periodic_difference(recipe, {9.5, 0.5, 30.0}, {0.5, 9.0, 1.0});
  EXPECT_NEAR((d - Eigen::Vector3d(-1.0, 1.5, 29.0)).norm(), 0.0, 1e-12);
}

} // namespace
