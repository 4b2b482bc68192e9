// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "films/emulated_run.h"
#include "films/film_problem.h"
#include "support/made_coatings.h"
#include "support/test_folder.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {
using namespace calendem_test;
using inference::Matrix;
using inference::Vector;

/// A film with a curve to 80 MPa and a porosity; the rows of the curve are linear in the pressure.
Experiment pressed(const std::string &more = "") {
  const auto folder = test_folder();
  std::string curve = "stage,pressure_MPa,displacement_um\n";
  for (int k = 0; k <= 40; ++k)
    curve += fmt::format("compression,{},{}\n", 2.0 * k, 0.1 * k);
  for (int k = 39; k >= 0; --k)
    curve += fmt::format("relaxation,{},{}\n", 2.0 * k, 3.5 + 0.0125 * k);
  write_file((folder / "curve.csv").string(), curve);
  write_file((folder / "film.toml").string(),
             "name = \"film\"\nmaterial = \"nmc111\"\n[coating]\nloading_mg_cm2 = 6\n"
             "porosity_total_percent = 46\n[composition]\ncarbon_weight_percent = 2.2\n"
             "binder_weight_percent = 2.2\n");
  write_file((folder / "experiment.toml").string(),
             "[experiment]\nname = \"film\"\nelectrode = \"film.toml\"\n" + more +
                 "[[condition]]\nid = \"p080\"\ncontrol = \"pressure\"\n"
                 "max_pressure_MPa = { value = 80, sd_relative = 0.05 }\n"
                 "loading_mg_cm2 = { value = 6, sd = 0.06 }\n"
                 "porosity_after_percent = { value = 30, sd = 0.5 }\n"
                 "curve = \"curve.csv\"\ncurve_sd_um = 0.1\ncurve_zero_um = 0.4\n");
  return read_experiment((folder / "experiment.toml").string());
}

struct Pressed {
  MeasuredFilms films;
  std::vector<std::string> warnings;
  FilmProblem of;
  explicit Pressed(const ProblemOptions &options, const Experiment &experiment = pressed()) {
    add_readings(experiment, made_film_bank(), films, warnings);
    of = problem_of(made_film_bank(), films, options);
  }
  Vector mean(const Vector &amplitudes) const {
    const Matrix scores = Matrix::Zero(Eigen::Index(of.parameters.size()), 1);
    return of.problem.predict(0, scores, amplitudes).mean;
  }
  Vector off() const { return Vector::Constant(Eigen::Index(of.effects.size()), inference::kOff); }
  Eigen::Index place(const std::string &name) const {
    for (std::size_t k = 0; k < films.readings.size(); ++k)
      if (films.readings[k].observable.name.rfind(name, 0) == 0)
        return Eigen::Index(k);
    return -1;
  }
};

ProblemOptions with_faults() {
  ProblemOptions options;
  options.faults = true;
  return options;
}

// Four points of the loading, three of the release and a porosity; each as the emulated run has it.
TEST(FilmProblem, PredictsEveryReadingOfAFilm) {
  const Pressed p({});
  ASSERT_EQ(p.films.readings.size(), 8u);
  const FilmBank &bank = made_film_bank();
  const Material middle =
      material_of(p.of, Vector::Zero(Eigen::Index(p.of.parameters.size())), p.off());
  const Film &film = p.films.films[0];
  const SimulatedRun run =
      EmulatedRun(bank, film, 80.0)
          .of(bank.emulated(film, {&middle}, outputs_of_runs(bank)).mean.col(0));
  const Vector mean = p.mean(p.off());
  for (std::size_t k = 0; k < p.films.readings.size(); ++k)
    EXPECT_NEAR(mean[Eigen::Index(k)], p.films.readings[k].observable.simulated(run), 1e-9)
        << p.films.readings[k].observable.name;
  EXPECT_NEAR(mean[p.place("total porosity")], 100.0 * run.porosity_after, 1e-9);
}

// A porosity of 30 % +- 0.5; displacements over the solid column with 0.1 um each and 0.4 um together.
TEST(FilmProblem, HasTheErrorsThatAreStated) {
  const Pressed p({});
  const Matrix &m = p.of.problem.films[0].measurement;
  const auto porosity = p.place("total porosity"), first = p.place("displacement");
  EXPECT_NEAR(m(porosity, porosity), 0.25, 1e-12);
  const double solid = solid_thickness_um(pressed(), 6.0),
               measured = p.films.readings[std::size_t(first)].observable.measured;
  EXPECT_NEAR(m(first, first) * solid * solid, 0.01 + 0.16 + std::pow(measured * solid * 0.01, 2),
              1e-9);
  EXPECT_NEAR(m(first, first + 1) * solid * solid,
              0.16 + std::pow(solid * 0.01, 2) * measured *
                         p.films.readings[std::size_t(first) + 1].observable.measured,
              1e-9);
  EXPECT_EQ(m(porosity, first), 0.0);
}

// The pressure's error moves a reading as another pressure does: by 5 % of the slope in ln p.
TEST(FilmProblem, ThePressuresErrorIsASlope) {
  const Pressed p({});
  const Matrix scores = Matrix::Zero(Eigen::Index(p.of.parameters.size()), 1);
  const auto all = p.of.problem.predict(0, scores, p.off());
  ASSERT_EQ(all.errors.size(), 1u);
  const std::vector<double> q = {190.0, 2.4, 480.0, 46.0, 2.2};
  Vector middle(3);
  for (int k = 0; k < 3; ++k)
    middle[k] = p.of.parameters[std::size_t(k)].prior.value(0.0);
  const std::vector<double> at = {middle[0], middle[1], middle[2], 46.0, 2.2};
  const double slope =
      100.0 * (made_porosity(at, 0.0, 84.0) - made_porosity(at, 0.0, 76.0)) / std::log(84.0 / 76.0);
  EXPECT_NEAR(all.errors[0](p.place("total porosity"), 0), 0.05 * slope, 0.15 * 0.05 * -slope);
}

