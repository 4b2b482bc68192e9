// SPDX-License-Identifier: GPL-2.0-or-later
// Single particles that were crushed: the line through the simulated loads, and what measured ones say of the strength.
#include "base/provenance.h"
#include "predict/crushed.h"
#include "support/made_coatings.h"
#include "support/test_folder.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;

std::string table(const std::string &rows) {
  const std::string file = (test_folder() / "crushing.csv").string();
  write_file(file, "diameter_um,strength_MPa,load_mN\n" + rows);
  return file;
}

/// 0.01 mN/MPa at 1 um, growing as the diameter: no scatter.
TEST(CrushingLoads, FindThePowerLawTheyAreMadeOf) {
  const CrushingLoads loads(table("5,500,25\n5,250,12.5\n10,500,50\n20,1000,200\n"));
  EXPECT_NEAR(std::exp(loads.log_load(8.0, 700.0)), 0.01 * 8.0 * 700.0, 1e-9);
  EXPECT_NEAR(loads.covariance(8.0, 8.0), 0.0, 1e-15);
  EXPECT_EQ(loads.diameters(), (std::vector<double>{5.0, 10.0, 20.0}));
  EXPECT_TRUE(loads.covers(5.0) && loads.covers(20.0));
  EXPECT_FALSE(loads.covers(4.5) || loads.covers(21.0));
}

// The load may grow faster than the strength: here as its power 1.8. Of one strength nobody knows.
TEST(CrushingLoads, FindThePowerOfTheStrength) {
  const auto load = [](double d, double s) { return 0.01 * d * 500.0 * std::pow(s / 500.0, 1.8); };
  std::string rows;
  for (const double d : {5.0, 10.0})
    for (const double s : {300.0, 500.0, 900.0})
      rows += fmt::format("{},{},{}\n", d, s, load(d, s));
  const CrushingLoads loads(table(rows));
  EXPECT_NEAR(loads.power(), 1.8, 1e-6);
  EXPECT_NEAR(std::exp(loads.log_load(8.0, 700.0)), load(8.0, 700.0), 1e-4);
  EXPECT_EQ(CrushingLoads(table("5,500,25\n5,500,24\n10,500,50\n20,500,100\n")).power(), 1.0);
}

// At the middle of the diameters' logarithms the line is the mean: its variance is that of the residuals over n. At
// the ends the slope adds the same again: two diameters, each with half of the particles.
TEST(CrushingLoads, FewParticlesLeaveTheLineOpen) {
  const double e = std::exp(0.3);
  const CrushingLoads loads(table(
      fmt::format("5,500,{}\n5,500,{}\n20,500,{}\n20,500,{}\n", 25 * e, 25 / e, 100 * e, 100 / e)));
  const double variance = 4 * 0.3 * 0.3 / 2; // two of four degrees of freedom are the line's
  EXPECT_NEAR(loads.log_load(10.0, 500.0), std::log(50.0), 1e-4);
  EXPECT_NEAR(loads.covariance(10.0, 10.0), variance / 4, 1e-6);
  EXPECT_NEAR(loads.covariance(5.0, 5.0), variance / 2, 1e-6);
  EXPECT_NEAR(loads.covariance(5.0, 20.0), 0.0, 1e-6);
}

TEST(CrushingLoads, ATableThatIsNoneIsRefused) {
  for (const char *rows :
       {"5,500,25\n5,250,12\n10,500,50\n", "5,500,25\n5,250,12\n5,500,20\n5,1,2\n",
        "5,500,25\n5,250,12\n10,500,-50\n20,1000,200\n",
        "5,500,25\n5,250,12\n10,500\n20,1000,200\n"})
    EXPECT_THROW(CrushingLoads(table(rows)), Failure) << rows;
  const auto refusal = [](const std::string &file) {
    try {
      CrushingLoads loads(file);
    } catch (const Failure &f) {
      return std::string(f.what());
    }
    return std::string();
  };
  const std::string other = table("");
  write_file(other, "diameter_um,strength_MPa,load_N\n5,500,25\n");
  EXPECT_NE(refusal(other).find("no column load_mN"), std::string::npos) << refusal(other);
  EXPECT_NE(refusal(other + ".no").find("no such file"), std::string::npos);
}

CalibrationSettings many() {
  CalibrationSettings s;
  s.samples = 4096;
  s.draws = 1000;
  return s;
}

struct Log {
  double mean = 0.0, sd = 0.0;
};

