// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/experiment_data.h"
#include "base/messages.h"
#include "diagnose/sample_film.h"
#include "inference/numerics.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {
using inference::Matrix;
using inference::Vector;
namespace {

// Share of the value: what an observable without sd counts as good to, so that no covariance is
// singular.
constexpr double kExact = 1e-3;
constexpr double kRarely = 0.03; // of the points

inference::Prior prior_of(Spread spread, double low, double high) {
  return {spread == Spread::LogUniform ? inference::Prior::log_uniform : inference::Prior::uniform,
          low, high};
}

inference::BankRun bank_run(const PointRuns &runs, const Vector &values) {
  const BankPoint &p = runs.front()->point;
  inference::BankRun out;
  out.effect = p.effect;
  out.packing = fmt::format("{}", p.packing);
  out.base = Eigen::Map<const Vector>(p.base.data(), Eigen::Index(p.base.size()));
  if (!p.effect.empty())
    out.amplitudes = Vector::Constant(1, find_effect(p.effect).parameter.amplitude(p.value));
  out.values = values;
  return out;
}

/// On the sample's film, which another electrode's is: the less porous, the more a micrometre is.
void add_instrument(const Effect &effect, std::uint64_t seed, double film, const OtherFilm &other,
                    const std::vector<CoveredCondition> &all, const std::vector<PointRuns> &points,
                    inference::Bank &bank) {
  const inference::Parameter p = inference_effect(effect).parameters.front();
  const Matrix shares = inference::sobol_points(1, int(points.size()), seed);
  for (std::size_t k = 0; k < points.size(); ++k)
    if (points[k].front()->point.effect.empty()) {
      const double amplitude =
          p.prior.value(inference::normal_quantile(shares(0, Eigen::Index(k))));
      const double value = effect.parameter.value(amplitude);
      const double on_film = value * film; // micrometres do not grow with a film
      const auto see = [&](const SimulatedRun &r) { return shown_with(effect, on_film, other(r)); };
      inference::BankRun run =
          bank_run(points[k], values_of(all, points[k], as_it_is) + values_of(all, points[k], see) -
                                  values_of(all, points[k], other));
      run.effect = effect.name;
      run.amplitudes = Vector::Constant(1, amplitude);
      bank.runs.push_back(run);
    }
}

inference::ObservableId named(const CoveredCondition &c, const Observable &o) {
  return {o.curve.empty() ? o.name : o.curve, o.stage, c.condition.id, o.coordinate};
}

/// Observables, and their covariance: their own errors and those that they share.
inference::ObservableVector measured_of(const std::vector<CoveredCondition> &all,
                                        const std::vector<ErrorTerm> &terms) {
  inference::ObservableVector out;
  std::vector<double> values, sd;
  for (const CoveredCondition &c : all)
    for (const Observable &o : c.observables) {
      out.of.push_back(named(c, o));
      values.push_back(o.measured);
      sd.push_back(std::max(o.sd, kExact * std::fabs(o.measured)));
    }
  const auto n = Eigen::Index(values.size());
  out.values = Eigen::Map<Vector>(values.data(), n);
  const Vector s = Eigen::Map<Vector>(sd.data(), n);
  out.covariance = Matrix(s.cwiseAbs2().asDiagonal()) + covariance_of(terms, n);
  return out;
}

/// Enough of the base model and of every effect to learn from, or all there are.
bool enough_to_learn(const inference::Bank &bank, const std::vector<bool> &counted) {
  std::map<std::string, int> all, of_these;
  for (std::size_t k = 0; k < bank.runs.size(); ++k) {
    ++all[bank.runs[k].effect];
    of_these[bank.runs[k].effect] += counted[k];
  }
  return std::all_of(all.begin(), all.end(), [&](const auto &of) {
    const int more = of.first.empty() ? int(bank.base.size()) : 0;
    return of_these[of.first] >= std::min(of.second, inference::kFewestRuns + more);
  });
}

/// Values among `count` from `first` on that are numbers in every run that has any of them;
/// none, if too few runs have.
std::vector<int> known_of(const inference::Bank &bank, int first, int count) {
  std::vector<bool> has_any;
  for (const inference::BankRun &run : bank.runs)
    has_any.push_back(run.values.segment(first, count).array().isFinite().any());
  std::vector<int> known;
  for (int k = 0; k < count && enough_to_learn(bank, has_any); ++k) {
    bool whole = true;
    for (std::size_t r = 0; r < bank.runs.size(); ++r)
      whole = whole && (!has_any[r] || std::isfinite(bank.runs[r].values[first + k]));
    if (whole)
      known.push_back(k);
  }
  return known;
}

inference::ObservableVector only(const inference::ObservableVector &all,
                                 const std::vector<int> &kept) {
  inference::ObservableVector out;
  for (const int k : kept)
    out.of.push_back(all.of[std::size_t(k)]);
  out.values = all.values(kept);
  out.covariance = all.covariance(kept, kept);
  return out;
}

/// What the experiment has and every run too; the bank's values of it go into `kept`.
void set_experiment(const inference::ObservableVector &measured,
                    const std::vector<CoveredCondition> &all, ExperimentData &data,
                    std::vector<int> &kept) {
  std::vector<ValueLabel> labels;
  for (const CoveredCondition &c : all)
    for (const Observable &o : c.observables)
      labels.push_back({o.name, o.unit, o.curve.empty() ? c.pressure : o.pressure});
  for (const int k : known_of(data.bank, 0, int(labels.size())))
    if (std::isfinite(measured.values[k]))
      kept.push_back(k);
  std::map<std::string, std::vector<std::string>> lacking; // of a condition
  for (int k = 0; k < int(labels.size()); ++k)
    if (std::find(kept.begin(), kept.end(), k) == kept.end())
      lacking[measured.of[std::size_t(k)].condition].push_back(labels[std::size_t(k)].name);
    else
      data.labels.push_back(labels[std::size_t(k)]);
  for (const auto &[condition, names] : lacking)
    data.not_said.push_back(fmt::format("{}: not every run of the bank has its {}; left out.",
                                        condition, fmt::join(names, ", ")));
  for (ErrorTerm &t : data.terms)
    t.columns = Matrix(t.columns(kept, Eigen::all));
  if (kept.empty())
    throw Failure(kBadInput,
                  fmt::format("nothing that was measured can be compared with the bank. Conditions "
                              "with max_pressure_MPa within the bank's pressures are needed."
                              "{}",
                              as_list(data.not_said)));
  data.experiment = only(measured, kept);
}

/// Candidates for the next measurement; their values in the bank begin at `first`.
void set_next(const Experiment &e, const BankSpec &spec, const std::vector<Further> &further,
              const std::vector<PointRuns> &points, int first, ExperimentData &data,
              std::vector<int> &kept) {
  for (const Further &f : further) {
    const inference::ObservableVector all = measured_of(f.of, error_terms(e, spec, f.of, points));
    const std::vector<int> known = known_of(data.bank, first, int(all.of.size()));
    const inference::ObservableVector had = only(all, known);
    if (!known.empty())
      data.next.push_back({f.what, f.hours, had.of, had.covariance});
    data.bank.observables.insert(data.bank.observables.end(), had.of.begin(), had.of.end());
    for (const int k : known)
      kept.push_back(first + k);
    first += int(all.of.size());
  }
}

/// A matrix whose product with its transpose is this covariance; 0 where that is not known.
Matrix root_of(const Matrix &covariance) {
  if (covariance.size() == 0) // nothing can be compared; said when that is counted
    return covariance;
  const Matrix known = covariance.array().isFinite().select(covariance, 0.0);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(known);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// What an effect at the film's faces changes counts less in a thicker film.
void thin_out(double film, const std::vector<PointRuns> &points, inference::Bank &bank) {
  std::map<int, std::size_t> base;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (points[k].front()->point.effect.empty())
      base[points[k].front()->point.base_point] = k;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const BankPoint &p = points[k].front()->point;
    if (p.effect.empty() || find_effect(p.effect).layer != "boundary")
      continue;
    const Vector &off = bank.runs[base.at(p.base_point)].values;
    bank.runs[k].values = off + film * (bank.runs[k].values - off);
  }
}

/// Effects that the table has too few runs of to learn them are left out, and reported.
std::vector<PointRuns> enough(std::vector<PointRuns> points, BankSpec &spec,
                              std::vector<std::string> &not_said) {
  std::map<std::string, int> count;
  for (const PointRuns &runs : points)
    ++count[runs.front()->point.effect];
  const auto few = [&](const std::string &effect) {
    return !effect.empty() && !find_effect(effect).instrument &&
           count[effect] < inference::kFewestRuns;
  };
  for (const std::string &effect : spec.effects)
    if (few(effect))
      not_said.push_back(fmt::format("The bank has {} points of {}, fewer than the {} that it can "
                                     "be learnt from: it cannot be named.",
                                     count[effect], effect, inference::kFewestRuns));
  spec.effects.erase(std::remove_if(spec.effects.begin(), spec.effects.end(), few),
                     spec.effects.end());
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const PointRuns &r) { return few(r.front()->point.effect); }),
               points.end());
  return points;
}

