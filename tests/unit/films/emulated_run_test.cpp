// SPDX-License-Identifier: GPL-2.0-or-later
#include "films/emulated_run.h"
#include "support/made_coatings.h"
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;

const std::vector<double> kParameters = {190.0, 2.4, 480.0, 46.0, 2.2};
const Film kOfTheBank = made_film("x", 46.0, 2.2);

SimulatedRun run_to(double pressure) {
  const FilmBank &bank = made_film_bank();
  const Material material = {{kParameters[0], kParameters[1], kParameters[2]}, {}};
  return EmulatedRun(bank, kOfTheBank, pressure)
      .of(bank.emulated(kOfTheBank, {&material}, outputs_of_runs(bank)).mean.col(0));
}

double porosity_under_load(double pressure) {
  return 1.0 - (1.0 - made_porosity(kParameters, 0.0, pressure)) *
                   (1.0 + made_springback(kParameters, pressure));
}

// Porosities are emulated within 0.5 points (FilmBank), so lengths within 0.5 % / 0.54 of the solid column of 13 um.
TEST(EmulatedRun, MeetsTheFormulasBetweenTheBanksPressures) {
  const double solid = made_film_bank().solid_column(kOfTheBank), close = 0.01 * solid;
  for (const double p : {35.0, 110.0, 300.0}) {
    const SimulatedRun run = run_to(p);
    EXPECT_DOUBLE_EQ(run.target, p);
    EXPECT_DOUBLE_EQ(run.porosity_initial, 0.46);
    EXPECT_NEAR(run.porosity_after, made_porosity(kParameters, 0.0, p), 0.005) << p;
    EXPECT_NEAR(run.thickness_after, solid / (1.0 - run.porosity_after), 1e-9);
    EXPECT_NEAR(run.thickness_at_max, solid / (1.0 - porosity_under_load(p)), close) << p;
    EXPECT_NEAR(run.cracked_fraction, made_cracked(kParameters, p), 0.02) << p;
    const double before = solid / 0.54;
    for (const double part : {0.1, 0.25, 0.5, 0.75, 1.0})
      EXPECT_NEAR(displacement_at(run.pressure, run.displacement, part * p),
                  before - solid / (1.0 - porosity_under_load(part * p)), close)
          << p << " " << part;
  }
}

// Its release is linear with a modulus of made_modulus: from all of the pressure to a quarter of it.
TEST(EmulatedRun, ReleasesAlongTheFormula) {
  const SimulatedRun run = run_to(110.0);
  const double at_max = run.displacement.back(),
               recovered = 0.75 * 0.110 / made_modulus(kParameters) * run.thickness_at_max;
  EXPECT_NEAR(at_max - displacement_at(run.release_pressure, run.release_displacement, 27.5),
              recovered, 0.03 * recovered);
  EXPECT_DOUBLE_EQ(run.release_displacement.back(), at_max);
}

TEST(EmulatedRun, ThePressShowsItAsItsInstrumentsDo) {
  const SimulatedRun run = run_to(80.0), shown = shown_by({1.25, 0.02, 3.0}, run);
  EXPECT_DOUBLE_EQ(shown.pressure.back(), 100.0);
  EXPECT_DOUBLE_EQ(shown.displacement.back(), run.displacement.back() + 1.6);
  EXPECT_DOUBLE_EQ(shown.release_displacement.front(),
                   run.release_displacement.front() + 0.02 * run.release_pressure.front());
  EXPECT_DOUBLE_EQ(shown.thickness_after, run.thickness_after + 3.0);
  EXPECT_DOUBLE_EQ(shown.porosity_after, 1.0 - run.solid_column / shown.thickness_after);
}

// Exact for cubics; beyond the places the last value.
TEST(CubicWeights, AreExactForCubics) {
  const std::vector<double> x = {0.0, 1.0, 2.5, 3.0, 4.5};
  const auto f = [](double v) { return 1.0 + v - 2.0 * v * v + 0.5 * v * v * v; };
  inference::Vector values(5);
  for (int k = 0; k < 5; ++k)
    values[k] = f(x[std::size_t(k)]);
  for (const double at : {1.2, 2.5, 2.9})
    EXPECT_NEAR(cubic_weights(x, at).dot(values), f(at), 1e-12) << at;
  EXPECT_DOUBLE_EQ(cubic_weights(x, 9.0).dot(values), values[4]);
  EXPECT_DOUBLE_EQ(cubic_weights(x, -1.0).dot(values), values[0]);
}

} // namespace
