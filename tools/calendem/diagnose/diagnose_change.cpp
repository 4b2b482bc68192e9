// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "diagnose/diagnose.h"
#include "diagnose/inference/change.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {
namespace {

using inference::Matrix;
using inference::Vector;

/// Places in both of what both have, in the order of `after`.
struct Common {
  std::vector<int> before, after;
};

Common common_of(const ExperimentData &before, const ExperimentData &after) {
  Common out;
  for (int k = 0; k < int(after.experiment.of.size()); ++k)
    for (int j = 0; j < int(before.experiment.of.size()); ++j)
      if (key_of(before.experiment.of[std::size_t(j)]) ==
          key_of(after.experiment.of[std::size_t(k)])) {
        out.before.push_back(j);
        out.after.push_back(k);
      }
  if (out.after.empty())
    throw Failure(kBadInput, "nothing was measured both before and after the change: conditions of "
                             "the two files are matched by their ids and pressures.");
  return out;
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
