// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/experiment_data.h"
#include "compare/observables.h"
#include "inference/sobol_points.h"
#include "spec/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {
using inference::Matrix;
using inference::Vector;
namespace {

// Of the value: what an observable without sd counts as good to, so that no covariance is singular.
constexpr double kExact = 1e-3;

/// The runs of one point, by target.
using PointRuns = std::vector<const BankRow *>;

std::vector<PointRuns> points_of(const BankTable &table, std::vector<std::string> &not_said) {
  std::map<std::pair<std::string, int>, PointRuns> points;
  for (const BankRow &row : table.rows)
    if (row.point.effect != kFullCell)
      points[{row.point.effect, row.point.base_point}].push_back(&row);
  std::vector<PointRuns> out;
  const auto whole = [&](const std::string &effect, int base_point) {
    const auto at = points.find({effect, base_point});
    return at != points.end() && at->second.size() == table.spec.pressures.size();
  };
  for (auto &[key, runs] : points) {
    std::sort(runs.begin(), runs.end(),
              [](const BankRow *a, const BankRow *b) { return a->run.target < b->run.target; });
    if (whole(key.first, key.second) && whole("", key.second))
      out.push_back(runs);
  }
  if (out.size() < points.size())
    not_said.push_back(fmt::format("{} of the bank's {} points lack a run, or that of their base "
                                   "point, and are left out.",
                                   points.size() - out.size(), points.size()));
  return out;
}

/// The point's run to a condition's pressure; `see` is how its press shows it.
SimulatedRun run_at(const PointRuns &runs, double pressure,
                    const std::function<SimulatedRun(const SimulatedRun &)> &see) {
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (std::fabs(runs[k]->run.target - pressure) <= 0.02 * pressure)
      return see(runs[k]->run);
  for (std::size_t k = 1; k < runs.size(); ++k)
    if (runs[k]->run.target > pressure)
      return see(between_runs(runs[k - 1]->run, runs[k]->run, pressure));
  return see(runs.back()->run);
}

/// The conditions that the bank covers, with the observables of each.
struct Covered {
  const Condition *condition;
  double pressure;
  std::vector<Observable> observables;
};

std::vector<Covered> covered_by(const Experiment &e, const BankSpec &spec,
                                const std::vector<std::string> &wanted,
                                std::vector<std::string> &not_said) {
  std::vector<Covered> out;
  for (const Condition &c : e.conditions) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), c.id) == wanted.end())
      continue;
    if (c.control != "pressure" || !c.max_pressure_MPa) {
      not_said.push_back(fmt::format("{}: control = \"{}\" is not in the bank, whose runs go to a "
                                     "pressure; the condition is left out.",
                                     c.id, c.control));
      continue;
    }
    const double p = c.max_pressure_MPa->value;
    if (p < 0.98 * spec.pressures.front() || p > 1.02 * spec.pressures.back()) {
      not_said.push_back(fmt::format("{}: {:g} MPa lies outside the bank's {:g} to {:g} MPa; the "
                                     "condition is left out.",
                                     c.id, p, spec.pressures.front(), spec.pressures.back()));
      continue;
    }
    if (c.dwell_s > 0.0)
      not_said.push_back(fmt::format("{}: the bank's runs do not dwell; its {:g} s at the target "
                                     "are left out.",
                                     c.id, c.dwell_s));
    if (!c.labels_before.empty() || !c.labels_after.empty())
      not_said.push_back(fmt::format("{}: label images are not looked at here; calendem measure "
                                     "measures them.",
                                     c.id));
    out.push_back({&c, p, observables_of(e, c, not_said)});
  }
  return out;
}

inference::Prior prior_of(Spread spread, double low, double high) {
  return {spread == Spread::LogUniform ? inference::Prior::log_uniform : inference::Prior::uniform,
          low, high};
}

/// Values of all observables at one point.
Vector values_of(const std::vector<Covered> &all, const PointRuns &runs,
                 const std::function<SimulatedRun(const SimulatedRun &)> &see) {
  std::vector<double> values;
  for (const Covered &c : all) {
    const SimulatedRun run = run_at(runs, c.pressure, see);
    for (const Observable &o : c.observables)
      values.push_back(o.simulated(run));
  }
  return Eigen::Map<Vector>(values.data(), Eigen::Index(values.size()));
}

