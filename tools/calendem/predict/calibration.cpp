// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/calibration.h"
#include "base/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace calendem {

using inference::Cholesky;
using inference::Matrix;
using inference::Vector;
namespace {

constexpr double kUsualPressureSd = 0.1; // where an experiment gives none
constexpr double kUsualPorositySd = 0.01, kUsualCrackedSd = 0.1;

void add_datum(const Condition &c, FilmNumber number, const Measured &value, double per_cent,
               double usual_sd, Calibration &to) {
  Datum d;
  d.film = int(to.films.size()) - 1;
  d.condition = c.id;
  d.number = number;
  d.pressure = c.max_pressure_MPa->value;
  d.pressure_sd =
      c.max_pressure_MPa->sd > 0.0 ? c.max_pressure_MPa->sd / d.pressure : kUsualPressureSd;
  d.measured = per_cent * value.value;
  d.sd = value.sd > 0.0 ? per_cent * value.sd : usual_sd;
  to.data.push_back(d);
}

} // namespace

void add_experiment(const Experiment &experiment, const FilmBank &bank, Calibration &to,
                    std::vector<std::string> &not_said) {
  const std::size_t before = to.data.size();
  to.films.push_back(bank.film_of(experiment.recipe));
  to.films.back().name = experiment.name;
  for (const std::string &why : bank.beyond(to.films.back()))
    not_said.push_back(fmt::format("{}: {}.", experiment.name, why));
  for (const Condition &c : experiment.conditions) {
    if (!c.max_pressure_MPa || !bank.covers(c.max_pressure_MPa->value)) {
      not_said.push_back(fmt::format("{}, {}: its pressure is not known, or outside the bank's "
                                     "{:g} to {:g} MPa: left out.",
                                     experiment.name, c.id, bank.spec().pressures.front(),
                                     bank.spec().pressures.back()));
      continue;
    }
    if (c.porosity_after_percent)
      add_datum(c, FilmNumber::PorosityAfter, *c.porosity_after_percent, 0.01, kUsualPorositySd,
                to);
    if (c.cracked_bodies_fraction)
      add_datum(c, FilmNumber::Cracked, *c.cracked_bodies_fraction, 1.0, kUsualCrackedSd, to);
  }
  if (to.data.size() == before)
    throw Failure(kBadInput,
                  fmt::format("{}: no condition with max_pressure_MPa within the bank's pressures "
                              "has porosity_after_percent or cracked_bodies_fraction.",
                              experiment.name));
}

