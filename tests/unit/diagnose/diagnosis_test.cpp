// SPDX-License-Identifier: GPL-2.0-or-later
// Diagnoses of films whose numbers come from the formulas of the bank: what acts is known.
#include "base/provenance.h"
#include "diagnose/run_again.h"
#include "support/made_coatings.h"
#include "support/page.h"
#include "support/test_folder.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;
using inference::Verdict;

const std::vector<double> kTruth = {190.0, 2.4, 480.0, 46.0, 2.2};

/// A film pressed to these pressures, with porosities of 0.3 points and cracked shares of 0.02.
/// `collapse` [MPa]: of its nanopores; 300: none.
Experiment measured_film(double collapse, double noise = 1.0,
                         const std::vector<double> &pressures = {20, 35, 50, 80, 150, 300}) {
  const auto folder = test_folder();
  write_file((folder / "film.toml").string(),
             "name = \"film\"\nmaterial = \"nmc111\"\n[coating]\nloading_mg_cm2 = 6\n"
             "porosity_total_percent = 46\n[composition]\ncarbon_weight_percent = 2.2\n"
             "binder_weight_percent = 2.2\n");
  std::string text = "[experiment]\nname = \"film\"\nelectrode = \"film.toml\"\n";
  Random random(5, 1);
  for (const double p : pressures)
    text += fmt::format("[[condition]]\nid = \"p{0:03.0f}\"\ncontrol = \"pressure\"\n"
                        "max_pressure_MPa = {{ value = {0}, sd_relative = 0.01 }}\n"
                        "porosity_after_percent = {{ value = {1:.4f}, sd = 0.3 }}\n"
                        "cracked_bodies_fraction = {{ value = {2:.4f}, sd = 0.02 }}\n",
                        p,
                        100.0 * (made_porosity(kTruth, 0.0, p) - made_collapse(collapse, p)) +
                            noise * 0.3 * random.normal(),
                        std::max(0.0, made_cracked(kTruth, p) + 0.02 * random.normal()));
  write_file((folder / "experiment.toml").string(), text);
  return read_experiment((folder / "experiment.toml").string());
}

Diagnosis diagnosis_of(const Experiment &experiment, std::vector<std::string> acting = {}) {
  DiagnosisOptions options;
  options.acting = std::move(acting);
  options.particles = 128;
  return diagnosed(experiment, made_film_bank(), options);
}

const Diagnosis &of_collapsing_pores() {
  static const Diagnosis d = diagnosis_of(measured_film(30.0));
  return d;
}

TEST(Diagnosis, NamesTheEffectThatActs) {
  const Diagnosis &d = of_collapsing_pores();
  ASSERT_EQ(d.verdict.kind, Verdict::explained);
  ASSERT_EQ(d.verdict.changes.size(), 1u);
  EXPECT_EQ(name_of(d, d.verdict.changes[0]), "cbd_collapse");
  EXPECT_TRUE(d.outside.empty());
  const auto before = inference::standardised_gap(d.model, d.blocks),
             after = inference::standardised_gap(d.explained, d.blocks);
  EXPECT_GT(before.value, before.noise_most);
  EXPECT_LT(after.value, after.noise_most);
}

TEST(Diagnosis, NamesNothingWhereTheModelIsTrue) {
  EXPECT_EQ(diagnosis_of(measured_film(300.0)).verdict.kind, Verdict::nothing_seen);
  EXPECT_EQ(diagnosis_of(measured_film(30.0), {"cbd_collapse"}).verdict.kind,
            Verdict::nothing_seen);
}

// The user's model has an effect that the film has not.
TEST(Diagnosis, NamesAnEffectThatDoesNotAct) {
  const Diagnosis d = diagnosis_of(measured_film(300.0), {"cbd_collapse"});
  bool named = false;
  for (const int k : d.verdict.changes)
    named = named || name_of(d, k) == "no cbd_collapse";
  EXPECT_TRUE(named || d.verdict.kind == Verdict::nothing_seen); // a weak one is as good
  for (const int k : d.verdict.changes)
    EXPECT_NE(name_of(d, k), "nmc_plasticity");
}