/// Moments of the strength's logarithm among the draws.
Log strength_in(const Calibration &c, std::size_t material = 0) {
  double sum = 0.0, squares = 0.0;
  for (const Draw &d : c.draws) {
    const double x =
        std::log(d.materials[material].parameters[std::size_t(made_film_bank().strength())]);
    sum += x;
    squares += x * x;
  }
  const double n = double(c.draws.size());
  return {sum / n, std::sqrt(squares / n - sum * sum / n / n)};
}

/// The prior, even in the logarithm from 250 to 1000 MPa, times a normal: moments by quadrature.
Log posterior(double mean, double variance) {
  const int n = 20000;
  const double low = std::log(250.0), high = std::log(1000.0);
  double sum = 0.0, first = 0.0, second = 0.0;
  for (int k = 0; k < n; ++k) {
    const double x = low + (high - low) * (k + 0.5) / n;
    const double w = std::exp(-0.5 * (x - mean) * (x - mean) / variance);
    sum += w;
    first += w * x;
    second += w * x * x;
  }
  const double m = first / sum;
  return {m, std::sqrt(second / sum - m * m)};
}

Calibration crushed(const std::vector<Crushed> &particles) {
  Calibration c;
  c.films = {made_film("a", 48.0, 2.0)};
  c.crushed = particles;
  calibrate(made_film_bank(), many(), c);
  return c;
}

// The mean of 1000 independent draws would be known to 0.03 sd, the sd to 0.02; three times that is
// allowed.
TEST(Crushed, OneLoadTellsTheStrengthAsFarAsTheModelGoes) {
  const CrushingLoads &loads = *made_film_bank().crushing();
  const double load = std::exp(loads.log_load(10.0, 600.0)), relative = 0.1;
  const Log found = strength_in(crushed({{0, 10.0, load, relative * load}})),
            expected =
                posterior(std::log(600.0), (kCrushingModel * kCrushingModel +
                                            loads.covariance(10.0, 10.0) + relative * relative) /
                                               std::pow(loads.power(), 2));
  EXPECT_NEAR(found.mean, expected.mean, 0.1 * expected.sd);
  EXPECT_NEAR(found.sd, expected.sd, 0.1 * expected.sd);
}

// With four crushed particles in the bank, which scatter by a factor of 1.8, the line is what is known least.
TEST(Crushed, FewParticlesInTheBankSayLess) {
  bank::Runs few = made_coatings();
  few.bank.crushing_file = table("5,500,45\n5,500,14\n20,500,180\n20,500,55\n");
  const FilmBank bank = film_bank_of(few);
  const double load = std::exp(bank.crushing()->log_load(10.0, 500.0)),
               open = bank.crushing()->covariance(10.0, 10.0);
  EXPECT_GT(open, kCrushingModel * kCrushingModel);
  Calibration c;
  c.films = {made_film("a", 48.0, 2.0)};
  c.crushed = {{0, 10.0, load, 0.1 * load}};
  const auto at = [&](double strength) {
    return log_likelihood_of_crushed(bank, c, 0, {{190.0, 2.4, strength}, {}});
  };
  const double off = std::log(800.0 / 500.0);
  EXPECT_NEAR(at(500.0) - at(800.0),
              0.5 * off * off / (open + kCrushingModel * kCrushingModel + 0.01), 1e-9);
}

// The model's error is common to all: many particles do not make it smaller.
TEST(Crushed, TheModelsErrorRemainsWithManyLoads) {
  const CrushingLoads &loads = *made_film_bank().crushing();
  std::vector<Crushed> all;
  for (int k = 0; k < 20; ++k) {
    const double load = std::exp(loads.log_load(8.0, 500.0));
    all.push_back({0, 8.0, load, 0.1 * load});
  }
  const Log found = strength_in(crushed(all)),
            expected = posterior(std::log(500.0), (kCrushingModel * kCrushingModel +
                                                   loads.covariance(8.0, 8.0) + 0.01 / 20) /
                                                      std::pow(loads.power(), 2));
  EXPECT_NEAR(found.mean, expected.mean, 0.1 * expected.sd);
  EXPECT_NEAR(found.sd, expected.sd, 0.1 * expected.sd);
}

