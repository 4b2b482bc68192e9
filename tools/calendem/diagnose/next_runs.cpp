// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/next_runs.h"
#include "base/case.h"
#include "diagnose/sample_film.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

using inference::Hypothesis;
namespace {

constexpr double kWorthTelling = 0.05;
constexpr std::size_t kMostModels = 4;
constexpr double kDwellUs = 3.0;      // us: of the simulation, three of cbd_viscoelasticity's times
constexpr double kMorePressure = 2.0; // times the largest so far
constexpr double kMoreLoading = 1.5;  // times the bank's
constexpr double kSlower = 0.5;       // times the case's speeds

const char *const kPressure = "case.platen.max_pressure_MPa";
const char *const kLoading = "recipe.coating.loading_mg_cm2";
const char *const kSpeeds[] = {"platen.speed_m_s", "platen.touch_speed_m_s",
                               "platen.release_speed_m_s"};

double pressure_left(const std::string &folder, const std::string &) {
  return 100.0 * read_simulated_run(folder).pressure_left;
}

double porosity_after(const std::string &folder, const std::string &) {
  return 100.0 * read_simulated_run(folder).porosity_after;
}

double porosity_beside(const std::string &folder, const std::string &usual) {
  return porosity_after(folder, "") - porosity_after(usual, "");
}

double cracked(const std::string &folder, const std::string &) {
  return 100.0 * read_simulated_run(folder).cracked_fraction;
}

double hours_of(const BankSpec &bank, const std::string &name) {
  for (const MeasurementPrice &price : bank.prices)
    if (price.name == name)
      return price.hours;
  return std::nan("");
}

std::string in_six_digits(double value) { return fmt::format("{:.6g}", value); }

SimulatedReading reading_of(const std::vector<double> &values) {
  SimulatedReading out;
  double squares = 0.0;
  const auto n = double(values.size());
  for (const double v : values) {
    out.mean += v / n;
    squares += v * v / n;
  }
  out.error =
      n > 1.0 ? std::sqrt(std::max(0.0, squares - out.mean * out.mean) / (n - 1.0)) : std::nan("");
  return out;
}

nlohmann::ordered_json parted(const std::vector<RerunModel> &models,
                              const std::vector<SimulatedReading> &readings, double sd) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (std::size_t a = 0; a < models.size(); ++a)
    for (std::size_t b = a + 1; b < models.size(); ++b)
      out.push_back({{"first", models[a].hypothesis},
                     {"second", models[b].hypothesis},
                     {"apart", apart(readings[a], readings[b], sd)}});
  return out;
}

double largest_pressure(const Experiment &e) {
  double out = 0.0;
  for (const Condition &c : e.conditions)
    if (c.max_pressure_MPa)
      out = std::max(out, c.max_pressure_MPa->value);
  return out;
}

} // namespace

std::vector<NextRun> next_runs(const BankSpec &bank, double pressure) {
  const double loading = read_recipe(bank.recipe_file).loading;
  const Settings usual = read_case(bank.case_file);
  std::map<std::string, double> slower;
  for (const char *key : kSpeeds)
    slower[std::string("case.") + key] = kSlower * usual.number(key);
  return {{"cracked_bodies",
           fmt::format("a cross-section after {:g} MPa", pressure),
           "cracked particles",
           "%",
           5.0,
           {},
           cracked},
          {"dwell",
           fmt::format("{:g} µs at constant gap after {:g} MPa", kDwellUs, pressure),
           "pressure left",
           "%",
           1.0,
           {{"case.platen.dwell_us", kDwellUs}},
           pressure_left},
          {"second_speed", fmt::format("{:g} MPa at half the speed", pressure),
           "porosity after, less that at full speed", "%", 0.7, slower, porosity_beside},
          {"thickness_series",
           fmt::format("{:g} MPa on {:g} instead of {:g} mg/cm²", pressure, kMoreLoading * loading,
                       loading),
           "porosity after, less that of the usual film",
           "%",
           0.7,
           {{kLoading, kMoreLoading * loading}},
           porosity_beside},
          {"higher_pressure",
           fmt::format("{:g} instead of {:g} MPa", kMorePressure * pressure, pressure),
           "porosity after",
           "%",
           0.5,
           {{kPressure, kMorePressure * pressure}},
           porosity_after}};
}