// Porosities that scatter by two points, stated as 0.3: larger errors, or something else, but no effect.
TEST(Diagnosis, ErrorsLargerThanStatedAreNoEffect) {
  const Diagnosis d = diagnosis_of(measured_film(300.0, 7.0));
  EXPECT_NE(d.verdict.kind, Verdict::nothing_seen);
  for (const int k : d.verdict.changes)
    EXPECT_TRUE(d.verdict.kind != Verdict::explained || name_of(d, k) == "noise" ||
                name_of(d, k) == "unknown")
        << name_of(d, k);
}

TEST(Diagnosis, SaysWhatLiesOutsideTheBank) {
  const Diagnosis d = diagnosis_of(measured_film(300.0, 1.0, {80, 150, 400}));
  ASSERT_EQ(d.outside.size(), 1u);
  EXPECT_EQ(d.outside[0], "p400: 400 MPa; the bank has 10 to 300 MPa");
  EXPECT_EQ(d.readings.size(), 4u);
}

// What was measured is not proposed again; what is proposed is worth no less than nothing.
TEST(Diagnosis, ProposesMeasurementsThatWereNotMade) {
  const Diagnosis d = diagnosis_of(measured_film(30.0, 1.0, {80, 150}));
  ASSERT_FALSE(d.further.empty());
  for (const FurtherMeasurement &m : d.further) {
    EXPECT_FALSE(m.observable == "total porosity" && (m.pressure == 80.0 || m.pressure == 150.0));
    EXPECT_GT(m.gain.information, -0.05);
    EXPECT_LE(m.gain.probability, 1.0);
  }
}

// Three readings of a curve that are all 1 too high, with errors of 0.1 each and of 2 in common; a curve beside it.
TEST(Diagnosis, CurvesAreDrawnWithTheFirstContactThatFits) {
  Diagnosis d;
  inference::FittedModel model;
  model.residual.resize(4);
  model.residual << 1.0, 1.0, 1.0, 0.0;
  model.covariance = 0.01 * inference::Matrix::Identity(4, 4);
  model.covariance.topLeftCorner(3, 3).array() += 4.0;
  model.covariance(3, 3) += 4.0;
  for (const int k : {0, 1, 2, 3}) {
    Reading r;
    r.condition = k < 3 ? "a" : "b";
    r.observable.by_zero = 2.0;
    d.measured.readings.push_back(r);
    d.readings.push_back(k);
  }
  const inference::Vector zero = fitted_zeros(d, model);
  EXPECT_NEAR(zero[0], 3.0 * 4.0 / (0.01 + 3.0 * 4.0), 1e-12); // ridge regression on a constant
  EXPECT_NEAR(zero[2], zero[0], 1e-12);
  EXPECT_EQ(zero[3], 0.0);
}

TEST(Diagnosis, ItsJsonSaysTheSame) {
  const nlohmann::ordered_json gap = to_json(of_collapsing_pores(), made_film_bank());
  EXPECT_EQ(gap["which"]["claim"], "cbd_collapse");
  EXPECT_EQ(gap["which"]["answer"], "explained");
  EXPECT_EQ(gap["which"]["headline"], "Explained by cbd_collapse");
  EXPECT_EQ(gap["in_bank"], "The data lie inside the bank: made coatings.");
  EXPECT_EQ(gap["where"].size(), 12u);
  EXPECT_EQ(gap["predictions"].size(), 12u);
  const std::string page = diagnosis_page(gap);
  EXPECT_NE(page.find("Explained by cbd_collapse"), std::string::npos);
  EXPECT_EQ(without_scripts(page).find("{{"), std::string::npos);
}

// A run to 80 MPa reads what its film is at 80 MPa, and nothing at the other pressures.
TEST(RunAgain, ReadsARunAsThePressShowsIt) {
  const Diagnosis &d = of_collapsing_pores();
  SimulatedRun run;
  run.target = 80.0;
  run.porosity_after = 0.3;
  run.thickness_after = 10.0;
  run.solid_column = 7.0;
  run.cracked_fraction = 0.2;
  const inference::Vector values = readings_of_run(d, {}, run);
  for (std::size_t k = 0; k < d.readings.size(); ++k) {
    const Reading &r = d.measured.readings[std::size_t(d.readings[k])];
    const double value = values[Eigen::Index(k)];
    if (r.pressure != 80.0)
      EXPECT_TRUE(std::isnan(value));
    else
      EXPECT_NEAR(value, r.observable.unit == "%" ? 30.0 : 0.2, 1e-12);
  }
}

} // namespace
