// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/how_far.h"
#include "diagnose/inference/evidence.h"
#include <algorithm>

namespace calendem {
using inference::Hypothesis;
using inference::Vector;
namespace {

/// What the emulators know of some conditions of the experiment.
struct Part {
  ExperimentData data;
  std::unique_ptr<inference::Model> model;
  inference::Problem problem;
};

Part part_of(const Experiment &e, const BankTable &table, const std::vector<std::string> &ids,
             double cells) {
  Part part;
  part.data = data_of(e, table, ids);
  inference::ModelSettings settings;
  settings.packings_in_sample = cells;
  part.model = std::make_unique<inference::Model>(part.data.bank, part.data.experiment, settings);
  part.problem = part.model->problem(part.data.experiment.values);
  return part;
}

std::vector<inference::Applied> applied(const inference::Problem &problem, const Hypothesis &h,
                                        const Vector &scores) {
  std::vector<inference::Applied> on;
  int at = problem.base_parameters;
  for (const int e : h.on) {
    const int n = int(problem.effects[std::size_t(e)].parameters.size());
    on.push_back({e, scores.segment(at, n)});
    at += n;
  }
  return on;
}

/// Held-out observables as the emulators predict them.
Vector predicted(const Part &part, const Hypothesis &h, const Vector &scores) {
  const inference::Prediction p = part.problem.predict(scores.head(part.problem.base_parameters),
                                                       applied(part.problem, h, scores));
  return part.model->map().observables_of(p.mean.head(part.model->map().emulated()));
}

/// Recalibrated on `train`, predicted for `test`.
RerunModel calibrated(const std::string &role, const Hypothesis &h, const Part &train,
                      const Part &test) {
  const inference::Likelihood likelihood(train.problem, h, train.problem.discrepancy);
  const inference::Evidence e = inference::evidence(likelihood, {});
  RerunModel out;
  out.role = role;
  out.hypothesis = h.name;
  for (int k = 0; k < train.problem.base_parameters; ++k)
    out.base.push_back(train.data.bank.base[std::size_t(k)].prior.value(e.mode[k]));
  for (const inference::Applied &a : applied(train.problem, h, e.mode)) {
    const inference::ModelledEffect &effect = train.problem.effects[std::size_t(a.effect)];
    out.effect[effect.name] =
        find_effect(effect.name)
            .parameter.value(effect.parameters.front().prior.value(a.scores[0]));
  }
  const HeldOut held_out = held_out_of(test.data);
  const Vector none = Vector::Zero(held_out.sd.size());
  std::vector<double> gaps;
  for (Eigen::Index k = 0; k < e.draws.cols(); ++k)
    gaps.push_back(gap_of(held_out, predicted(test, h, e.draws.col(k)), none));
  out.predicted = interval_of(gap_of(held_out, predicted(test, h, e.mode), none), gaps);
  return out;
}

/// Roles and hypotheses, the base model first.
std::vector<std::pair<std::string, Hypothesis>> chosen(const inference::Which &which) {
  std::vector<std::pair<std::string, Hypothesis>> out = {{"before", which.of("none").hypothesis}};
  if (which.claim == "none")
    return out;
  std::vector<Hypothesis> effects;
  for (const inference::Judged &j : which.judged)
    if (j.hypothesis.kind == Hypothesis::effects)
      effects.push_back(j.hypothesis);
  if (effects.empty())
    return out;
  const Hypothesis &first = effects.front();
  const bool claimed = which.claim == first.name;
  out.emplace_back("after", first);
  const auto apart = [&](const Hypothesis &h) {
    return h.on.size() == 1 &&
           std::find(first.on.begin(), first.on.end(), h.on[0]) == first.on.end();
  };
  const auto second = std::find_if(effects.begin() + 1, effects.end(), apart);
  if (second == effects.end())
    return out;
  out.emplace_back("runner-up", *second);
  const auto least = std::find_if(effects.rbegin(), effects.rend(), apart);
  if (claimed && least->name != second->name)
    out.emplace_back("placebo", *least);
  return out;
}

} // namespace

std::vector<RerunModel> models_to_rerun(const Experiment &experiment, const BankTable &table,
                                        const Diagnosed &diagnosed, double cells) {
  std::vector<RerunModel> out;
  if (experiment.train.empty() || experiment.test.empty())
    return out;
  cells = cells > 0.0 ? cells : cells_of(experiment, table.spec);
  const Part train = part_of(experiment, table, experiment.train, cells),
             test = part_of(experiment, table, experiment.test, cells);
  for (const auto &[role, hypothesis] : chosen(diagnosed.diagnosis.which))
    out.push_back(calibrated(role, hypothesis, train, test));
  return out;
}

} // namespace calendem
