// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/packing_state.h"
#include "physics/pi.h"
#include "support.h"

namespace {
using namespace calendem;
using calendem_test::cell;

std::vector<Particle> moved(const Recipe &recipe, const Body &b, const Eigen::Quaterniond &turn,
                            const Eigen::Vector3d &to) {
  std::vector<Particle> out;
  for (const Eigen::Vector3d &p : b.primaries)
    out.push_back({static_cast<int>(out.size()) + 1, 1, recipe.primary_diameter, 1.0,
                   in_cell(recipe, to + turn * p), 1});
  return out;
}

TEST(FindPoses, RecoversARigidMotionAcrossPeriodicFaces) {
  const Recipe recipe = cell(15.0);
  Random random(1, 5);
  const Body b = make_body(recipe, 120, random); // wider than half the cell
  ASSERT_GT(b.width, 7.5);
  const Eigen::Quaterniond turn = random.rotation();
  const Eigen::Vector3d to(14.9, 0.2, 20.0);
  const Pose pose = find_poses(recipe, {b}, moved(recipe, b, turn, to)).front();
  EXPECT_NEAR((pose.centre - to).norm(), 0.0, 1e-9);
  EXPECT_NEAR(pose.turn.angularDistance(turn * b.lattice), 0.0, 1e-7);
  EXPECT_NEAR(pose.distortion, 0.0, 1e-9);
}

TEST(FindPoses, SeesAPrimaryThatLeftItsPlace) {
  const Recipe recipe = cell(15.0);
  Random random(1, 5);
  const Body b = make_body(recipe, 40, random);
  std::vector<Particle> particles =
      moved(recipe, b, Eigen::Quaterniond::Identity(), {7.0, 7.0, 7.0});
  particles[30].x.z() += 0.1;
  const double distortion = find_poses(recipe, {b}, particles).front().distortion;
  EXPECT_GT(distortion, 0.08);
  EXPECT_LT(distortion, 0.1);
}

TEST(MeasureEnvelope, ABodyHasTheVolumeOfItsLatticeCells) {
  const Recipe recipe = cell(15.0);
  Random random(1, 5);
  const Body b = make_body(recipe, 120, random);
  const std::vector<Particle> particles =
      moved(recipe, b, Eigen::Quaterniond::Identity(), {14.0, 7.0, 20.0});
  const Envelope e = measure_envelope(recipe, particles);
  EXPECT_NEAR(e.am / b.volume, 1.0, 0.01);
  EXPECT_EQ(e.am, e.total);
}

TEST(MeasureEnvelope, CountsOverlapsOnce) {
  const Recipe recipe = cell(15.0);
  const double d = 1.316, sphere = kPi / 6.0 * d * d * d;
  std::vector<Particle> particles;
  for (int k = 0; k < 100; ++k) { // pairs at one place, clear of the next
    const int pair = k / 2, column = pair % 10, row = pair / 10;
    particles.push_back(
        {k + 1, 2, d, 1.0,
         Eigen::Vector3d(1.4 * column + 0.03 * pair, 1.5 * row, 10.0 + 0.017 * pair), 0});
  }
  EXPECT_NEAR(measure_envelope(recipe, particles).total / (50.0 * sphere), 1.0, 0.01);
}

} // namespace
