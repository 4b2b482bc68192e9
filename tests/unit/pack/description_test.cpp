// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/description.h"
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
  EXPECT_EQ(json["bonds"], json["lattice_pairs"]);
}

TEST_F(Described, EveryTargetThatIsMissedIsExitFour) {
  EXPECT_EQ(status_with("loading_mg_cm2", 17.0), kCheckFailed);
  EXPECT_EQ(status_with("porosity_total", 0.47), kCheckFailed);
  EXPECT_EQ(status_with("platen_pressure_MPa", 0.2), kCheckFailed);
  EXPECT_EQ(status_with("platen_pressure_MPa", std::nan("")), kCheckFailed);
  EXPECT_EQ(status_with("largest_body_force_nN", 6e4), kCheckFailed);
  EXPECT_EQ(status_with("rms_speed_m_s", 0.01), kCheckFailed);
  EXPECT_EQ(status_with("bonds", 1), kCheckFailed);
  EXPECT_EQ(status_with("platen_pressure_MPa", 0.05), kDone);
}

TEST_F(Described, HistogramCountsEveryBody) {
  int sum = 0;
  for (const int n : json["sphericity_histogram"]["count"])
    sum += n;
  EXPECT_EQ(sum, static_cast<int>(bodies.size()));
}

} // namespace