inference::Run bank_run(const PointRuns &runs, const Vector &values) {
  const BankPoint &p = runs.front()->point;
  inference::Run out;
  out.effect = p.effect;
  out.packing = fmt::format("{}", p.packing);
  out.base = Eigen::Map<const Vector>(p.base.data(), Eigen::Index(p.base.size()));
  if (!p.effect.empty())
    out.amplitudes = Vector::Constant(1, find_effect(p.effect).parameter.amplitude(p.value));
  out.values = values;
  return out;
}

void add_instrument(const Effect &effect, std::uint64_t seed, const std::vector<Covered> &all,
                    const std::vector<PointRuns> &points, inference::Bank &bank) {
  const inference::Parameter p = inference_effect(effect).parameters.front();
  const Matrix shares = inference::sobol_points(1, int(points.size()), seed);
  for (std::size_t k = 0; k < points.size(); ++k)
    if (points[k].front()->point.effect.empty()) {
      const double amplitude =
          p.prior.value(inference::normal_quantile(shares(0, Eigen::Index(k))));
      const double value = effect.parameter.value(amplitude);
      const auto see = [&](const SimulatedRun &r) { return shown_with(effect, value, r); };
      inference::Run run = bank_run(points[k], values_of(all, points[k], see));
      run.effect = effect.name;
      run.amplitudes = Vector::Constant(1, amplitude);
      bank.runs.push_back(run);
    }
}

/// What the bank's small cell lacks to the sample's film, and how well that is known.
struct Transfer {
  Vector change;
  Matrix covariance;
};

/// Runs of the same parameters on the full cell less those on the bank's. A film is more porous at
/// its faces, in layers that do not grow with it: the change goes with 1 / loading.
Transfer transfer_of(const Experiment &e, const BankTable &bank, const std::vector<Covered> &all,
                     std::vector<std::string> &not_said) {
  std::map<int, std::map<std::string, PointRuns>> runs;
  for (const BankRow &row : bank.rows)
    if (row.point.effect.empty() || row.point.effect == kFullCell)
      runs[row.point.base_point][row.point.effect].push_back(&row);
  const auto as_it_is = [](const SimulatedRun &r) { return r; };
  std::vector<Vector> changes;
  for (auto &[point, of] : runs)
    if (of[kFullCell].size() == bank.spec.pressures.size() && of[kFullCell].size() == of[""].size())
      changes.push_back(values_of(all, of[kFullCell], as_it_is) - values_of(all, of[""], as_it_is));
  if (changes.size() < 2)
    return {};
  const double small = read_recipe(bank.spec.recipe_file).loading,
               full = read_recipe(bank.spec.full_cell.recipe_file).loading;
  const double share = (1.0 / small - 1.0 / e.recipe.loading) / (1.0 / small - 1.0 / full);
  const double n = double(changes.size());
  Matrix d(changes[0].size(), Eigen::Index(changes.size()));
  for (std::size_t k = 0; k < changes.size(); ++k)
    d.col(Eigen::Index(k)) = changes[k];
  const Vector mean = d.rowwise().mean();
  d.colwise() -= mean;
  not_said.push_back(fmt::format(
      "The bank's cell carries {:g} mg/cm2, the sample {:g}: its runs are shifted by {:.0f} % of "
      "what {} runs of {:g} mg/cm2 differ by; how well that is known counts as uncertainty.",
      small, e.recipe.loading, 100.0 * share, changes.size(), full));
  return {share * mean, share * share * (1.0 + 1.0 / n) / (n - 1.0) * d * d.transpose()};
}

void shift(const Transfer &by, ExperimentData &data) {
  if (by.change.size() == 0)
    return;
  for (inference::Run &run : data.bank.runs)
    run.values += by.change;
  data.experiment.covariance += by.covariance;
}

/// Change of each observable by one standard deviation of the press's pressure.
Vector by_pressure(const std::vector<Covered> &all, const std::vector<PointRuns> &points) {
  std::vector<double> out;
  for (const Covered &c : all)
    for (const Observable &o : c.observables) {
      double sum = 0.0;
      int n = 0;
      for (const PointRuns &runs : points)
        if (runs.front()->point.effect.empty()) {
          const double slope =
              o.slope(run_at(runs, c.pressure, [](const SimulatedRun &r) { return r; }));
          sum += std::isfinite(slope) ? slope : 0.0; // NaN: the run ends before that pressure
          n += std::isfinite(slope);
        }
      out.push_back(n > 0 ? sum / n * c.condition->max_pressure_MPa->sd : 0.0);
    }
  return Eigen::Map<Vector>(out.data(), Eigen::Index(out.size()));
}