namespace {

/// Where a number is asked for.
struct Spot {
  int film;
  FilmNumber number;
  double log_pressure, sizes;
};

/// A part of what the model misses is common to all films; it changes over a factor e of pressure.
/// One shift of the bank's numerics is common to all porosities, and one slope with the particles'
/// size to all films.
double error_covariance(const ModelError &e, const Missed &missed, const Spot &a, const Spot &b) {
  if (a.number != b.number)
    return 0.0;
  const double off = a.log_pressure - b.log_pressure;
  const double alike = std::exp(-0.5 * off * off) * (a.film == b.film ? 1.0 : missed.shared);
  switch (a.number) {
  case FilmNumber::PorosityAfter:
    return e.numerics * e.numerics + missed.sd * missed.sd * alike +
           kPorosityBySize * kPorosityBySize * a.sizes * b.sizes;
  case FilmNumber::Cracked:
    return e.cracked * e.cracked * alike;
  case FilmNumber::Springback:
  case FilmNumber::LogModulus:
    return 0.0;
  }
  return 0.0;
}

Spot spot_of(const Calibration &c, const Datum &d) {
  return {d.film, d.number, std::log(d.pressure), c.films[std::size_t(d.film)].sizes};
}

/// Emulated values of the data, and what is uncertain about them but for the measurement.
struct Predicted {
  Vector mean, variance, by_pressure; ///< by_pressure: for one sd of the press's pressure
  std::vector<std::vector<double>> by_full_cell; ///< FilmBank::full_cell_errors of each datum
};

double product(const std::vector<double> &a, const std::vector<double> &b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

Predicted predicted_data(const FilmBank &bank, const Calibration &c, const Material &material) {
  const auto n = Eigen::Index(c.data.size());
  Predicted out = {Vector(n), Vector(n), Vector(n), {}};
  std::map<std::pair<int, FilmNumber>, std::vector<Guess>> curves;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Datum &d = c.data[std::size_t(k)];
    auto [at, is_new] = curves.try_emplace({d.film, d.number});
    if (is_new)
      at->second = bank.at_pressures(d.number, c.films[std::size_t(d.film)], material);
    const Guess g = bank.at(at->second, d.pressure);
    out.mean[k] = g.mean;
    out.variance[k] = g.variance;
    const auto [below, above] = bank.beside(d.pressure);
    const double slope = (bank.at(at->second, above).mean - bank.at(at->second, below).mean) /
                         std::log(above / below);
    out.by_pressure[k] = slope * d.pressure_sd;
    out.by_full_cell.push_back(
        bank.full_cell_errors(d.number, c.films[std::size_t(d.film)], d.pressure));
  }
  return out;
}

/// Of measured - predicted.
Matrix covariance_of(const Calibration &c, const Predicted &p, const Missed &missed) {
  const auto n = Eigen::Index(c.data.size());
  Matrix out(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Datum &a = c.data[std::size_t(i)], &b = c.data[std::size_t(j)];
      out(i, j) = error_covariance(c.error, missed, spot_of(c, a), spot_of(c, b));
      if (a.film == b.film)
        out(i, j) += p.by_pressure[i] * p.by_pressure[j];
      if (a.number == b.number)
        out(i, j) += product(p.by_full_cell[std::size_t(i)], p.by_full_cell[std::size_t(j)]);
      if (i == j)
        out(i, j) += a.sd * a.sd + p.variance[i];
    }
  return out;
}

Vector measured_of(const Calibration &c) {
  Vector out{Eigen::Index(c.data.size())};
  for (std::size_t k = 0; k < c.data.size(); ++k)
    out[Eigen::Index(k)] = c.data[k].measured;
  return out;
}

double log_likelihood(const FilmBank &bank, const Calibration &c, const Draw &draw) {
  const Predicted p = predicted_data(bank, c, draw.material);
  const Cholesky chol(covariance_of(c, p, draw.missed));
  const Vector off = chol.matrixL().solve(measured_of(c) - p.mean);
  return -0.5 * off.squaredNorm() - Matrix(chol.matrixL()).diagonal().array().log().sum();
}

/// Prior of the model's own error.
inference::Prior discrepancy_of(const ModelError &error) {
  return {inference::Prior::log_uniform, error.low, error.high};
}

/// Samples of one hypothesis, from its prior.
std::vector<Draw> prior_draws(const FilmBank &bank, const ModelError &error,
                              const std::vector<int> &effects, int count, std::uint64_t seed) {
  const auto d = int(bank.material().size());
  const Matrix scores = inference::sobol_normals(d + 2 + int(effects.size()), count, seed);
  const inference::Prior discrepancy = discrepancy_of(error),
                         shared = {inference::Prior::uniform, 0.0, 1.0};
  std::vector<Draw> out{std::size_t(count)};
  for (int k = 0; k < count; ++k) {
    Draw &draw = out[std::size_t(k)];
    for (int j = 0; j < d; ++j)
      draw.material.parameters.push_back(bank.material()[std::size_t(j)].prior.value(scores(j, k)));
    draw.missed.sd = discrepancy.value(scores(d, k));
    draw.missed.shared = shared.value(scores(d + 1, k));
    for (int j = 0; j < int(effects.size()); ++j) {
      const int effect = effects[std::size_t(j)];
      draw.material.effects.push_back(
          {effect, bank.effects()[std::size_t(effect)].prior.value(scores(d + 2 + j, k))});
    }
  }
  return out;
}

/// Of a hypothesis that is as probable before the data as all others of as many effects.
double prior_of(const std::vector<std::vector<int>> &all, const std::vector<int> &effects,
                double pair_share) {
  const auto pairs =
      double(std::count_if(all.begin(), all.end(), [](const auto &of) { return of.size() > 1; }));
  return effects.size() > 1 ? pair_share / pairs
                            : (pairs > 0.0 ? 1.0 - pair_share : 1.0) / (double(all.size()) - pairs);
}

} // namespace

