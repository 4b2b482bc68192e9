// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/diagnose.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "diagnose/bank_points.h"
#include "diagnose/inference/diagnosis.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {

namespace {

constexpr double kBeyondChance = 4.0; // normal score

template <typename Derived> void append(const Eigen::MatrixBase<Derived> &values, std::string &to) {
  const typename Derived::PlainObject plain = values;
  to.append(reinterpret_cast<const char *>(plain.data()), sizeof(double) * plain.size());
}

/// Bytes that are equal where a model would be.
std::string layout_of(const ExperimentData &data, const inference::ModelSettings &settings) {
  std::string out;
  for (const inference::ObservableId &o : data.experiment.of)
    out += key_of(o) + "\n";
  append(data.experiment.covariance, out);
  for (const inference::ModelledEffect &e : data.bank.effects)
    out += e.name + "\n";
  for (const inference::BankRun &run : data.bank.runs)
    append(run.values, out);
  append(inference::Vector::Constant(1, settings.packings_in_sample), out);
  for (const auto &[condition, specimen] : settings.specimens)
    out += fmt::format("{}={}x{}\n", condition, specimen.name, specimen.count);
  return out;
}

/// In the report, and as a remark where it is beyond chance.
void report_point_noise(const std::vector<inference::PointNoise> &noise, Diagnosed &out) {
  out.gap["point_noise"] = nlohmann::ordered_json::array();
  for (const inference::PointNoise &p : noise) {
    const double times = p.times_stated();
    out.gap["point_noise"].push_back({{"condition", p.condition},
                                      {"directions", p.measured.size()},
                                      {"score", p.score},
                                      {"times_stated", times}});
    if (std::fabs(p.score) > kBeyondChance)
      out.data.not_said.push_back(fmt::format(
          "{}: the points of its release scatter {:.2g} times as much as curve_sd_um says "
          "(normal score {:.1f}): state what they do.",
          p.condition, times, p.score));
  }
}

/// Standard deviation of each observable by each of its errors; emulators' errors are those of the
/// base model where it fits best.
nlohmann::ordered_json budget_of(const Diagnosed &d) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const auto &of = d.data.experiment.of;
  inference::Vector readings = d.data.experiment.covariance.diagonal();
  for (const ErrorTerm &t : d.data.terms)
    readings -= t.columns.rowwise().squaredNorm();
  const inference::Problem problem = d.model->problem(d.data.experiment.values);
  const auto emulated = d.model->map().emulated();
  const inference::Vector errors =
      problem.predict(d.diagnosis.which.base.at, {}).variance.head(emulated);
  const inference::Vector by_emulators = d.model->map().variances_of(errors.asDiagonal()),
                          by_packings = d.model->map().variances_of(
                              problem.scatter.topLeftCorner(emulated, emulated));
  const auto sd = [](double variance) { return std::sqrt(std::max(0.0, variance)); };
  for (std::size_t k = 0; k < of.size(); ++k) {
    const auto i = Eigen::Index(k);
    nlohmann::ordered_json terms = {{"reading", sd(readings[i])}};
    for (const ErrorTerm &t : d.data.terms)
      if (const double size = t.columns.row(i).norm(); size > 0.0)
        terms[t.name] = size;
    terms["packings"] = sd(by_packings[i]);
    terms["emulators"] = sd(by_emulators[i]);
    rows.push_back({{"condition", of[k].condition},
                    {"observable", of[k].name},
                    {"name", d.data.labels[k].name},
                    {"unit", d.data.labels[k].unit},
                    {"terms", terms}});
  }
  return rows;
}

} // namespace

BankTable without_effects(BankTable table, const std::vector<std::string> &names) {
  const auto excluded = [&](const std::string &effect) {
    return std::find(names.begin(), names.end(), effect) != names.end();
  };
  for (const std::string &name : names)
    find_effect(name);
  std::vector<std::string> &effects = table.spec.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(), excluded), effects.end());
  const auto of_excluded = [&](const BankRow &row) { return excluded(row.point.effect); };
  table.rows.erase(std::remove_if(table.rows.begin(), table.rows.end(), of_excluded),
                   table.rows.end());
  return table;
}

std::string other_than_bank(const Experiment &e, const BankSpec &bank) {
  const std::string &recipe =
      bank.full_cell.other_electrode ? bank.full_cell.recipe_file : bank.recipe_file;
  const auto differs = other_electrode(read_recipe(recipe).settings.all(), e.recipe.settings.all());
  return differs.empty()
             ? ""
             : fmt::format("the sample is not the bank's electrode; {}", fmt::join(differs, "; "));
}

double cells_of(const Experiment &e, const BankSpec &spec) {
  if (!(e.sample_diameter_mm > 0.0))
    throw Failure(kBadInput, "how large is the sample? Give sample_diameter_mm in the experiment "
                             "file, or --cells, how many of the bank's cells it is as large as.");
  return 1e8 * sample_area_cm2(e) / read_recipe(spec.recipe_file).area(); // um2 per cm2
}

std::shared_ptr<const inference::Model> SharedModels::of(const ExperimentData &data,
                                                         const inference::ModelSettings &settings) {
  const std::lock_guard<std::mutex> lock(guard_);
  std::shared_ptr<const inference::Model> &model = models_[layout_of(data, settings)];
  if (!model)
    model = std::make_shared<inference::Model>(data.bank, data.experiment, settings, data.next);
  return model;
}

