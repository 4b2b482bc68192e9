// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/placement.h"
#include "support.h"

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
    (p.type == 1 ? am : cbd) += p.density * 3.14159265358979 / 6.0 * std::pow(p.diameter, 3);
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

TEST(Densities, MakeABodyWeighItsEnvelope) {
  const Recipe recipe = cell(15.0);
  const double sphere = 3.14159265358979323846 / 6.0 * std::pow(1.59, 3);
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
