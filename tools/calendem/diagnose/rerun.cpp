// SPDX-License-Identifier: GPL-2.0-or-later
// The chosen models run again, and how far they are from what was held out.
#include "diagnose/rerun.h"
#include "compare/observables.h"
#include "diagnose/inference/evidence.h"
#include "diagnose/sample_film.h"
#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace calendem {

using inference::Matrix;
namespace {

std::string in_four_digits(double value) { return fmt::format("{:.4g}", value); }

/// The models as runs: for each, the packings; for each packing, the held-out pressings.
Study study_of(const BankTable &table, const std::vector<RerunModel> &models,
               const std::vector<PressedTo> &pressings, int packings, double film) {
  const BankSpec &spec = table.spec;
  Study study;
  study.file = spec.file;
  study.name = "how far";
  study.recipe_file = spec.recipe_file;
  study.case_file = spec.case_file;
  study.columns = model_columns(spec);
  std::vector<Pressing> ways;
  for (const PressedTo &to : pressings) {
    const BankPressing *how = find_pressing(spec, to.pressing);
    ways.push_back(to_pressure(to.pressure, how ? how->settings : Pressing()));
  }
  const PressingColumns pressed = columns_of(ways, spec);
  study.columns.insert(study.columns.end(), pressed.names.begin(), pressed.names.end());
  std::vector<std::vector<std::string>> rows;
  for (const RerunModel &m : models)
    for (int k = 1; k <= packings; ++k)
      for (const std::vector<std::string> &way : pressed.rows) {
        rows.push_back(model_values(spec, m, k, film));
        rows.back().insert(rows.back().end(), way.begin(), way.end());
      }
  Mistakes mistakes(spec.file, 20);
  add_runs(study, rows, mistakes);
  mistakes.stop_if_any();
  return study;
}

/// The runs as rows of a bank's table: each model is a base point, so that the same code finds the
/// observables.
BankTable table_of(const BankTable &bank, const std::vector<RerunModel> &models, int packings,
                   const std::vector<std::string> &folders,
                   const std::vector<PressedTo> &pressings) {
  BankTable out;
  out.spec = bank.spec;
  out.spec.effects.clear();
  for (std::size_t k = 0; k < folders.size(); ++k) {
    BankRow row;
    row.point.base_point = int(k / pressings.size());
    row.point.packing = row.point.base_point + 1;
    row.point.base = models[k / pressings.size() / std::size_t(packings)].base;
    row.run = read_simulated_run(folders[k]);
    row.run.pressing = pressings[k % pressings.size()].pressing;
    out.rows.push_back(row);
  }
  return out;
}

nlohmann::ordered_json json_of(const Estimate &e) {
  return {{"value", e.value}, {"low90", e.low90}, {"high90", e.high90}};
}

/// How the held-out conditions are pressed, as far as the bank can.
std::vector<PressedTo> pressings_of(const Experiment &e, const BankSpec &spec) {
  std::set<std::pair<std::string, double>> all;
  for (const Condition &c : e.conditions)
    if (std::find(e.test.begin(), e.test.end(), c.id) != e.test.end() && c.max_pressure_MPa &&
        (c.pressing.empty() || find_pressing(spec, c.pressing)))
      all.emplace(c.pressing, c.max_pressure_MPa->value);
  std::vector<PressedTo> out;
  for (const auto &[pressing, pressure] : all)
    out.push_back({pressure, pressing});
  return out;
}

/// What was measured and what the models gave, observable by observable.
nlohmann::ordered_json observables(const HeldOut &h, const std::vector<inference::ObservableId> &of,
                                   const std::vector<RerunModel> &models,
                                   const std::vector<Matrix> &simulated) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < h.measured.size(); ++i) {
    const inference::ObservableId &o = of[std::size_t(i)];
    nlohmann::ordered_json row = {{"condition", o.condition},  {"name", o.name},
                                  {"stage", o.stage},          {"coordinate", o.coordinate},
                                  {"measured", h.measured[i]}, {"sd", h.sd[i]}};
    for (std::size_t m = 0; m < models.size(); ++m)
      row[models[m].role] = simulated[m].row(i).mean();
    out.push_back(row);
  }
  return out;
}