/// Effects that have no part in the diagnosis.
void report_other_effects(const BankSpec &spec, std::vector<std::string> &not_said) {
  std::vector<std::string> others;
  for (const Effect &e : effects())
    if (std::find(spec.effects.begin(), spec.effects.end(), e.name) == spec.effects.end())
      others.push_back(e.name);
  if (!others.empty())
    not_said.push_back(fmt::format("Cannot be named, because the bank has no runs of them or they "
                                   "were left out: {}.",
                                   fmt::join(others, ", ")));
}

/// Points of effects that lack what nearly all others have are left out: else it would be.
std::vector<PointRuns> complete(std::vector<PointRuns> points,
                                const std::vector<CoveredCondition> &all,
                                std::vector<std::string> &not_said) {
  std::vector<Vector> values;
  for (const PointRuns &runs : points)
    values.push_back(values_of(all, runs, [](const SimulatedRun &r) { return r; }));
  std::vector<bool> out(points.size(), false);
  for (Eigen::Index k = 0; k < (values.empty() ? 0 : values.front().size()); ++k) {
    std::vector<std::size_t> lacking;
    for (std::size_t p = 0; p < points.size(); ++p)
      if (!std::isfinite(values[p][k]))
        lacking.push_back(p);
    const bool of_effects = std::all_of(lacking.begin(), lacking.end(), [&](std::size_t p) {
      return !points[p].front()->point.effect.empty();
    });
    for (const std::size_t p : lacking)
      out[p] = out[p] || (of_effects && double(lacking.size()) <= kRarely * double(points.size()));
  }
  std::vector<PointRuns> kept;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (!out[p])
      kept.push_back(points[p]);
  if (kept.size() < points.size())
    not_said.push_back(fmt::format("{} of the bank's {} points lack what nearly all others have "
                                   "and are left out.",
                                   points.size() - kept.size(), points.size()));
  return kept;
}