/// Keeps the observables that every run of the bank has.
void keep_known(ExperimentData &data, const std::vector<std::string> &names) {
  std::vector<int> kept;
  for (Eigen::Index k = 0; k < data.experiment.values.size(); ++k) {
    bool known = std::isfinite(data.experiment.values[k]);
    for (const inference::Run &run : data.bank.runs)
      known = known && std::isfinite(run.values[k]);
    if (known)
      kept.push_back(int(k));
    else
      data.not_said.push_back(
          fmt::format("{}: not every run of the bank has it; left out.", names[std::size_t(k)]));
  }
  if (kept.empty())
    throw Failure(kBadInput, "nothing that was measured can be compared with the bank. Conditions "
                             "with control = \"pressure\" within the bank's pressures are needed.");
  inference::ObservableVector all = data.experiment;
  data.experiment.of.clear();
  for (const int k : kept)
    data.experiment.of.push_back(all.of[k]);
  data.experiment.values = all.values(kept);
  data.experiment.covariance = all.covariance(kept, kept);
  for (inference::Run &run : data.bank.runs)
    run.values = Vector(run.values(kept));
  data.bank.observables = data.experiment.of;
}

void set_measured(const std::vector<Covered> &all, const Vector &pressure, ExperimentData &data,
                  std::vector<std::string> &names) {
  std::vector<double> values, sd;
  for (const Covered &c : all)
    for (const Observable &o : c.observables) {
      data.experiment.of.push_back(
          {o.curve.empty() ? o.name : o.curve, o.stage, c.condition->id, o.coordinate});
      names.push_back(fmt::format("{}: {}", c.condition->id, o.name));
      values.push_back(o.measured);
      sd.push_back(std::max(o.sd, kExact * std::fabs(o.measured)));
    }
  data.experiment.values = Eigen::Map<Vector>(values.data(), Eigen::Index(values.size()));
  const Vector s = Eigen::Map<Vector>(sd.data(), Eigen::Index(sd.size()));
  data.experiment.covariance = Matrix(s.cwiseAbs2().asDiagonal()) + pressure * pressure.transpose();
}

} // namespace

inference::Effect inference_effect(const Effect &effect) {
  const EffectParameter &p = effect.parameter;
  double low = p.amplitude(p.low), high = p.amplitude(p.high);
  if (low > high)
    std::swap(low, high);
  const Spread spread = p.scale == AmplitudeScale::Logarithm ? Spread::Uniform : p.spread;
  return {effect.name, {{"amplitude", prior_of(spread, low, high), true}}};
}

ExperimentData data_of(const Experiment &experiment, const BankTable &table,
                       const std::vector<std::string> &conditions) {
  return data_of(experiment, table, conditions, table);
}

ExperimentData data_of(const Experiment &experiment, const BankTable &table,
                       const std::vector<std::string> &conditions, const BankTable &full_cell) {
  ExperimentData data;
  const std::vector<PointRuns> points = points_of(table, data.not_said);
  const std::vector<Covered> all = covered_by(experiment, table.spec, conditions, data.not_said);
  for (const BankParameter &p : table.spec.parameters)
    data.bank.base.push_back({p.name, prior_of(p.spread, p.low, p.high), false});
  const auto as_it_is = [](const SimulatedRun &r) { return r; };
  for (const PointRuns &runs : points)
    data.bank.runs.push_back(bank_run(runs, values_of(all, runs, as_it_is)));
  for (std::size_t k = 0; k < table.spec.effects.size(); ++k) {
    const Effect &effect = find_effect(table.spec.effects[k]);
    data.bank.effects.push_back(inference_effect(effect));
    if (effect.instrument)
      add_instrument(effect, table.spec.seed + 100 + k, all, points, data.bank);
  }
  std::vector<std::string> names;
  set_measured(all, by_pressure(all, points), data, names);
  shift(transfer_of(experiment, full_cell, all, data.not_said), data);
  keep_known(data, names);
  return data;
}

} // namespace calendem