// The frame gives way by C p, also on release; a micrometre's zero shifts the porosity alone; a gauge that shows 10 %
// too much means a film that was pressed 10 % less.
TEST(FilmProblem, FaultsOfThePressShowAsTheyShould) {
  const Pressed p(with_faults());
  const Vector none = p.mean(p.off());
  const auto with = [&](const std::string &fault, double value) {
    Vector amplitudes = p.off();
    for (std::size_t e = 0; e < p.of.effects.size(); ++e)
      if (p.of.effects[e].name == fault)
        amplitudes[Eigen::Index(e)] =
            p.of.effects[e].prior.score(find_effect(fault).parameter.amplitude(value));
    return Vector(p.mean(amplitudes) - none);
  };
  const double solid = solid_thickness_um(pressed(), 6.0);
  const auto porosity = p.place("total porosity"), first = p.place("displacement");
  const Vector compliance = with("machine_compliance", 0.05);
  EXPECT_NEAR(compliance[porosity], 0.0, 1e-9);
  EXPECT_NEAR(compliance[first] * solid, 0.05 * 8.0, 1e-6); // at a tenth of 80 MPa
  const Vector zero = with("thickness_zero", 1.0);
  const double h = solid / (1.0 - 0.01 * none[porosity]);
  EXPECT_NEAR(zero[porosity], 100.0 * (1.0 - solid / (h + 1.0)) - none[porosity], 1e-6);
  EXPECT_NEAR(zero[first], 0.0, 1e-9);
  const Vector gauge = with("pressure_calibration", 1.1);
  std::vector<double> at;
  for (int k = 0; k < 3; ++k)
    at.push_back(p.of.parameters[std::size_t(k)].prior.value(0.0));
  at.insert(at.end(), {46.0, 2.2});
  EXPECT_NEAR(gauge[porosity],
              100.0 * (made_porosity(at, 0.0, 80.0 / 1.1) - made_porosity(at, 0.0, 80.0)),
              0.15 * gauge[porosity]);
}

// One point of porosity moves a reading of the same kind as far as the model's discrepancy is one point.
TEST(FilmProblem, TheDiscrepancyIsAPorosity) {
  const Pressed p({});
  const inference::FilmData &data = p.of.problem.films[0];
  const auto porosity = p.place("total porosity"), first = p.place("displacement");
  EXPECT_NEAR(std::sqrt(data.discrepancy(porosity, porosity)), 100.0, 1e-9);
  EXPECT_EQ(data.discrepancy(porosity, first), 0.0);
  const auto last = first + 3; // at 60 MPa: -(h / solid)^2
  const double ratio =
      made_film_bank().solid_column(p.films.films[0]) / solid_thickness_um(pressed(), 6.0);
  EXPECT_NEAR(ratio, 1.0, 1e-6);
  EXPECT_GT(std::sqrt(data.discrepancy(last, last)), 1.0);
  EXPECT_LT(std::sqrt(data.discrepancy(last, last)), 4.0);
  EXPECT_NEAR(data.discrepancy(first, last) /
                  std::sqrt(data.discrepancy(first, first) * data.discrepancy(last, last)),
              alike_at(8.0, 60.0), 1e-9);
}

TEST(FilmProblem, WhatTheModelHasActsWithNineTenths) {
  ProblemOptions options = with_faults();
  options.acting = {"nmc_plasticity"};
  const Pressed p(options);
  ASSERT_EQ(p.of.effects.size(), p.of.problem.effects.size());
  for (std::size_t e = 0; e < p.of.effects.size(); ++e) {
    const bool fault = e >= made_film_bank().effects().size();
    EXPECT_DOUBLE_EQ(p.of.problem.effects[e].probability,
                     p.of.effects[e].name == "nmc_plasticity" ? 0.9 : 0.1);
    EXPECT_EQ(p.of.problem.effects[e].of_film, fault) << p.of.effects[e].name;
  }
}

// A contact follows one law: as in the bank's design the later effect stays.
TEST(FilmProblem, AnEffectMayExcludeAnother) {
  Pressed p({});
  const Vector both = Vector::Zero(Eigen::Index(p.of.effects.size())),
               scores = Vector::Zero(Eigen::Index(p.of.parameters.size()));
  EXPECT_EQ(material_of(p.of, scores, both).effects.size(), 2u);
  p.of.excluded = {{}, {0}};
  const Material one = material_of(p.of, scores, both);
  ASSERT_EQ(one.effects.size(), 1u);
  EXPECT_EQ(one.effects[0].effect, 1);
}

// A whole sample shows a mean of packings; one cell shows one.
TEST(FilmProblem, PackingsScatterByTheSamplesSize) {
  const auto scatter = [](const std::string &diameter) {
    const Pressed p({}, pressed(diameter));
    const Matrix scores = Matrix::Zero(Eigen::Index(p.of.parameters.size()), 1);
    const Matrix s = p.of.problem.predict(0, scores, p.off()).scatter;
    return s.size() > 0 ? s(p.place("total porosity"), 0) : 0.0;
  };
  EXPECT_EQ(scatter(""), 0.0);
  const double wide = scatter("sample_diameter_mm = 11\n"),
               narrow = scatter("sample_diameter_mm = 1.1\n");
  EXPECT_NEAR(narrow / wide, 100.0, 1e-6);
}

} // namespace