std::vector<std::vector<int>> hypotheses_of(const FilmBank &bank) {
  const auto effects = int(bank.effects().size());
  std::vector<std::vector<int>> out = {{}};
  for (int a = 0; a < effects; ++a)
    out.push_back({a});
  for (int a = 0; a < effects; ++a)
    for (int b = a + 1; b < effects; ++b)
      out.push_back({a, b});
  return out;
}

std::string name_of(const FilmBank &bank, const std::vector<int> &effects) {
  std::string out;
  for (const int effect : effects)
    out += (out.empty() ? "" : " + ") + bank.effects()[std::size_t(effect)].name;
  return out.empty() ? "none" : out;
}

std::vector<int> effects_of(const Material &material) {
  std::vector<int> out;
  for (const Acting &a : material.effects)
    out.push_back(a.effect);
  return out;
}

void calibrate(const FilmBank &bank, const CalibrationSettings &settings, Calibration &c) {
  std::vector<Draw> all;
  std::vector<double> logs;
  const auto of = hypotheses_of(bank);
  const auto hypotheses = int(of.size());
  for (int h = 0; h < hypotheses; ++h) {
    const auto &effects = of[std::size_t(h)];
    const double prior = std::log(prior_of(of, effects, settings.pair_share));
    for (const Draw &draw :
         prior_draws(bank, c.error, effects, settings.samples, std::uint64_t(h) + 1)) {
      all.push_back(draw);
      logs.push_back(prior + log_likelihood(bank, c, draw));
    }
  }
  const double largest = *std::max_element(logs.begin(), logs.end());
  std::vector<double> weights;
  for (const double l : logs)
    weights.push_back(std::exp(l - largest));
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  c.hypotheses.clear();
  for (int h = 0; h < hypotheses; ++h) {
    const auto first = weights.begin() + std::ptrdiff_t(h) * settings.samples,
               end = first + settings.samples;
    const double mass = std::accumulate(first, end, 0.0),
                 squares = std::inner_product(first, end, first, 0.0);
    c.hypotheses.push_back({name_of(bank, of[std::size_t(h)]), mass / sum,
                            squares > 0.0 ? mass * mass / squares : 0.0});
  }
  // Systematic resampling: the k-th draw is the first whose summed weight passes (k + 1/2) / n.
  c.draws.clear();
  double passed = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    passed += weights[k] / sum * settings.draws;
    while (double(c.draws.size()) + 0.5 < passed && int(c.draws.size()) < settings.draws)
      c.draws.push_back(all[k]);
  }
}

namespace {

constexpr double kOuterTenth = 0.8; // of a scaled range, -1 to 1
constexpr double kFewSamples = 50.0;

/// Of all hypotheses together.
double effective_samples(const Calibration &c) {
  double squares = 0.0;
  for (const Weighed &w : c.hypotheses)
    if (w.probability > 0.0)
      squares += w.probability * w.probability / w.effective_samples;
  return 1.0 / squares;
}

/// -1 or 1 where half of the draws lie in the outer tenth of the range at that end, else 0.
template <class Value>
int end_of_range(const std::vector<Draw> &draws, const inference::Prior &prior,
                 const Value &value) {
  int low = 0, high = 0;
  for (const Draw &d : draws) {
    const double at = prior.scaled(value(d));
    low += at < -kOuterTenth;
    high += at > kOuterTenth;
  }
  if (2 * std::max(low, high) < int(draws.size()))
    return 0;
  return low > high ? -1 : 1;
}

} // namespace

