// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/electrode_files.h"
#include "support.h"
#include <nlohmann/json.hpp>

namespace {
using namespace calendem;
using calendem_test::cell;

class Described : public testing::Test {
protected:
  void SetUp() override {
    recipe = cell(10.0);
    bodies = make_bodies(recipe);
    particles = place(recipe, bodies).particles;
    poses = find_poses(recipe, bodies, particles);
    state = examine(recipe, bodies, particles);
    json = describe({recipe, bodies, particles, poses, state, {76.6, 0.01, 0.001}});
  }
  int status_with(const char *key, const nlohmann::json &value) {
    nlohmann::json changed = json;
    changed[key] = value;
    try {
      check_targets(changed, recipe, "electrode");
    } catch (const Failure &e) {
      EXPECT_NE(std::string(e.what()).find("electrode: "), std::string::npos);
      return e.exit_status();
    }
    return kDone;
  }
  Recipe recipe;
  std::vector<Body> bodies;
  std::vector<Particle> particles;
  std::vector<Pose> poses;
  PackingState state;
  nlohmann::json json;
};

TEST_F(Described, LoosePlacementMeetsEveryTarget) {
  EXPECT_NO_THROW(check_targets(json, recipe, "electrode"));
  EXPECT_NEAR(json["porosity_total"].get<double>(), 0.4797, 0.005);
  EXPECT_NEAR(json["porosity_macro"].get<double>() + json["porosity_nano"].get<double>(),
              json["porosity_total"].get<double>(), 1e-12);
  EXPECT_EQ(json["bonds"], json["pairs_as_made"]);
}

TEST_F(Described, EveryTargetThatIsMissedIsExitFour) {
  EXPECT_EQ(status_with("loading_mg_cm2", 17.0), kCheckFailed);
  EXPECT_EQ(status_with("porosity_total", 0.47), kCheckFailed);
  EXPECT_EQ(status_with("platen_pressure_MPa", 0.2), kCheckFailed);
  EXPECT_EQ(status_with("platen_pressure_MPa", std::nan("")), kCheckFailed);
  EXPECT_EQ(status_with("largest_body_force_nN", 6e4), kCheckFailed);
  EXPECT_EQ(status_with("rms_speed_m_s", 0.01), kCheckFailed);
  EXPECT_EQ(status_with("pairs_changed", 1), kCheckFailed);
  EXPECT_EQ(status_with("platen_pressure_MPa", 0.05), kDone);
}

TEST_F(Described, ProfileOfCbdIsThatOfItsSpheres) {
  double n = 0.0, sum = 0.0;
  for (Particle &p : particles)
    if (p.type == 2) { // half of them at 1/4 of the height, half at 3/4: the mean is in the middle
      p.x.z() = 0.5 * p.diameter + (recipe.thickness() - p.diameter) * (int(n) % 2 ? 0.75 : 0.25);
      sum += int(n) % 2 ? 0.75 : 0.25;
      ++n;
    }
  const nlohmann::json profile =
      describe({recipe, bodies, particles, poses, state, {76.6, 0.01, 0.001}})["cbd_over_height"];
  const std::vector<double> fifths = profile["share_by_fifths_of_height"];
  EXPECT_NEAR(profile["slope"].get<double>(), 3.0 * (2.0 * sum / n - 1.0), 1e-12);
  EXPECT_NEAR(fifths[1] + fifths[3], 1.0, 1e-12);
  EXPECT_NEAR(fifths[1], 0.5, 0.5 / n + 1e-12);
  EXPECT_EQ(profile["slope_asked"], 0.0);
}

TEST_F(Described, HistogramCountsEveryBody) {
  int sum = 0;
  for (const int n : json["sphericity_histogram"]["count"])
    sum += n;
  EXPECT_EQ(sum, static_cast<int>(bodies.size()));
}

} // namespace
