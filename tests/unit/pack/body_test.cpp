// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/body.h"
#include "support.h"
#include <numeric>

namespace {
using namespace calendem;
using calendem_test::cell;

bool connected(const Body &b, double spacing) {
  std::vector<size_t> reached = {0};
  std::vector<bool> seen(b.primaries.size(), false);
  seen[0] = true;
  for (size_t k = 0; k < reached.size(); ++k)
    for (size_t j = 0; j < b.primaries.size(); ++j)
      if (!seen[j] && (b.primaries[j] - b.primaries[reached[k]]).norm() < 1.01 * spacing) {
        seen[j] = true;
        reached.push_back(j);
      }
  return reached.size() == b.primaries.size();
}

TEST(Shape, SphericityIsOneForASphereAndFallsWithIrregularity) {
  double before = 1.0;
  for (double irregularity : {0.0, 0.1, 0.2}) {
    Random random(1, 1);
    const Shape shape(random, irregularity);
    if (irregularity == 0.0)
      EXPECT_NEAR(shape.sphericity(), 1.0, 2e-3); // facets of the mesh
    else
      EXPECT_LT(shape.sphericity(), before);
    before = shape.sphericity();
  }
}

TEST(Shape, RoughnessHasTheRecipeSVariance) {
  double sum = 0.0, square = 0.0;
  const int shapes = 400, directions = 20;
  Random random(1, 1);
  for (int k = 0; k < shapes; ++k) {
    const Shape shape(random, 0.1);
    for (int d = 0; d < directions; ++d) {
      const double f = shape.radius(random.direction()) - 1.0;
      sum += f / (shapes * directions);
      square += f * f / (shapes * directions);
    }
  }
  EXPECT_NEAR(sum, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(square), 0.1, 0.01);
}

TEST(MakeBodies, MassIsExactToHalfAPrimary) {
  const Recipe recipe = cell(15.0);
  double volume = 0.0;
  for (const Body &b : make_bodies(recipe))
    volume += b.volume;
  const double wanted = recipe.area() * recipe.am_column();
  EXPECT_NEAR(volume, wanted, 0.5 * std::pow(recipe.lattice, 3) + 1e-9);
  EXPECT_NEAR(volume / wanted, 1.0, 0.003);
}

TEST(MakeBodies, BodiesAreConnectedLatticesNotWiderThanAllowed) {
  const Recipe recipe = cell(15.0);
  const std::vector<Body> bodies = make_bodies(recipe);
  EXPECT_GE(bodies.size(), 50u);
  for (const Body &b : bodies) {
    EXPECT_TRUE(connected(b, recipe.lattice));
    EXPECT_LE(b.width, 0.7 * 15.0);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d &p : b.primaries) {
      mean += p;
      for (const Eigen::Vector3d &q : b.primaries)
        EXPECT_LE((p - q).norm() + recipe.primary_diameter, b.width + 1e-12);
      const Eigen::Vector3d site =
          b.lattice.conjugate() * (p - b.primaries.front()) / recipe.lattice;
      EXPECT_NEAR((site - site.array().round().matrix()).norm(), 0.0, 1e-9);
    }
    EXPECT_NEAR(mean.norm(), 0.0, 1e-9);
  }
}

TEST(MakeBody, ShapesThatAreTooWideAreDrawnAgainOrCutOff) {
  Recipe recipe = cell(15.0);
  recipe.irregularity = 0.3;
  Random random(1, 1);
  int redrawn = 0;
  for (int k = 0; k < 5; ++k) {
    const Body b = make_body(recipe, 140, random);
    EXPECT_LE(b.width, 10.5);
    EXPECT_EQ(b.primaries.size(), 140u);
    EXPECT_TRUE(connected(b, recipe.lattice));
    redrawn += b.redrawn;
  }
  EXPECT_GT(redrawn, 0);
  EXPECT_THROW(make_body(recipe, 400, random), Failure);
}

TEST(MakeBodies, SameSeedSameBodiesOtherSeedOthers) {
  const std::vector<Body> a = make_bodies(cell(12.0, 1)), b = make_bodies(cell(12.0, 1)),
                          c = make_bodies(cell(12.0, 2));
  ASSERT_EQ(a.size(), b.size());
  for (size_t k = 0; k < a.size(); ++k)
    EXPECT_EQ(a[k].primaries, b[k].primaries);
  EXPECT_NE(a.front().lattice.coeffs(), c.front().lattice.coeffs());
}

TEST(Random, StreamsAreIndependentOfEachOther) {
  Random a(1, 1), b(1, 2), again(1, 1);
  const double first = a.uniform();
  EXPECT_EQ(first, again.uniform());
  EXPECT_NE(first, b.uniform());
  EXPECT_GT(first, 0.0);
  EXPECT_LT(first, 1.0);
}

TEST(Random, OrientationsAreUniform) {
  Random random(7, 1);
  double cosine = 0.0;
  const int n = 20000;
  for (int k = 0; k < n; ++k)
    cosine += (random.rotation() * Eigen::Vector3d::UnitZ()).cwiseAbs().maxCoeff() / n;
  EXPECT_NEAR(cosine, 0.831, 0.002); // what electrode.json calls random
}

} // namespace
