// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "compare/observables.h"
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

namespace calendem {
namespace {

constexpr int kSide = 12;

/// Layers of 12 x 12 voxels; `label` of (i, j, k).
template <class Label> PhaseImage made_image(Label label, double voxel = 0.5) {
  PhaseImage image = empty_phases({kSide, kSide, kSide}, Eigen::Vector3d::Constant(voxel), false);
  for (int k = 0; k < kSide; ++k)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        image.label[image.index(i, j, k)] = label(i, j, k);
  return image;
}

class ImageObservables : public testing::Test {
protected:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("image_observables_" + std::to_string(getpid()));
  Experiment experiment_ = read_experiment(CALENDEM_CASES "/paper/experiment.toml");
  std::vector<std::string> not_said_;

  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::vector<Observable> after(const LabelImage &image) {
    Condition c = experiment_.conditions[1];
    c.labels_after = (folder_ / "after.mha").string();
    write_label_image(image, c.labels_after);
    return image_observables_of(experiment_, c, not_said_);
  }
};

// Requirement: shares by hand. 4 of 12 columns are AM in the lowest third, 6 and 12 above.
TEST(MeasuresOf, SharesOfTheThirds) {
  const PhaseImage image = made_image([](int i, int, int k) {
    const int am = k < 4 ? 4 : k < 8 ? 6 : 12;
    return i < am ? 1 : i < am + 2 ? kCbdLabel : kPoreLabel;
  });
  const ImageMeasures m = measures_of(image);
  EXPECT_NEAR(m.am, 22.0 / 36.0, 1e-12);
  EXPECT_NEAR(m.pore, (6.0 + 4.0 + 0.0) / 36.0, 1e-12);
  EXPECT_NEAR(m.upper_minus_lower, 8.0 / 12.0, 1e-12);
  EXPECT_NEAR(m.middle_minus_others, 0.5 - 0.5 * (1.0 / 3.0 + 1.0), 1e-12);
  EXPECT_NEAR(measures_of(image, 0, 6, 0, kSide).am, (4.0 + 6.0 + 6.0) / 18.0, 1e-12);
}

// Requirement: the deviation of the mean of quarters with shares 1, 1/2, 0, 1/2 is
// sqrt((1/4 + 1/4)/3/4) = 0.2041.
TEST_F(ImageObservables, ScatterOfTheQuarters) {
  const auto list = after(made_image([](int i, int j, int k) {
    return i < 6 && j < 6 ? 1 : i >= 6 && j >= 6 ? 0 : k % 2;
  }));
  ASSERT_EQ(list.size(), 3u); // no whole particle
  EXPECT_EQ(list[0].name, "share of AM, image after");
  EXPECT_EQ(list[0].stage, "relaxation");
  EXPECT_NEAR(list[0].measured, 50.0, 1e-9);
  EXPECT_NEAR(list[0].sd, 100.0 * std::sqrt(0.5 / 12.0), 1e-9);
}

// Requirement: where CBD is labelled the macro porosity is compared, which has no CBD in it.
TEST_F(ImageObservables, MacroPorosityWhereCbdIsLabelled) {
  const auto image = made_image([](int i, int, int) { return i < 3 ? 7 : i < 6 ? 3 : 0; });
  EXPECT_NEAR(after(image)[0].measured, 50.0, 1e-9); // all that has a label is AM
  experiment_.labels_cbd = 3;
  const auto list = after(image);
  EXPECT_EQ(list[0].name, "macro porosity, image after");
  EXPECT_NEAR(list[0].measured, 50.0, 1e-9);
  experiment_.labels_pore = 7;
  EXPECT_NEAR(after(image)[0].measured, 25.0, 1e-9);
  experiment_.labels_pore = 9; // no voxel has it
  EXPECT_THROW(after(image), calendem::Failure);
}

// Requirement: of two whole particles one has a gap; the one at the image's side does not count.
TEST_F(ImageObservables, ParticlesInPieces) {
  const auto list = after(made_image([](int i, int j, int k) {
    const bool inside = i > 0 && i < 11 && j > 0 && j < 11;
    return k == 0 ? 3 : !inside ? 0 : k < 6 ? (i == 5 ? 0 : 1) : k < 11 ? 2 : 0;
  }));
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[3].name, "particles in pieces, image after");
  EXPECT_NEAR(list[3].measured, 0.5, 1e-12);
  EXPECT_NEAR(list[3].sd, std::sqrt(0.25 / 2.0), 1e-12);
  ASSERT_EQ(not_said_.size(), 1u);
  EXPECT_NE(not_said_[0].find("gives each piece its own label"), std::string::npos);
}

// Requirement: a run without frames has no value, and the gap says why, once for all of an image.
TEST_F(ImageObservables, ARunWithoutFramesHasNoValue) {
  SimulatedRun run;
  run.folder = (folder_ / "no_run").string();
  run.control = "pressure";
  run.target = experiment_.conditions[1].max_pressure_MPa->value;
  const auto list = after(made_image([](int i, int, int) { return i % 2; }));
  for (const Observable &o : list) {
    EXPECT_TRUE(std::isnan(o.simulated(run))) << o.name;
    EXPECT_NE(o.why_none(run).find("no_run"), std::string::npos) << o.why_none(run);
  }
  experiment_.conditions[1].labels_after = (folder_ / "after.mha").string();
  int reported = 0;
  for (const std::string &text : find_gap(experiment_, {run}).not_said)
    if (text.find("no value for") != std::string::npos) {
      ++reported;
      for (const Observable &o : list)
        EXPECT_NE(text.find(o.name), std::string::npos) << text;
      EXPECT_NE(text.find(": " + list[0].why_none(run)), std::string::npos) << text;
    }
  EXPECT_EQ(reported, 1);
}

// Requirement: 12 voxels of 0.04 um are 4 of the finest that is compared: too few.
TEST_F(ImageObservables, ALabelThatIsNotThereIsRefused) {
  experiment_.labels_cbd = 77;
  EXPECT_THROW(after(made_image([](int i, int, int) { return i % 2; })), Failure);
}

TEST_F(ImageObservables, AnImageTooSmallIsRefused) {
  try {
    after(made_image([](int i, int, int) { return i % 2; }, 0.04));
    FAIL() << "an image of 0.5 um was compared";
  } catch (const Failure &f) {
    EXPECT_EQ(f.exit_status(), kBadInput);
    EXPECT_NE(std::string(f.what()).find("12 x 12 x 12 voxels of 0.04 um are too few"),
              std::string::npos)
        << f.what();
  }
}

} // namespace
} // namespace calendem