std::vector<std::string> warnings_of(const FilmBank &bank, const Calibration &c) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < bank.material().size(); ++k) {
    const inference::Parameter &p = bank.material()[k];
    const int end =
        end_of_range(c.draws, p.prior, [&](const Draw &d) { return d.material.parameters[k]; });
    if (end != 0)
      out.push_back(
          fmt::format("{} lies at the {} end of the bank's range, {:g} to {:g}: a material "
                      "outside it may fit better, or the model lacks something.",
                      p.name, end < 0 ? "lower" : "upper", p.prior.a, p.prior.b));
  }
  const inference::Prior missed = discrepancy_of(c.error);
  if (end_of_range(c.draws, missed, [](const Draw &d) { return d.missed.sd; }) > 0)
    out.push_back(fmt::format("No material of the bank comes near these data: what the model "
                              "misses lies at the upper end of its range, {:g} points of porosity. "
                              "Check pressures and porosities, or use a bank of such films.",
                              100.0 * missed.b));
  if (const double samples = effective_samples(c); samples < kFewSamples)
    out.push_back(fmt::format("Only {:.0f} samples carry the result (effective number; {:g} or "
                              "more are wanted): its intervals are rough. Ask for more --samples.",
                              samples, kFewSamples));
  return out;
}

bool is_same_film(const Film &a, const Film &b) {
  return a.recipe == b.recipe && a.sizes == b.sizes &&
         std::fabs(a.loading - b.loading) <= 1e-9 * b.loading;
}

std::vector<Guess> missed_given_data(const FilmBank &bank, const Calibration &c, const Draw &draw,
                                     const Wanted &wanted, bool by_bank) {
  const auto known = std::find_if(c.films.begin(), c.films.end(),
                                  [&](const Film &f) { return is_same_film(f, wanted.film); });
  const int film = known == c.films.end() ? -1 : int(known - c.films.begin());
  const auto n = Eigen::Index(c.data.size());
  const Predicted p = predicted_data(bank, c, draw.material);
  const Cholesky chol(covariance_of(c, p, draw.missed));
  const Vector weights = chol.solve(measured_of(c) - p.mean);
  std::vector<Guess> out;
  for (const double pressure : wanted.pressures) {
    // runs have the film's own particles
    const Spot here = {film, wanted.number, std::log(pressure), by_bank ? wanted.film.sizes : 0.0};
    const std::vector<double> by_full_cell =
        by_bank ? bank.full_cell_errors(wanted.number, wanted.film, pressure)
                : std::vector<double>();
    Vector with(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Datum &d = c.data[std::size_t(k)];
      with[k] = error_covariance(c.error, draw.missed, spot_of(c, d), here);
      if (d.number == wanted.number)
        with[k] += product(by_full_cell, p.by_full_cell[std::size_t(k)]);
    }
    const double left = error_covariance(c.error, draw.missed, here, here) +
                        product(by_full_cell, by_full_cell) - with.dot(Vector(chol.solve(with)));
    out.push_back({with.dot(weights), std::max(0.0, left)});
  }
  return out;
}

std::vector<Guess> given_data(const FilmBank &bank, const Calibration &c, const Draw &draw,
                              const Wanted &wanted) {
  const std::vector<Guess> curve = bank.at_pressures(wanted.number, wanted.film, draw.material);
  std::vector<Guess> out = missed_given_data(bank, c, draw, wanted, true);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const Guess g = bank.at(curve, wanted.pressures[k]);
    out[k] = {g.mean + out[k].mean, g.variance + out[k].variance};
  }
  return out;
}

} // namespace calendem