Study next_study(const BankSpec &spec, const std::vector<RerunModel> &models,
                 const std::vector<NextRun> &next, double pressure, int packings, double film) {
  Study study;
  study.file = spec.file;
  study.name = "what to measure next";
  study.recipe_file = spec.recipe_file;
  study.case_file = spec.case_file;
  study.keep_all = false;
  study.columns = model_columns(spec);
  const Settings usual = read_case(spec.case_file);
  std::map<std::string, double> further = {{kPressure, pressure}, {"case.platen.dwell_us", 0.0}};
  for (const char *key : kSpeeds)
    further[std::string("case.") + key] = usual.number(key);
  const bool varied = std::find(study.columns.begin(), study.columns.end(), kLoading) !=
                      study.columns.end(); // by the bank
  if (!varied)
    further[kLoading] = read_recipe(spec.recipe_file).loading;
  for (const auto &[key, value] : further)
    study.columns.push_back(key);
  std::vector<std::vector<std::string>> rows;
  for (const RerunModel &m : models)
    for (int k = 1; k <= packings; ++k)
      for (const NextRun &n : next) {
        if (&n != &next.front() && n.changed.empty())
          continue;
        std::vector<std::string> row = model_values(spec, m, k, film);
        for (const auto &[key, value] : further)
          row.push_back(in_six_digits(n.changed.count(key) > 0 ? n.changed.at(key) : value));
        if (const auto loading = n.changed.find(kLoading); varied && loading != n.changed.end())
          row[std::size_t(std::find(study.columns.begin(), study.columns.end(), kLoading) -
                          study.columns.begin())] = in_six_digits(loading->second);
        rows.push_back(row);
      }
  Mistakes mistakes(spec.file, 20);
  add_runs(study, rows, mistakes);
  mistakes.stop_if_any();
  return study;
}

std::vector<RerunModel> models_to_part(const Diagnosed &d) {
  const inference::Problem problem = d.model->problem(d.data.experiment.values);
  const std::vector<inference::Judged> &judged = d.diagnosis.which.judged;
  std::vector<RerunModel> out;
  const auto add = [&](const inference::Judged &j, const std::string &role) {
    const bool there = std::any_of(out.begin(), out.end(), [&](const RerunModel &m) {
      return m.hypothesis == j.hypothesis.name;
    });
    if (!there)
      out.push_back(model_at(role, j.hypothesis, j.evidence.mode, problem, d.data));
  };
  for (const inference::Judged &j : judged)
    if ((j.hypothesis.kind == Hypothesis::none || j.hypothesis.kind == Hypothesis::effects) &&
        j.probability >= kWorthTelling && out.size() < kMostModels)
      add(j, fmt::format("{:.0f} %", 100.0 * j.probability));
  for (const inference::Judged &j : judged)
    if (!out.empty() && j.hypothesis.name == out.front().hypothesis)
      for (const inference::ShortRuns &rival : j.short_runs)
        for (const inference::Judged &other : judged)
          if (other.hypothesis.name == rival.rival)
            add(other, "as far as the bank has run it");
  return out;
}

double apart(const SimulatedReading &a, const SimulatedReading &b, double sd) {
  return std::fabs(a.mean - b.mean) / std::sqrt(sd * sd + a.error * a.error + b.error * b.error);
}

nlohmann::ordered_json simulate_next(const Experiment &experiment, const BankTable &table,
                                     const std::vector<RerunModel> &models,
                                     const RerunOptions &options) {
  const double pressure = largest_pressure(experiment);
  const std::vector<NextRun> next = next_runs(table.spec, pressure);
  const Study study = next_study(table.spec, models, next, pressure, options.packings,
                                 film_ratio(experiment, table));
  const std::vector<std::string> folders = make_what_runs(study, options.study, "Readings");
  const std::size_t each = folders.size() / models.size() / std::size_t(options.packings);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::size_t own = 0; // runs of their own so far
  for (const NextRun &n : next) {
    own += n.changed.empty() ? 0 : 1;
    std::vector<SimulatedReading> readings;
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    for (std::size_t m = 0; m < models.size(); ++m) {
      std::vector<double> of_packings;
      for (std::size_t k = 0; k < std::size_t(options.packings); ++k) {
        const std::size_t first = (m * std::size_t(options.packings) + k) * each;
        const std::string &folder = folders[first + (n.changed.empty() ? 0 : own)],
                          &usual = folders[first];
        const double value = folder.empty() || usual.empty() ? std::nan("") : n.read(folder, usual);
        if (std::isfinite(value))
          of_packings.push_back(value);
      }
      readings.push_back(reading_of(of_packings));
      values.push_back({{"hypothesis", models[m].hypothesis},
                        {"packings", of_packings.size()},
                        {"mean", readings.back().mean},
                        {"error", readings.back().error}});
    }
    rows.push_back({{"name", n.name},
                    {"what", n.what},
                    {"reading", n.reading},
                    {"unit", n.unit},
                    {"sd", n.sd},
                    {"cost", hours_of(table.spec, n.name)},
                    {"values", values},
                    {"parted", parted(models, readings, n.sd)}});
  }
  nlohmann::ordered_json of = nlohmann::ordered_json::array();
  for (const RerunModel &m : models)
    of.push_back({{"hypothesis", m.hypothesis}, {"probability", m.role}});
  return {{"packings", options.packings}, {"models", of}, {"measurements", rows}};
}

} // namespace calendem
