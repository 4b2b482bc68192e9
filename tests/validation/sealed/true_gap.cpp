// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/score.h"
#include "sealed/sealing.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {

namespace {

using inference::Matrix;
using inference::Vector;

/// Values of `data`, at the observables of `wanted`. A row of a curve that only `wanted` reaches
/// differs by as much as the row before it.
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

double common_length(const Matrix &differences) {
  const auto n = double(differences.cols());
  const double own = differences.squaredNorm();
  if (differences.cols() < 2)
    return std::sqrt(own);
  const double all = differences.rowwise().sum().squaredNorm();
  return std::sqrt(std::max(0.0, (all - own) / (n * (n - 1.0))));
}

TrueGap true_gap(const PairedExperiments &all, const std::vector<PairedExperiments> &samples,
                 const std::vector<double> &base, const BankTable &table, SharedModels &models) {
  const ExperimentData data = data_of(all.with, table, {});
  inference::ModelSettings settings;
  settings.packings_in_sample = cells_of(all.with, table.spec);
  settings.specimens = data.specimens;
  const auto model = models.of(data, settings);
  const inference::Problem problem = model->problem(data.experiment.values);
  const auto features = [&](const Experiment &e) {
    return model->problem(values_for(data, data_of(e, table, {}))).observed;
  };
  Vector scores(Eigen::Index(base.size()));
  for (Eigen::Index j = 0; j < scores.size(); ++j)
    scores[j] = data.bank.base[std::size_t(j)].prior.score(base[std::size_t(j)]);
  inference::Linearised about = inference::linearise(problem, scores);
  const inference::Cholesky factor(inference::recalibrated_covariance(about));
  const Vector difference = problem.observed - features(all.without);
  Matrix each(difference.size(), std::max<Eigen::Index>(1, Eigen::Index(samples.size())));
  each.col(0) = factor.matrixL().solve(difference);
  for (std::size_t k = 0; k < samples.size(); ++k)
    each.col(Eigen::Index(k)) =
        factor.matrixL().solve(features(samples[k].with) - features(samples[k].without));
  TrueGap out;
  out.signal_to_noise = common_length(each);
  about.mean = problem.observed - about.covariance * factor.solve(difference); // what is left
  for (const inference::WhereRow &row : inference::where(problem, about, {}).rows)
    if (const inference::Block &b = problem.blocks[std::size_t(row.block)]; row.significant)
      out.places.insert(fmt::format("{}|{}|{}", b.condition, b.stage, b.name));
  return out;
}

namespace {

PairedExperiments read_pair(const std::string &with, const std::string &without) {
  return {read_experiment(with + "/experiment.toml"),
          read_experiment(without + "/experiment.toml")};
}

} // namespace

void add_true_gaps(const std::string &folder, const std::string &answers, const std::string &bank,
                   const std::string &table, std::vector<ScoredCase> &cases) {
  const nlohmann::json made_with = json_of(answers + "/answers.json").at("provenance");
  must_be(sha256(bytes_of(bank)), made_with.value("bank_sha256", ""), bank);
  must_be(sha256(bytes_of(table)), made_with.value("bank_table_sha256", ""), table);
  const BankTable learnt = read_bank_table(read_bank_spec(bank), table);
  SharedModels models;
  std::map<std::string, TrueGap> gaps;
  for (ScoredCase &c : cases) {
    const std::string pair = folder + "/sealed/without_cause/" + c.id;
    if (!std::filesystem::exists(pair))
      continue;
    std::vector<double> base;
    for (const BankParameter &p : learnt.spec.parameters)
      base.push_back(c.parameters.at(p.name));
    std::vector<PairedExperiments> samples;
    for (const std::string &sample : samples_in(folder + "/sealed/samples/" + c.id))
      samples.push_back(read_pair(sample, sample + "_without"));
    if (!gaps.count(c.id))
      gaps[c.id] =
          true_gap(read_pair(folder + "/handed_out/" + c.id, pair), samples, base, learnt, models);
    c.paired = true;
    c.signal_to_noise = gaps[c.id].signal_to_noise;
    c.true_places = gaps[c.id].places;
  }
}

} // namespace calendem
