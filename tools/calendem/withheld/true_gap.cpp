// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/true_gap.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

using inference::Matrix;
using inference::Vector;

/// Of `data`, at the observables of `wanted`. A row of a curve that only `wanted` reaches differs by as
/// much as the row before it.
Vector values_for(const ExperimentData &wanted, const ExperimentData &data) {
  Vector out(wanted.experiment.values.size());
  double difference = 0.0; // of the row before
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    const auto &all = data.experiment.of;
    const auto at = std::find_if(all.begin(), all.end(), [&](const auto &o) {
      return inference::key_of(o) == inference::key_of(wanted.experiment.of[std::size_t(k)]);
    });
    if (at != all.end())
      difference = data.experiment.values[at - all.begin()] - wanted.experiment.values[k];
    out[k] = wanted.experiment.values[k] + difference;
  }
  return out;
}

} // namespace

TrueGap true_gap(const Experiment &handed_out, const Experiment &without_cause,
                 const std::vector<double> &base, const BankTable &table, SharedModels &models) {
  const ExperimentData data = data_of(handed_out, table, {});
  const Vector without = values_for(data, data_of(without_cause, table, {}));
  inference::ModelSettings settings;
  settings.packings_in_sample = cells_of(handed_out, table.spec);
  settings.specimens = data.specimens;
  const auto model = models.of(data, settings);
  const inference::Problem problem = model->problem(data.experiment.values);
  Vector scores(Eigen::Index(base.size()));
  for (Eigen::Index j = 0; j < scores.size(); ++j)
    scores[j] = data.bank.base[std::size_t(j)].prior.score(base[std::size_t(j)]);
  inference::Linearised about = inference::linearise(problem, scores);
  const Vector difference = problem.observed - model->problem(without).observed;
  const Vector weighted =
      inference::Cholesky(inference::recalibrated_covariance(about)).solve(difference);
  TrueGap out;
  out.signal_to_noise = std::sqrt(difference.dot(weighted));
  about.mean = problem.observed - about.covariance * weighted; // what recalibration leaves
  for (const inference::WhereRow &row : inference::where(problem, about, {}).rows)
    if (const inference::Block &b = problem.blocks[std::size_t(row.block)]; row.significant)
      out.places.insert(fmt::format("{}|{}|{}", b.condition, b.stage, b.name));
  return out;
}

} // namespace calendem
