// SPDX-License-Identifier: GPL-2.0-or-later
// What of a truth is handed out and sealed.
#include "base/experiment.h"
#include "small_round.h"
#include <cmath>
#include <set>

namespace {

using namespace calendem_test;

Experiment handed(const Round &round, const Truth &truth, std::uint64_t seed) {
  const auto folder = std::filesystem::path(round.file).parent_path() / "out";
  hand_out(folder.string(), "007", round, truth, {pressed(30), pressed(50)}, seed);
  return read_experiment((folder / "experiment.toml").string());
}

/// Standard deviation of (porosity handed out - true) over the stated one, of 120 draws.
double noise_over_stated(const Round &round, const Truth &truth) {
  double sum = 0.0;
  for (std::uint64_t k = 0; k < 60; ++k)
    for (const Condition &c : handed(round, truth, k).conditions)
      sum += std::pow((c.porosity_after_percent->value - 43.0) / c.porosity_after_percent->sd, 2);
  return std::sqrt(sum / 120);
}

TEST(HandedOut, NoiseIsWhatTheFileStatesUnlessUnderstated) {
  const Round round = round_of(kRound);
  Truth truth = draw_truths(round, "secret")[0];
  const double chance = 4.0 / std::sqrt(2.0 * 120); // relative sd of a standard deviation, times 4
  EXPECT_NEAR(noise_over_stated(round, truth), 1.0, chance);
  truth.understated = 3.0;
  EXPECT_NEAR(noise_over_stated(round, truth), 3.0, 3.0 * chance);
}

// As a laboratory's file has them: conditions of other specimens, which are compared as one.
TEST(HandedOut, RepeatsAreSpecimensPressedAlike) {
  std::string text = kRound;
  text.insert(text.find("samples"), "repeats = 3\n");
  const Round round = round_of(text);
  const Truth truth = draw_truths(round, "secret")[0];
  const auto folder = std::filesystem::path(round.file).parent_path() / "out";
  std::vector<PressedSamples> shown;
  for (int k = 0; k < 3; ++k)
    shown.insert(shown.end(), {pressed(30), pressed(50)});
  hand_out(folder.string(), "007", round, truth, shown, 1);
  const Experiment e = read_experiment((folder / "experiment.toml").string());
  ASSERT_EQ(e.conditions.size(), 6u);
  EXPECT_EQ(e.train, (std::vector<std::string>{"p30", "p30_2", "p30_3"}));
  EXPECT_EQ(e.test, (std::vector<std::string>{"p50", "p50_2", "p50_3"}));
  std::set<double> values;
  for (std::size_t k = 0; k < 6; ++k) {
    const Condition &c = e.conditions[k];
    EXPECT_EQ(c.max_pressure_MPa->value, k % 2 == 0 ? 30 : 50);
    EXPECT_EQ(c.specimen, e.conditions[k - k % 2].specimen); // pressed to both pressures
    EXPECT_TRUE(values.insert(c.porosity_after_percent->value).second) << "one reading twice";
  }
  EXPECT_NE(e.conditions[0].specimen, e.conditions[2].specimen);
  EXPECT_NEAR(sample_area_cm2(e) * 1e8, 3 * 36.0, 1e-3); // of one specimen
}

std::filesystem::path folder_to_seal(const Round &round) {
  const auto folder = std::filesystem::path(round.file).parent_path();
  std::filesystem::create_directories(folder / "sealed");
  return folder;
}

// Samples of all repeats, with the cause and without it. Every thickness is another.
TEST(HandedOut, EverySampleOfEveryRepeatIsSealedAlone) {
  std::string text = kRound;
  text.insert(text.find("samples"), "repeats = 2\n");
  const Round round = round_of(text);
  const auto thickness = [](bool with, std::size_t repeat, std::size_t pressure,
                            std::size_t sample) {
    return 10.0 + double(((with ? 0 : 2) + repeat) * 6 + pressure * 3 + sample); // um
  };
  PressedTruth single = {draw_truths(round, "secret")[2], {}, {}};
  for (const bool with : {true, false})
    for (std::size_t repeat = 0; repeat < 2; ++repeat)
      for (std::size_t p = 0; p < 2; ++p) {
        PressedSamples samples = pressed(round.bank.pressures[p]);
        for (std::size_t k = 0; k < 3; ++k)
          samples[k].thickness_at_max = thickness(with, repeat, p, k);
        (with ? single.shown : single.without_cause).push_back(samples);
      }
  const auto folder = folder_to_seal(round);
  seal_round(folder.string(), round, {single}, "secret");
  const std::string alone = (folder / "sealed/samples/001/").string();
  for (const bool with : {true, false})
    for (std::size_t k = 0; k < 6; ++k) {
      const Experiment e = read_experiment(alone + std::to_string(k) + (with ? "" : "_without") +
                                           "/experiment.toml");
      ASSERT_EQ(e.conditions.size(), 2u);
      for (std::size_t p = 0; p < 2; ++p)
        EXPECT_NEAR(e.conditions[p].thickness_at_max_um->value, thickness(with, k / 3, p, k % 3),
                    6 * 0.05);
    }
  EXPECT_FALSE(std::filesystem::exists(alone + "6"));
}

// What did not change is measured twice.
TEST(HandedOut, BothExperimentsOfAnInterventionHaveErrorsOfTheirOwn) {
  const Round round =
      round_of(kRound.substr(0, kRound.find("[noise]")) + "interventions = [\"nothing\"]\n");
  const std::vector<PressedSamples> shown = {pressed(30), pressed(50)};
  const auto folder = folder_to_seal(round);
  seal_round(folder.string(), round, {{draw_truths(round, "secret").back(), shown, shown}},
             "secret");
  const auto conditions = [&](const char *when) {
    return read_experiment((folder / "handed_out/001" / when / "experiment.toml").string())
        .conditions;
  };
  const std::vector<Condition> before = conditions("before"), after = conditions("after");
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    const Measured &porosity = *before[k].porosity_after_percent;
    EXPECT_NE(porosity.value, after[k].porosity_after_percent->value);
    EXPECT_NEAR(porosity.value, after[k].porosity_after_percent->value, 8 * porosity.sd);
    EXPECT_EQ(before[k].max_pressure_MPa->value, after[k].max_pressure_MPa->value);
  }
}

