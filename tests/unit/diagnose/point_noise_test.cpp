// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/random.h"
#include "diagnose/bank_points.h"
#include "support/made_bank.h"
#include "support/test_folder.h"
#include <fstream>
#include <gtest/gtest.h>

namespace {

using namespace calendem;
using namespace calendem_test;

constexpr double kSd = 0.02;
std::vector<std::string> said_of;

/// One condition whose release has 20 rows between a quarter and the whole of 30 MPa, on the bank's
/// line with errors `times` as large as stated.
Experiment released(const BankTable &bank, double times, std::uint64_t seed) {
  Experiment e = made_experiment({"", 0, 99, {1.5, 250.0}, 0.0});
  e.conditions.resize(1);
  e.conditions[0].curve = (test_folder() / "curve.csv").string();
  e.conditions[0].curve_sd_um = kSd;
  const double top = bank.rows[0].run.displacement.back();
  Random random(seed, 1);
  std::ofstream curve(e.conditions[0].curve);
  curve << "displacement_um,pressure_MPa,stage\n" << top << ",30,loading\n";
  for (int k = 19; k >= 0; --k) {
    const double share = 0.25 + 0.75 * k / 20.0;
    curve << top * (0.6 + 0.4 * share) + times * kSd * random.normal() << ',' << 30.0 * share
          << ",unloading\n";
  }
  return e;
}

// The bank's releases are straight lines, which second differences do not see: all is measurement,
// and the score of the sum of 18 squares is standard normal. 100 draws: mean and standard deviation
// to four of their own standard deviations.
TEST(PointNoise, IsStandardNormalIfErrorsAreAsStated) {
  const BankTable bank = with_release(made_bank());
  double sum = 0.0, square = 0.0;
  constexpr int n = 100;
  for (int k = 0; k < n; ++k) {
    const auto noise = point_noise_of(released(bank, 1.0, std::uint64_t(k)), bank, 1.0, said_of);
    ASSERT_EQ(noise.size(), 1u);
    EXPECT_EQ(noise[0].condition, "p30");
    ASSERT_EQ(noise[0].measured.size(), 18);
    EXPECT_GT(noise[0].measured.minCoeff(), 0.999);
    sum += noise[0].score / n;
    square += noise[0].score * noise[0].score / n;
  }
  EXPECT_NEAR(sum, 0.0, 4.0 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(square), 1.0, 4.0 / std::sqrt(2.0 * n));
}

TEST(PointNoise, LargerErrorsAreEstimated) {
  const BankTable bank = with_release(made_bank());
  double sum = 0.0;
  constexpr int n = 50;
  for (int k = 0; k < n; ++k) {
    const auto noise = point_noise_of(released(bank, 3.0, std::uint64_t(k)), bank, 1.0, said_of);
    EXPECT_GT(noise.at(0).score, 3.0);
    sum += noise.at(0).times_stated() / n;
  }
  // a standard deviation of 18 draws is known to 1 / sqrt(36) of it, their correlation apart
  EXPECT_NEAR(sum, 3.0, 4.0 * 3.0 / std::sqrt(36.0 * n));
}

TEST(PointNoise, NeedsARelease) {
  const BankTable bank = made_bank();
  Experiment e = made_experiment({"", 0, 99, {1.5, 250.0}, 0.0});
  EXPECT_TRUE(point_noise_of(e, bank, 1.0, said_of).empty()); // no curve
  EXPECT_TRUE(point_noise_of(released(with_release(bank), 1.0, 1), bank, 1.0, said_of).empty());
}

/// Without the beginnings of all releases, at the maximum.
BankTable begins_lower(BankTable bank) {
  for (BankRow &row : bank.rows) {
    row.run.release_pressure.pop_back();
    row.run.release_displacement.pop_back();
  }
  return bank;
}

// A press's release begins at the maximum, the bank's below it: what both have is judged, here the
// 14 rows from 0.25 to 0.75 of the maximum.
TEST(PointNoise, RowsAboveTheBanksReleaseAreLeftOut) {
  const BankTable bank = with_release(made_bank());
  said_of.clear();
  const auto noise = point_noise_of(released(bank, 1.0, 1), begins_lower(bank), 1.0, said_of);
  ASSERT_EQ(noise.size(), 1u);
  EXPECT_EQ(noise[0].measured.size(), 12);
  EXPECT_TRUE(said_of.empty());
}

TEST(PointNoise, AReleaseOfTooFewRowsIsReported) {
  const BankTable bank = with_release(made_bank());
  Experiment e = released(bank, 1.0, 1);
  std::ifstream whole(e.conditions[0].curve);
  std::string text, line;
  for (int k = 0; k < 7 && std::getline(whole, line); ++k) // five rows of the release
    text += line + "\n";
  whole.close();
  std::ofstream(e.conditions[0].curve) << text;
  said_of.clear();
  EXPECT_TRUE(point_noise_of(e, bank, 1.0, said_of).empty());
  ASSERT_EQ(said_of.size(), 1u);
  EXPECT_NE(said_of[0].find("p30: how much its points scatter is not judged: of 5 rows"),
            std::string::npos)
      << said_of[0];
}

} // namespace
