// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies touch where the smooth particles that they stand for would (docs/model/contacts.md).
#include "electrode/pack/body.h"
#include "physics/pi.h"
#include "support.h"
#include <cmath>
#include <cstdio>

namespace {
using namespace calendem;
using calendem_test::cell;

// Distance of the centres along z at which primaries of that diameter touch.
double touching(const Body &below, const Body &above, double diameter) {
  double most = 0.0;
  for (const Eigen::Vector3d &a : below.primaries)
    for (const Eigen::Vector3d &b : above.primaries) {
      const double x = a.x() - b.x(), y = a.y() - b.y();
      const double square = diameter * diameter - x * x - y * y;
      if (square > 0.0)
        most = std::fmax(most, a.z() - b.z() + std::sqrt(square));
    }
  return most;
}

Body turned(Body body, Random &random) {
  const Eigen::Quaterniond turn = random.rotation();
  for (Eigen::Vector3d &p : body.primaries)
    p = turn * p;
  return body;
}

// Mean volume that pairs of bodies keep to themselves, over that of smooth spheres as large.
double kept_clear(double diameter, double lattice, double inset) {
  constexpr int kBodies = 16, kPairs = 100;
  Recipe recipe = cell(15.0);
  recipe.primary_diameter *= lattice / recipe.lattice;
  recipe.lattice = lattice;
  const int count = static_cast<int>(std::lround(kPi / 6.0 * std::pow(diameter / lattice, 3)));
  Random random(1, 1);
  std::vector<Body> bodies;
  for (int k = 0; k < kBodies; ++k)
    bodies.push_back(make_body(recipe, count, random));
  double sum = 0.0;
  for (int k = 0; k < kPairs; ++k) {
    const Body a = turned(bodies[k % kBodies], random);
    const Body b = turned(bodies[(k * 7 + 3) % kBodies], random);
    sum += std::pow(touching(a, b, recipe.primary_diameter - 2.0 * inset) / diameter, 3);
  }
  return sum / kPairs;
}

} // namespace

// Fine primaries show the shapes themselves, which are not round either.
TEST(Surface, TipsOfPrimariesKeepBodiesApart) {
  constexpr double kFine = 0.4;
  for (const double diameter : {4.4, 6.0}) {
    const double tips = kept_clear(diameter, 1.28, 0.0);
    const double flush = kept_clear(diameter, 1.28, 0.155);
    const double shapes = kept_clear(diameter, kFine, 0.155 * kFine / 1.28);
    std::printf("%.1f um: %.3f at the tips, %.3f with an inset of 0.155 um, %.3f of the shapes\n",
                diameter, tips, flush, shapes);
    // 0.04 to 0.05: two standard errors of a mean of 100 pairs, whose distances differ by 7 %
    EXPECT_LT(std::fabs(flush - shapes), 0.2 * (tips - shapes));
  }
}