Diagnosed diagnosed(const Experiment &experiment, const BankTable &table, double cells,
                    SharedModels &models) {
  Diagnosed out;
  out.data = data_of(experiment, table, {});
  inference::DiagnosisSettings settings;
  settings.model.packings_in_sample = cells > 0.0 ? cells : cells_of(experiment, table.spec);
  settings.model.specimens = out.data.specimens;
  out.model = models.of(out.data, settings.model);
  const std::vector<inference::PointNoise> point_noise =
      point_noise_of(experiment, table, settings.model.packings_in_sample, out.data.not_said);
  out.diagnosis = inference::diagnose(*out.model, out.data.bank, out.data.experiment.values,
                                      settings, point_noise);
  out.gap = inference::to_json(out.diagnosis, experiment.name);
  put_in_words(out.data, table, out.gap);
  report_point_noise(point_noise, out);
  out.gap["budget"] = budget_of(out);
  out.gap["not_said"] = out.data.not_said;
  return out;
}

namespace {

using inference::Matrix;
using inference::Vector;

/// Places in both of what both have, in the order of `after`.
struct Common {
  std::vector<int> before, after;
};

Common common_of(const ExperimentData &before, const ExperimentData &after) {
  constexpr double kSame = 0.02; // of the pressure
  Common out;
  std::map<std::string, std::pair<double, double>> others; // pressures, by condition
  for (int k = 0; k < int(after.experiment.of.size()); ++k)
    for (int j = 0; j < int(before.experiment.of.size()); ++j) {
      const inference::ObservableId &id = after.experiment.of[std::size_t(k)];
      if (key_of(before.experiment.of[std::size_t(j)]) != key_of(id))
        continue;
      const double then = before.labels[std::size_t(j)].pressure,
                   now = after.labels[std::size_t(k)].pressure;
      if (std::fabs(now - then) > kSame * then) {
        others[id.condition] = {then, now};
        continue;
      }
      out.before.push_back(j);
      out.after.push_back(k);
    }
  if (!others.empty()) {
    const auto &[condition, pressures] = *others.begin();
    throw Failure(kBadInput,
                  fmt::format("condition \"{}\" is at {:g} MPa before and {:g} MPa after "
                              "the change. A change is seen at equal pressures: give "
                              "conditions of other pressures other ids.",
                              condition, pressures.first, pressures.second));
  }
  if (out.after.empty())
    throw Failure(kBadInput, "nothing was measured both before and after the change: conditions of "
                             "the two files are matched by their ids and pressures.");
  return out;
}

void check_pressings(const Experiment &before, const Experiment &after) {
  for (const Condition &then : before.conditions)
    for (const Condition &now : after.conditions)
      if (now.id == then.id && now.pressing != then.pressing)
        throw Failure(kBadInput,
                      fmt::format("condition \"{}\" has pressing = \"{}\" before and \"{}\" after "
                                  "the change. A change is seen on films that are pressed alike: "
                                  "give others other ids.",
                                  now.id, then.pressing, now.pressing));
}

/// Errors that a change of the sample does not cancel.
Matrix own_errors(const ExperimentData &data, const std::vector<int> &places) {
  Matrix out = data.experiment.covariance;
  for (const ErrorTerm &t : data.terms)
    if (t.name.rfind("numerics: ", 0) == 0 || t.name == kPressureOfThePress)
      out -= t.columns * t.columns.transpose();
  return out(places, places);
}

/// `after` with only what both have: readings as they would be, had the base model been right
/// before.
void make_difference(const ExperimentData &before, const Vector &predicted, const Common &both,
                     ExperimentData &after) {
  inference::ObservableVector &e = after.experiment;
  inference::ObservableVector out;
  std::vector<ValueLabel> labels;
  for (const int k : both.after) {
    out.of.push_back(e.of[std::size_t(k)]);
    labels.push_back(after.labels[std::size_t(k)]);
  }
  out.values = Vector(predicted(both.before)) + Vector(e.values(both.after)) -
               Vector(before.experiment.values(both.before));
  out.covariance = own_errors(after, both.after) + own_errors(before, both.before);
  for (ErrorTerm &t : after.terms)
    t.columns = Matrix(t.columns(both.after, Eigen::all));
  after.next.clear();
  after.labels = labels;
  e = out;
}

} // namespace

Diagnosed diagnosed_change(const Experiment &before, const Experiment &after,
                           const BankTable &table, double cells) {
  Diagnosed out;
  out.data = data_of(after, table, {});
  const ExperimentData first = data_of(before, table, {});
  inference::DiagnosisSettings settings;
  settings.model.packings_in_sample = cells > 0.0 ? cells : cells_of(after, table.spec);
  settings.model.specimens = first.specimens;
  const inference::Model of_first(first.bank, first.experiment, settings.model);
  Vector predicted;
  const inference::KnownBase base =
      inference::recalibrated(of_first, first.experiment.values, predicted);
  check_pressings(before, after);
  const Common both = common_of(first, out.data);
  make_difference(first, predicted, both, out.data);
  settings.model.specimens = out.data.specimens;
  out.model =
      std::make_shared<inference::Model>(out.data.bank, out.data.experiment, settings.model);
  const Vector &values = out.data.experiment.values;
  const inference::Problem problem =
      change_of(*out.model, values, Vector(predicted(both.before)), base);
  out.diagnosis = inference::diagnose(*out.model, problem, out.data.bank, values, settings);
  out.data.not_said.push_back("A change of a base parameter itself (a softer binder, weaker "
                              "particles) is no effect of the table: it counts as something else.");
  out.gap = inference::to_json(out.diagnosis, after.name);
  out.gap["change_from"] = before.name;
  out.gap["point_noise"] = out.gap["budget"] = nlohmann::ordered_json::array();
  put_in_words(out.data, table, out.gap);
  out.gap["not_said"] = out.data.not_said;
  return out;
}

} // namespace calendem