// Loads of the second material say less about the first than about the second: half of its shift of 0.4, as alike as two
// materials are on average.
TEST(Crushed, LoadsAreThoseOfTheirMaterial) {
  const CrushingLoads &loads = *made_film_bank().crushing();
  Calibration c;
  c.materials = {"first", "second"};
  c.films = {made_film("a", 48.0, 2.0), made_film("b", 48.0, 2.0)};
  c.films[1].material = 1;
  const double load = std::exp(loads.log_load(10.0, 950.0));
  c.crushed = {{1, 10.0, load, 0.1 * load}};
  calibrate(made_film_bank(), many(), c);
  EXPECT_GT(strength_in(c, 1).mean - strength_in(c, 0).mean, 0.1);
}

// Where a load was read within 10 %, it is known as well, whatever the strength. At another diameter the model's error is the
// same; only the line's is not.
TEST(Crushed, PredictedLoadsAreGivenTheReadings) {
  const CrushingLoads &loads = *made_film_bank().crushing();
  const double load = std::exp(loads.log_load(10.0, 500.0));
  const Calibration c = crushed({{0, 10.0, load, 0.1 * load}});
  const std::vector<Crushing> rows = crushing_of(made_film_bank(), c);
  ASSERT_EQ(rows.size(), 4u); // 5, 7, 10, 12 um
  const Crushing &read = rows[2], &other = rows[0];
  EXPECT_EQ(read.measured, load);
  EXPECT_EQ(other.measured, 0.0);
  const auto width = [](const Crushing &row) {
    return std::log(row.load.high90 / row.load.low90) / (2 * 1.645);
  };
  const double model = kCrushingModel * kCrushingModel, of_strength = strength_in(c).sd,
               here = model + loads.covariance(10.0, 10.0), share = here / (here + 0.01);
  // the strength counts by 1 - share, a tenth: of 1000 draws its mean is open by 0.001, a width by 0.003
  EXPECT_NEAR(std::log(read.load.median / load), 0.0, 0.02);
  EXPECT_NEAR(width(read), std::hypot(std::sqrt(here * (1 - share)), (1 - share) * of_strength),
              0.01);
  const double both = model + loads.covariance(10.0, 5.0);
  const double left = model + loads.covariance(5.0, 5.0) - both * both / (here + 0.01);
  EXPECT_NEAR(width(other), std::hypot(std::sqrt(left), (1 - both / (here + 0.01)) * of_strength),
              0.02);
}

TEST(Crushed, LoadsThatWereNotReadHoldTheModelsError) {
  const CrushingLoads &loads = *made_film_bank().crushing();
  const Calibration c = crushed({});
  const Crushing row = crushing_of(made_film_bank(), c)[2];
  const double sd = std::sqrt(kCrushingModel * kCrushingModel + loads.covariance(10.0, 10.0));
  Mixture logs; // the prior is even in the logarithm
  for (int k = 0; k < 1000; ++k)
    logs.of.push_back({loads.log_load(10.0, 250.0 * std::pow(4.0, (k + 0.5) / 1000)), sd * sd});
  EXPECT_NEAR(std::log(row.load.low90), logs.quantile(0.05), 0.02);
  EXPECT_NEAR(std::log(row.load.high90), logs.quantile(0.95), 0.02);
}

// A newton for a millinewton, or a load that no strength of the bank means.
TEST(Crushed, ALoadThatContradictsTheModelIsReported) {
  const double load = std::exp(made_film_bank().crushing()->log_load(10.0, 500.0));
  Calibration c = crushed({{0, 10.0, load, 0.1 * load}});
  EXPECT_TRUE(contradicting_loads(made_film_bank(), c).empty());
  c = crushed({{0, 10.0, 1000.0 * load, 100.0 * load}});
  const std::vector<std::string> said = contradicting_loads(made_film_bank(), c);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("Check diameter, load and unit"), std::string::npos) << said[0];
}

TEST(Crushed, WhatTheBankCannotSayIsLeftOut) {
  Experiment e;
  e.name = "powder";
  e.crushed = {{3.0, {2.0, 0.1}}, {10.0, {14.0, 0.0}}};
  Calibration c;
  std::vector<std::string> not_said;
  add_crushed(e, made_film_bank(), 0, c, not_said);
  ASSERT_EQ(c.crushed.size(), 1u);
  EXPECT_EQ(c.crushed[0].diameter, 10.0);
  EXPECT_NEAR(c.crushed[0].sd, 0.2 * 14.0, 1e-12);
  ASSERT_EQ(not_said.size(), 1u);
  EXPECT_NE(not_said[0].find("5 to 14 um"), std::string::npos) << not_said[0];
}

} // namespace