nlohmann::ordered_json models_json(const BankSpec &spec, const HeldOut &h,
                                   const std::vector<RerunModel> &models,
                                   const std::vector<Matrix> &simulated) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (std::size_t m = 0; m < models.size(); ++m) {
    nlohmann::ordered_json parameters;
    for (std::size_t p = 0; p < spec.parameters.size(); ++p)
      parameters[spec.parameters[p].name] = models[m].base[p];
    for (const auto &[effect, value] : models[m].effect)
      parameters[find_effect(effect).parameter.keys.front()] = value;
    out.push_back({{"role", models[m].role},
                   {"hypothesis", models[m].hypothesis},
                   {"parameters", parameters},
                   {"gap", json_of(gap_of_packings(h, simulated[m]))},
                   {"predicted_gap", json_of(models[m].predicted)}});
    if (m > 0)
      out.back()["shrinkage"] = json_of(shrinkage_of(h, simulated[0], simulated[m]));
  }
  return out;
}

/// The answer in a few numbers, from the models as reported.
nlohmann::ordered_json in_short(const nlohmann::ordered_json &models, double floor) {
  const nlohmann::ordered_json &before = models[0];
  nlohmann::ordered_json out = {{"before", before["gap"]["value"]}, {"noise_floor", floor}};
  for (const auto &m : models) {
    const std::string role = m["role"];
    if (role == "runner-up")
      out["runner_up"] = {{"hypothesis", m["hypothesis"]},
                          {"after", m["gap"]["value"]},
                          {"fraction", m["shrinkage"]["value"]}};
    else if (role == "placebo")
      out["placebo"] = m["shrinkage"]["value"];
    else if (role == "after") {
      const nlohmann::ordered_json &share = m["shrinkage"];
      out["after"] = out["unexplained"] = m["gap"]["value"];
      out["fraction"] = share["value"];
      out["interval90"] = {share["low90"], share["high90"]};
      out["shrinkage"] = share;
      out["shrinkage"]["predicted"] = 1.0 - m["predicted_gap"]["value"].get<double>() /
                                                before["predicted_gap"]["value"].get<double>();
    }
  }
  return out;
}

std::vector<ModelRuns> by_model(const BankTable &runs, const std::vector<RerunModel> &models,
                                int packings) {
  std::vector<ModelRuns> out;
  for (const RerunModel &m : models)
    out.push_back({m.role, {}});
  for (const BankRow &row : runs.rows)
    out[std::size_t(row.point.base_point / packings)].runs.push_back(row.run);
  return out;
}

nlohmann::ordered_json curves(const Experiment &e, const BankTable &runs,
                              const std::vector<RerunModel> &models, int packings) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Condition &c : e.conditions) {
    if (std::find(e.test.begin(), e.test.end(), c.id) == e.test.end())
      continue;
    for (const BankRow &row : runs.rows)
      if (row.point.base_point % packings == 0 && pressed_as(row.run, c))
        out.push_back({{"condition", c.id},
                       {"role", models[std::size_t(row.point.base_point / packings)].role},
                       {"displacement_um", row.run.displacement},
                       {"pressure_MPa", row.run.pressure}});
  }
  return out;
}

} // namespace

std::vector<std::string> model_columns(const BankSpec &spec) {
  std::vector<std::string> out = {"recipe.seed"};
  for (const BankParameter &p : spec.parameters)
    out.insert(out.end(), p.keys.begin(), p.keys.end());
  for (const std::string &name : spec.effects)
    for (const std::string &key : find_effect(name).parameter.keys)
      out.push_back(find_effect(name).column(key));
  return out;
}

std::vector<std::string> model_values(const BankSpec &spec, const RerunModel &m, int packing,
                                      double film) {
  std::vector<std::string> out = {fmt::format("{}", 100000 + packing)};
  for (std::size_t p = 0; p < spec.parameters.size(); ++p)
    out.insert(out.end(), spec.parameters[p].keys.size(), in_four_digits(m.base[p]));
  for (const std::string &name : spec.effects) {
    const EffectParameter &p = find_effect(name).parameter;
    const double on_film = find_effect(name).instrument ? film : 1.0;
    const auto on = m.effect.find(name);
    out.insert(out.end(), p.keys.size(),
               on == m.effect.end() ? p.off : in_four_digits(on_film * on->second));
  }
  return out;
}

HeldOut held_out_of(const ExperimentData &data) {
  return {inference::blocks_of(data.experiment.of), data.experiment.values,
          data.experiment.covariance.diagonal().cwiseSqrt()};
}

