// SPDX-License-Identifier: GPL-2.0-or-later
// Requirement, formulas and tolerances: README.md of this folder.
#include <cmath>

#include <gtest/gtest.h>

#include "spheres.h"

using namespace calendem;

namespace {

// Positions at 0.01 us of a cube whose spheres were set in motion.
std::vector<Vec3> positions(double dt, const std::string &damping) {
  std::vector<BodySphere> all = cube(2, 1.28, {-0.64, -0.64, -0.64}, 1);
  for (size_t n = 0; n < all.size(); ++n) {
    all[n].v = {std::sin(1.0 + n), std::sin(2.0 + 3.0 * n), std::cos(5.0 * n)};
    all[n].omega = {std::cos(1.0 + n), std::cos(2.0 + 3.0 * n), std::sin(5.0 * n)};
  }
  const std::string steps = number(std::round(0.01 / dt));
  const CaseRun run("in.body",
                    {{"Ey", "1e3"},
                     {"restitution", "1"},
                     {"friction", "0"},
                     {"ced", "0"},
                     {"damping", damping},
                     {"dt", number(dt)},
                     {"steps", steps},
                     {"every", steps}},
                    1, files_of(all, {-20, -20, -20}, {20, 20, 20}));
  std::vector<Vec3> x;
  const auto frames = run.frames();
  EXPECT_EQ(frames.size(), 2u) << run.why();
  for (const Row &r : frames.back())
    x.push_back({r.at("x"), r.at("y"), r.at("z")});
  return x;
}

double distance(const std::vector<Vec3> &a, const std::vector<Vec3> &b) {
  double sum = 0.0;
  for (size_t n = 0; n < a.size(); ++n)
    sum += norm_squared(a[n] - b[n]);
  return std::sqrt(sum / a.size());
}

double order(const std::string &damping) {
  const auto coarse = positions(1e-5, damping), fine = positions(5e-6, damping),
             finest = positions(2.5e-6, damping);
  const double p = std::log2(distance(coarse, fine) / distance(fine, finest));
  std::printf("damping %s: error about %.1e um at 1e-5 us, order %.3f\n", damping.c_str(),
              distance(coarse, fine), p);
  return p;
}

} // namespace

TEST(VerificationConvergence, SecondOrderInTheStep) { EXPECT_NEAR(order("0"), 2.0, 0.1); }

TEST(VerificationConvergence, FirstOrderWithBondDamping) { EXPECT_NEAR(order("0.1"), 1.0, 0.1); }