void fill_bank(double film, const OtherFilm &other, const BankTable &table,
               const std::vector<CoveredCondition> &all, const std::vector<PointRuns> &points,
               inference::Bank &bank) {
  for (const BankParameter &p : table.spec.parameters)
    bank.base.push_back({p.name, prior_of(p.spread, p.low, p.high), false});
  for (const PointRuns &runs : points)
    bank.runs.push_back(bank_run(runs, values_of(all, runs, as_it_is)));
  thin_out(film, points, bank);
  for (std::size_t k = 0; k < table.spec.effects.size(); ++k) {
    const Effect effect = effect_of(table.spec, table.spec.effects[k]);
    bank.effects.push_back(inference_effect(effect));
    if (effect.instrument)
      add_instrument(effect, table.spec.seed + 100 + k, film, other, all, points, bank);
  }
}

} // namespace

inference::ModelledEffect inference_effect(const Effect &effect) {
  const EffectParameter &p = effect.parameter;
  double low = p.amplitude(p.low), high = p.amplitude(p.high);
  if (low > high)
    std::swap(low, high);
  const Spread spread = p.scale == AmplitudeScale::Logarithm ? Spread::Uniform : p.spread;
  const EffectParameter &whole = find_effect(effect.name).parameter; // a bank's may be another
  const double weakest = std::min(whole.amplitude(whole.low), whole.amplitude(whole.high));
  return {effect.name,
          {{"amplitude", prior_of(spread, low, high), true, p.power, weakest}},
          effect.instrument};
}

ExperimentData data_of(const Experiment &experiment, const BankTable &table,
                       const std::vector<std::string> &conditions) {
  return data_of(experiment, table, conditions, table);
}

ExperimentData data_of(const Experiment &experiment, const BankTable &as_given,
                       const std::vector<std::string> &conditions, const BankTable &full_cell) {
  ExperimentData data;
  report_other_effects(as_given.spec, data.not_said);
  BankTable table = as_given;
  const std::vector<CoveredCondition> now = pooled_repeats(
      experiment, covered_conditions(experiment, table, conditions, data.not_said), data.not_said);
  const std::vector<PointRuns> all_points =
      enough(points_of(table, runs_for(now), data.not_said), table.spec, data.not_said);
  const std::vector<Further> further = further_measurements(experiment, table, now);
  std::vector<CoveredCondition> all = now;
  for (const Further &f : further)
    all.insert(all.end(), f.of.begin(), f.of.end());
  const std::vector<PointRuns> points =
      enough(complete(all_points, now, data.not_said), table.spec, data.not_said);
  fill_bank(film_ratio(experiment, full_cell), OtherFilm(full_cell), table, all, points, data.bank);
  data.terms = error_terms(experiment, table.spec, now, points);
  for (const CoveredCondition &c : all)
    data.specimens.emplace(c.condition.id, inference::Specimen{c.condition.specimen, c.specimens});
  inference::ObservableVector measured = measured_of(now, data.terms);
  if (const FullCellChange t = full_cell_change(experiment, full_cell, all, data.not_said);
      t.change.size()) {
    for (inference::BankRun &run : data.bank.runs)
      run.values += t.change;
    const Eigen::Index n = measured.values.size();
    const Matrix unknown = t.covariance.topLeftCorner(n, n);
    measured.covariance += unknown;
    data.terms.push_back({"numerics: shift to the sample's film", root_of(unknown)});
  }
  std::vector<int> kept; // of the values of `all`
  set_experiment(measured, now, data, kept);
  data.bank.observables = data.experiment.of;
  set_next(experiment, table.spec, further, points, int(measured.of.size()), data, kept);
  for (inference::BankRun &run : data.bank.runs)
    run.values = Vector(run.values(kept));
  return data;
}

} // namespace calendem