nlohmann::ordered_json rerun(const Experiment &experiment, const BankTable &table,
                             const std::vector<RerunModel> &models, const RerunOptions &options) {
  const std::vector<PressedTo> pressings = pressings_of(experiment, table.spec);
  Study study = study_of(table, models, pressings, options.packings, film_ratio(experiment, table));
  study.keep_all =
      std::any_of(experiment.conditions.begin(), experiment.conditions.end(),
                  [&](const Condition &c) { return has_images_beside(experiment, c); });
  const BankTable runs =
      table_of(table, models, options.packings, make_study(study, options.study), pressings);
  const ExperimentData data = data_of(experiment, runs, experiment.test, table);
  HeldOut held_out = held_out_of(data);
  std::vector<Matrix> simulated(models.size(), Matrix(held_out.measured.size(), options.packings));
  for (std::size_t k = 0; k < data.bank.runs.size(); ++k)
    simulated[k / std::size_t(options.packings)].col(Eigen::Index(k) % options.packings) =
        data.bank.runs[k].values.head(held_out.measured.size());
  add_sample_scatter(simulated, options.cells, held_out);
  nlohmann::ordered_json out = {{"train", experiment.train}, {"held_out", experiment.test}};
  const auto reported = models_json(table.spec, held_out, models, simulated);
  out.update(in_short(reported, noise_floor(held_out, simulated[0])));
  out["in_words"] = shrinkage_in_words(out);
  out.update(
      {{"unit", "standard deviations of measurement and sample"},
       {"packings", options.packings},
       {"models", reported},
       {"observables", observables(held_out, data.experiment.of, models, simulated)},
       {"curves", curves(experiment, runs, models, options.packings)},
       {"said", "The effect was chosen on all conditions, its amplitude and the base parameters "
                "on the training conditions only."}});
  if (study.keep_all)
    out["images"] = images_beside(experiment, by_model(runs, models, options.packings));
  return out;
}

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
  settings.specimens = part.data.specimens;
  part.model = std::make_unique<inference::Model>(part.data.bank, part.data.experiment, settings);
  part.problem = part.model->problem(part.data.experiment.values);
  return part;
}

/// Held-out observables as the emulators predict them.
Vector predicted(const Part &part, const Hypothesis &h, const Vector &scores) {
  const inference::Prediction p = part.problem.predict(
      scores.head(part.problem.base_parameters), inference::applied_at(part.problem, h, scores));
  return part.model->map().observables_of(p.mean.head(part.model->map().emulated()));
}

/// Recalibrated on `train`, predicted for `test`.
RerunModel calibrated(const std::string &role, const Hypothesis &h, const Part &train,
                      const Part &test) {
  const inference::Likelihood likelihood(train.problem, h, train.problem.discrepancy);
  const inference::Evidence e = inference::evidence(likelihood, {});
  RerunModel out = model_at(role, h, e.mode, train.problem, train.data);
  HeldOut held_out = held_out_of(test.data);
  held_out.sd = test.model->sd();
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
  const auto named = std::find_if(effects.begin(), effects.end(),
                                  [&](const Hypothesis &h) { return h.name == which.claim; });
  const bool claimed = named != effects.end();
  const Hypothesis first = claimed ? *named : effects.front();
  out.emplace_back("after", first);
  const auto apart = [&](const Hypothesis &h) {
    return h.on.size() == 1 &&
           std::find(first.on.begin(), first.on.end(), h.on[0]) == first.on.end();
  };
  const auto second = std::find_if(effects.begin(), effects.end(), apart);
  if (second == effects.end())
    return out;
  out.emplace_back("runner-up", *second);
  const auto least = std::find_if(effects.rbegin(), effects.rend(), apart);
  if (claimed && least->name != second->name)
    out.emplace_back("placebo", *least);
  return out;
}

} // namespace

RerunModel model_at(const std::string &role, const Hypothesis &h, const Vector &scores,
                    const inference::Problem &problem, const ExperimentData &data) {
  RerunModel out;
  out.role = role;
  out.hypothesis = h.name;
  for (int k = 0; k < problem.base_parameters; ++k)
    out.base.push_back(data.bank.base[std::size_t(k)].prior.value(scores[k]));
  for (const inference::Applied &a : inference::applied_at(problem, h, scores)) {
    const inference::ModelledEffect &effect = problem.effects[std::size_t(a.effect)];
    out.effect[effect.name] =
        find_effect(effect.name)
            .parameter.value(effect.parameters.front().prior.value(a.scores[0]));
  }
  return out;
}

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
