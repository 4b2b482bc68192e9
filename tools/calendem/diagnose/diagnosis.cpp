// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/diagnosis.h"
#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace calendem {

using inference::Change;
using inference::Verdict;
namespace {

using Eigen::Index;

constexpr double kWrong = 0.1;      // probability of each change before the data
constexpr std::size_t kThinned = 4; // every fourth draw tells what further data are worth
// The discrepancy shows from where it is as large as the errors, within the middle half of its prior.
constexpr double kQuarter = 0.25;

/// In what an experiment lies outside the bank.
std::vector<std::string> outside_of(const FilmBank &bank, const Film &film, const Experiment &e) {
  std::vector<std::string> out = bank.beyond(film);
  for (const Condition &c : e.conditions)
    if (c.max_pressure_MPa && !bank.covers(c.max_pressure_MPa->value))
      out.push_back(fmt::format("{}: {:g} MPa; the bank has {:g} to {:g} MPa", c.id,
                                c.max_pressure_MPa->value, bank.pressures().front(),
                                bank.pressures().back()));
  return out;
}

std::vector<inference::Block> blocks_of(const Diagnosis &d) {
  std::vector<inference::ObservableId> ids;
  for (const int k : d.readings) {
    const Reading &r = d.measured.readings[std::size_t(k)];
    const Observable &o = r.observable;
    ids.push_back({o.curve.empty() ? o.name : o.curve, o.stage, r.condition, o.coordinate});
  }
  std::vector<inference::Block> out = inference::blocks_of(ids);
  for (inference::Block &b : out)
    for (int &member : b.members)
      member += int(first_datum(d));
  return out;
}

/// The size of the discrepancy whose variance is that of the errors, on average over the film's data.
double size_that_shows(const Diagnosis &d) {
  const inference::FilmData &film = d.of.problem.films[std::size_t(d.film)];
  const Index n = film.observed.size();
  const double ratio = (film.discrepancy.diagonal().array() /
                        d.model.covariance.diagonal().segment(first_datum(d), n).array())
                           .mean();
  const inference::Prior &prior = d.of.problem.discrepancy;
  const double least = prior.value(inference::normal_quantile(kQuarter)),
               most = prior.value(inference::normal_quantile(1.0 - kQuarter));
  return std::clamp(1.0 / std::sqrt(ratio), least, most);
}

/// What is named, if all of it is so; else the most probable set that a simulation could have.
std::vector<int> leading_of(const Diagnosis &d) {
  if (d.verdict.kind == Verdict::explained)
    return d.verdict.changes;
  for (const inference::ChangeSet &s : d.sets)
    if (d.verdict.kind != Verdict::nothing_seen &&
        std::any_of(s.changes.begin(), s.changes.end(),
                    [&](int k) { return d.changes.all[std::size_t(k)].effect >= 0; }))
      return s.changes;
  return {};
}

/// Effects that act in the user's model with these changes.
std::vector<int> acting_with(const Diagnosis &d, const std::vector<int> &changes) {
  std::vector<int> out = inference::effects_of_model(d.of.problem);
  for (const int k : changes) {
    const Change &change = d.changes.all[std::size_t(k)];
    if (change.kind == Change::added || change.kind == Change::fault)
      out.push_back(change.effect);
    else if (change.kind == Change::absent)
      out.erase(std::find(out.begin(), out.end(), change.effect));
  }
  std::sort(out.begin(), out.end());
  return out;
}

inference::Posterior thinned(const inference::Posterior &from, std::vector<int> &hypotheses) {
  inference::Posterior out;
  std::vector<int> kept;
  for (std::size_t k = 0; k < from.draws.size(); k += kThinned) {
    out.draws.push_back(from.draws[k]);
    out.draws.back().weight *= double(kThinned);
    kept.push_back(hypotheses[k]);
  }
  hypotheses = kept;
  return out;
}

void add_further(const Experiment &e, const FilmBank &bank, const ProblemOptions &options,
                 Diagnosis &d) {
  MeasuredFilms with = d.measured;
  std::vector<std::vector<int>> places;
  d.further = further_measurements(e, bank, d.measured, d.film, with, places);
  std::vector<int> hypotheses = inference::sets_of_draws(d.changes, d.sets);
  const inference::Posterior posterior = thinned(d.posterior, hypotheses);
  std::vector<double> weights(d.sets.size() + 1, 0.0);
  for (const int h : hypotheses)
    weights[std::size_t(h)] += 1.0 / double(hypotheses.size());
  d.now = std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
  const FilmProblem of = problem_of(bank, with, options);
  const auto gains = inference::expected_gains(of.problem, posterior, d.film,
                                               Index(d.readings.size()), places, hypotheses);
  for (std::size_t k = 0; k < gains.size(); ++k)
    d.further[k].gain = gains[k];
  std::stable_sort(d.further.begin(), d.further.end(),
                   [](const FurtherMeasurement &a, const FurtherMeasurement &b) {
                     return a.gain.information > b.gain.information;
                   });
}

} // namespace

Index first_datum(const Diagnosis &d) {
  Index out = 0;
  for (int f = 0; f < d.film; ++f)
    out += d.of.problem.films[std::size_t(f)].observed.size();
  return out;
}

std::string name_of(const Diagnosis &d, int place) {
  const Change &change = d.changes.all[std::size_t(place)];
  if (change.kind == Change::understated)
    return "noise";
  if (change.kind == Change::something)
    return "unknown";
  const std::string &effect = d.of.effects[std::size_t(change.effect)].name;
  return change.kind == Change::absent ? "no " + effect : effect;
}

Diagnosis diagnosed(const Experiment &e, const FilmBank &bank, const DiagnosisOptions &options) {
  Diagnosis d;
  d.experiment = e.name;
  if (options.prior)
    d.measured = measured_films(*options.prior);
  add_readings(e, bank, d.measured, d.warnings);
  d.film = int(d.measured.films.size()) - 1;
  d.outside = outside_of(bank, d.measured.films.back(), e);
  ProblemOptions problem;
  problem.acting = options.acting;
  problem.wrong = problem.understated = kWrong;
  problem.faults = true;
  problem.error = model_error_of(bank);
  if (!e.on_press)
    problem.error.numerics = 0.0;
  d.of = problem_of(bank, d.measured, problem);
  d.readings = d.of.readings[std::size_t(d.film)];
  d.blocks = blocks_of(d);
  inference::SamplerSettings sampler, alone;
  sampler.particles = options.particles;
  alone.particles = options.particles / 2;
  alone.final_sweeps = sampler.final_sweeps = 8;
  alone.keep_every = 2;
  const inference::PosteriorProblem &p = d.of.problem;
  d.model = inference::fit_model(p, inference::effects_of_model(p), d.film, alone);
  d.where = inference::residual_table(d.model, d.blocks);
  d.posterior = inference::sample_posterior(p, sampler);
  d.changes = inference::changes_of(p, d.posterior, d.film, size_that_shows(d));
  d.sets = inference::ranked_sets(d.changes);
  d.adequacy = inference::adequacy_of(p, d.posterior);
  d.verdict = inference::verdict_of(
      d.changes, d.adequacy,
      std::any_of(d.where.rows.begin(), d.where.rows.end(),
                  [](const inference::BlockResidual &r) { return r.significant; }));
  d.leading = leading_of(d);
  d.explained = inference::fit_model(p, acting_with(d, d.leading), d.film, alone);
  add_further(e, bank, problem, d);
  return d;
}

} // namespace calendem