TEST(HandedOut, CurvesAreThoseOfThePressTrueButForItsErrors) {
  const Round round = round_of(kRound);
  Truth truth = draw_truths(round, "secret")[0];
  truth.pressure_error = 0.1;
  truth.hidden = {"displacement_scale"};
  const Experiment e = handed(round, truth, 1);
  std::ifstream in(e.conditions[1].curve);
  std::string line;
  int rows = 0;
  for (std::getline(in, line); std::getline(in, line); ++rows) {
    const double d = std::stod(line), p = std::stod(line.substr(line.find(',') + 1));
    const bool down = line.find("compression") != std::string::npos;
    const double true_d = (down ? 0.0 : 2.0) + (down ? 3.0 : 1.0) * 1.1 * p / 50;
    EXPECT_NEAR(d, find_hidden("displacement_scale")->press.displacement_factor * true_d, 5 * 0.02);
  }
  EXPECT_EQ(rows, 40 + 39);
  EXPECT_NEAR(sample_area_cm2(e) * 1e8, 3 * 36.0, 1e-3); // um2: three of the bank's cells
  EXPECT_EQ(e.train, std::vector<std::string>{"p30"});
  EXPECT_EQ(e.test, std::vector<std::string>{"p50"});
}

TEST(HandedOut, APressMayShowTooMuchPressureSpringBackLateAndDrift) {
  const Round round = round_of(kRound);
  Truth truth = draw_truths(round, "secret")[0];
  truth.pressure_error = 0.0;
  truth.hidden = {"pressure_offset", "frame_hysteresis", "drift"};
  EXPECT_NEAR(truth_runs(round, {truth}).study.runs[1].settings.number("platen.max_pressure_MPa"),
              50 - find_hidden("pressure_offset")->press.pressure_offset_MPa, 1e-9);
  const Experiment e = handed(round, truth, 1);
  std::ifstream in(e.conditions[1].curve);
  std::string line;
  int row = 40 - 37; // the first rows are below the offset
  for (std::getline(in, line); std::getline(in, line); ++row) {
    const double d = std::stod(line), p = std::stod(line.substr(line.find(',') + 1)) - 4.0;
    const bool down = line.find("compression") != std::string::npos;
    const double true_d = (down ? 0.0 : 2.3) + (down ? 3.0 : 1.0) * p / 50 + 0.4 * (row + 1) / 80;
    EXPECT_NEAR(d, true_d, 5 * 0.02 + 0.01) << line;
  }
}

} // namespace
