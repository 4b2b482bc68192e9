// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/calibration.h"
#include "base/messages.h"
#include "compare/observables.h"
#include "predict/crushed.h"
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
constexpr double kUsualPorositySd = 0.01, kUsualCrackedSd = 0.1, kUsualNanoporositySd = 0.1;

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
  if (to.films.empty())
    to.materials.clear();
  to.films.push_back(bank.film_of(experiment.recipe));
  to.films.back().name = experiment.name;
  to.films.back().material = place_of_material(experiment, to.materials);
  add_crushed(experiment, bank, to.films.back().material, to, not_said);
  for (const std::string &why : bank.beyond(to.films.back()))
    not_said.push_back(fmt::format("{}: {}.", experiment.name, why));
  for (const Condition &c : experiment.conditions) {
    if (!c.pressing.empty()) {
      not_said.push_back(fmt::format("{}, {}: pressed in a way of its own (\"{}\"): left out.",
                                     experiment.name, c.id, c.pressing));
      continue;
    }
    if (!c.max_pressure_MPa || !bank.covers(c.max_pressure_MPa->value)) {
      not_said.push_back(fmt::format("{}, {}: its pressure is not known, or outside the bank's "
                                     "{:g} to {:g} MPa: left out.",
                                     experiment.name, c.id, bank.pressures().front(),
                                     bank.pressures().back()));
      continue;
    }
    if (c.porosity_before_percent || loading_of(experiment, c))
      not_said.push_back(fmt::format("{}, {}: porosity before and loading of the sample are left "
                                     "out; taken are the recipe's.",
                                     experiment.name, c.id));
    if (c.thickness_after_um && !c.porosity_after_percent)
      not_said.push_back(fmt::format("{}, {}: its thickness is left out; give "
                                     "porosity_after_percent.",
                                     experiment.name, c.id));
    if (c.porosity_after_percent)
      add_datum(c, FilmNumber::PorosityAfter, *c.porosity_after_percent, 0.01, kUsualPorositySd,
                to);
    if (c.cracked_bodies_fraction)
      add_datum(c, FilmNumber::Cracked, *c.cracked_bodies_fraction, 1.0, kUsualCrackedSd, to);
    if (c.cbd_nanoporosity_after_percent && bank.knows(FilmNumber::CbdNanoporosity))
      add_datum(c, FilmNumber::CbdNanoporosity, *c.cbd_nanoporosity_after_percent, 0.01,
                kUsualNanoporositySd, to);
    else if (c.cbd_nanoporosity_after_percent)
      not_said.push_back(fmt::format("{}, {}: the bank's runs do not say how porous the "
                                     "carbon-binder domain is: left out.",
                                     experiment.name, c.id));
  }
  if (to.data.size() == before)
    throw Failure(kBadInput,
                  fmt::format("{}: no condition with max_pressure_MPa within the bank's pressures "
                              "has porosity_after_percent, cracked_bodies_fraction or "
                              "cbd_nanoporosity_after_percent.",
                              experiment.name));
}

namespace {

/// Where a number is asked for.
struct Spot {
  int film, material;
  FilmNumber number;
  double pressure, sizes;
};

/// A part of what the model misses is common to all films of one material, and less of it to others;
/// it changes over a factor e of pressure. One shift of the bank's numerics is common to all
/// porosities, and one slope with the particles' size to all films.
double error_covariance(const ModelError &e, const Draw &draw, const Spot &a, const Spot &b) {
  if (a.number != b.number)
    return 0.0;
  const ModelDiscrepancy &missed = draw.missed;
  const double between = missed.shared * (a.material == b.material ? 1.0 : draw.alike);
  const double alike = alike_at(a.pressure, b.pressure) * (a.film == b.film ? 1.0 : between);
  switch (a.number) {
  case FilmNumber::PorosityAfter:
    return e.numerics * e.numerics + missed.sd * missed.sd * alike +
           kPorosityBySize * kPorosityBySize * a.sizes * b.sizes;
  case FilmNumber::Cracked:
    return std::pow(kCrackedPerPorosity * missed.sd, 2) * alike;
  case FilmNumber::CbdNanoporosity:
    return std::pow(missed.sd, 2) * alike;
  default:
    return 0.0;
  }
}

Spot spot_of(const Calibration &c, const Datum &d) {
  const Film &film = c.films[std::size_t(d.film)];
  return {d.film, film.material, d.number, d.pressure, film.sizes};
}

/// Emulated values of the data, and what is uncertain about them but for the measurement.
struct Predicted {
  Vector mean, variance, by_pressure; ///< by_pressure: for one sd of the press's pressure
};

/// Numbers of a film at the pressures of the bank, under each draw: the emulator takes many materials at a time.
std::vector<std::vector<MeanVariance>> curves_of(const FilmBank &bank, FilmNumber number,
                                                 const Film &film, const std::vector<Draw> &draws) {
  std::vector<const Material *> materials;
  for (const Draw &draw : draws)
    materials.push_back(&draw.of(film));
  return bank.at_pressures(number, film, materials);
}

/// Under each draw.
std::vector<Predicted> predicted_data(const FilmBank &bank, const Calibration &c,
                                      const std::vector<Draw> &draws) {
  std::map<std::pair<int, FilmNumber>, std::vector<std::vector<MeanVariance>>> curves;
  const auto n = Eigen::Index(c.data.size());
  std::vector<Predicted> out(draws.size(), {Vector(n), Vector(n), Vector(n)});
  for (Eigen::Index k = 0; k < n; ++k) {
    const Datum &d = c.data[std::size_t(k)];
    auto [at, is_new] = curves.try_emplace({d.film, d.number});
    if (is_new)
      at->second = curves_of(bank, d.number, c.films[std::size_t(d.film)], draws);
    const auto [below, above] = bank.beside(d.pressure);
    for (std::size_t m = 0; m < draws.size(); ++m) {
      const std::vector<MeanVariance> &curve = at->second[m];
      const MeanVariance g = bank.at(curve, d.pressure);
      out[m].mean[k] = g.mean;
      out[m].variance[k] = g.variance;
      const double slope =
          (bank.at(curve, above).mean - bank.at(curve, below).mean) / std::log(above / below);
      out[m].by_pressure[k] = slope * d.pressure_sd;
    }
  }
  return out;
}

/// Correlation of the emulator's errors of the data with those at spots, as if all were of one film.
Matrix output_correlation(const FilmBank &bank, const Calibration &c,
                          const std::vector<Spot> &spots) {
  Matrix out(Eigen::Index(c.data.size()), Eigen::Index(spots.size()));
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    for (Eigen::Index j = 0; j < out.cols(); ++j) {
      const Datum &a = c.data[std::size_t(i)];
      const Spot &b = spots[std::size_t(j)];
      out(i, j) = bank.error_correlation(a.number, a.pressure, b.number, b.pressure);
    }
  return out;
}

std::vector<Spot> spots_of(const Calibration &c) {
  std::vector<Spot> out;
  for (const Datum &d : c.data)
    out.push_back(spot_of(c, d));
  return out;
}

Matrix films_alike(const FilmBank &bank, const std::vector<Film> &films, const Draw &draw) {
  std::vector<const Material *> materials;
  for (const Film &film : films)
    materials.push_back(&draw.of(film));
  return bank.films_alike(films, materials);
}

/// Covariance of measured - predicted. `alike`: of films; `correlation`: of outputs.
Matrix covariance_of(const Calibration &c, const Predicted &p, const Draw &draw,
                     const Matrix &alike, const Matrix &correlation) {
  const auto n = Eigen::Index(c.data.size());
  Matrix out(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Datum &a = c.data[std::size_t(i)], &b = c.data[std::size_t(j)];
      out(i, j) =
          error_covariance(c.error, draw, spot_of(c, a), spot_of(c, b)) +
          std::sqrt(p.variance[i] * p.variance[j]) * alike(a.film, b.film) * correlation(i, j);
      if (a.film == b.film)
        out(i, j) += p.by_pressure[i] * p.by_pressure[j];
      if (i == j)
        out(i, j) += a.sd * a.sd;
    }
  return out;
}

Vector measured_of(const Calibration &c) {
  Vector out{Eigen::Index(c.data.size())};
  for (std::size_t k = 0; k < c.data.size(); ++k)
    out[Eigen::Index(k)] = c.data[k].measured;
  return out;
}

} // namespace

Predictions each_from_the_others(const FilmBank &bank, const Calibration &c) {
  const std::vector<Predicted> predicted = predicted_data(bank, c, c.draws);
  const Matrix correlation = output_correlation(bank, c, spots_of(c));
  const auto n = Eigen::Index(c.data.size());
  const Vector measured = measured_of(c);
  Predictions out(c.draws.size());
  for (std::size_t m = 0; m < out.size(); ++m) {
    const Draw &draw = c.draws[m];
    const Matrix covariance =
        covariance_of(c, predicted[m], draw, films_alike(bank, c.films, draw), correlation);
    const Matrix precision = Cholesky(covariance).solve(Matrix::Identity(n, n));
    const Vector pull = precision * (measured - predicted[m].mean);
    for (Eigen::Index k = 0; k < n; ++k)
      out[m].push_back({measured[k] - pull[k] / precision(k, k), 1.0 / precision(k, k)});
  }
  return out;
}

namespace {

constexpr double kOuterTenth = 0.8; // of a scaled range, -1 to 1
constexpr double kFewMoves = 0.02;

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
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    for (std::size_t k = 0; k < bank.material().size(); ++k) {
      const inference::Parameter &p = bank.material()[k];
      const int end = end_of_range(c.draws, p.prior,
                                   [&](const Draw &d) { return d.materials[m].parameters[k]; });
      if (end != 0)
        out.push_back(fmt::format(
            "{}{} lies at the {} end of the bank's range, {:g} to {:g}: a "
            "material outside it may fit better, or the model lacks something.",
            p.name, of_material(c, m), end < 0 ? "lower" : "upper", p.prior.a, p.prior.b));
    }
  for (const std::string &text : contradicting_loads(bank, c))
    out.push_back(text);
  const inference::Prior missed = discrepancy_of(c.error);
  if (end_of_range(c.draws, missed, [](const Draw &d) { return d.missed.sd; }) > 0)
    out.push_back(fmt::format("No material of the bank comes near these data: what the model "
                              "misses lies at the upper end of its range, {:g} points of porosity. "
                              "Check pressures and porosities, or use a bank of such films.",
                              100.0 * missed.b));
  if (const std::string cut = bank.powder_cut_off(); !cut.empty())
    out.push_back(cut);
  if (c.acceptance < kFewMoves)
    out.push_back(
        fmt::format("In its worst step the sampler took {:.1f} % of its moves ({:g} % or more are "
                    "wanted): the intervals are rough. Ask for more --samples.",
                    100.0 * c.acceptance, 100.0 * kFewMoves));
  return out;
}

std::string of_material(const Calibration &c, std::size_t material) {
  return c.materials.size() > 1 ? ", " + c.materials[material] : "";
}

bool is_same_film(const Film &a, const Film &b) {
  return a.of_bank == b.of_bank && a.material == b.material && a.recipe == b.recipe &&
         a.sizes == b.sizes && a.nanoporosity == b.nanoporosity &&
         std::fabs(a.loading - b.loading) <= 1e-9 * b.loading;
}

namespace {

/// Adds to the model's own error what is predicted at a query's pressures without data, and its
/// covariance with them.
using Addition = std::function<void(std::size_t draw, const Predicted &data, const Matrix &alike,
                                    std::vector<MeanVariance> &at, Matrix &with)>;

/// Normals at spots under each draw, given the data.
Predictions conditioned(const FilmBank &bank, const Calibration &c, const std::vector<Draw> &draws,
                        const std::vector<Spot> &spots, const std::vector<Film> &films,
                        const Addition &add) {
  const std::vector<Spot> data = spots_of(c);
  const Matrix correlation = output_correlation(bank, c, data);
  const std::vector<Predicted> predicted = predicted_data(bank, c, draws);
  Predictions out;
  for (std::size_t m = 0; m < draws.size(); ++m) {
    const Draw &draw = draws[m];
    const Predicted &p = predicted[m];
    const Matrix alike = films_alike(bank, films, draw);
    const Cholesky chol(covariance_of(c, p, draw, alike, correlation));
    const Vector weights = chol.solve(measured_of(c) - p.mean);
    Matrix with(Eigen::Index(data.size()), Eigen::Index(spots.size()));
    std::vector<MeanVariance> at;
    for (std::size_t k = 0; k < spots.size(); ++k) {
      at.push_back({0.0, error_covariance(c.error, draw, spots[k], spots[k])});
      for (std::size_t i = 0; i < data.size(); ++i)
        with(Eigen::Index(i), Eigen::Index(k)) = error_covariance(c.error, draw, data[i], spots[k]);
    }
    add(m, p, alike, at, with);
    for (std::size_t k = 0; k < at.size(); ++k) {
      const Vector column = with.col(Eigen::Index(k));
      at[k].mean += column.dot(weights);
      at[k].variance = std::max(0.0, at[k].variance - column.dot(Vector(chol.solve(column))));
    }
    out.push_back(at);
  }
  return out;
}

/// Place of a film among those of the data; behind them if it is none of them.
int place_of_film(const Calibration &c, const Film &film) {
  return int(std::find_if(c.films.begin(), c.films.end(),
                          [&](const Film &f) { return is_same_film(f, film); }) -
             c.films.begin());
}

std::vector<Spot> spots_of(const Calibration &c, const Query &query, double sizes) {
  std::vector<Spot> out;
  for (const double pressure : query.pressures)
    out.push_back(
        {place_of_film(c, query.film), query.film.material, query.number, pressure, sizes});
  return out;
}

} // namespace

Predictions missed_given_data(const FilmBank &bank, const Calibration &c,
                              const std::vector<Draw> &draws, const Query &query) {
  return conditioned(
      bank, c, draws, spots_of(c, query, 0.0), c.films,
      [](std::size_t, const Predicted &, const Matrix &, std::vector<MeanVariance> &, Matrix &) {});
}

Predictions given_data(const FilmBank &bank, const Calibration &c, const std::vector<Draw> &draws,
                       const Query &query) {
  const std::vector<Spot> spots = spots_of(c, query, query.film.sizes);
  std::vector<Film> films = c.films;
  if (place_of_film(c, query.film) == int(films.size()))
    films.push_back(query.film);
  const Matrix correlation = output_correlation(bank, c, spots);
  const auto curves = curves_of(bank, query.number, query.film, draws);
  return conditioned(bank, c, draws, spots, films,
                     [&](std::size_t draw, const Predicted &data, const Matrix &alike,
                         std::vector<MeanVariance> &at, Matrix &with) {
                       for (std::size_t k = 0; k < at.size(); ++k) {
                         const MeanVariance g = bank.at(curves[draw], spots[k].pressure);
                         at[k].mean += g.mean;
                         at[k].variance += g.variance;
                         for (Eigen::Index i = 0; i < with.rows(); ++i)
                           with(i, Eigen::Index(k)) +=
                               std::sqrt(data.variance[i] * g.variance) *
                               alike(c.data[std::size_t(i)].film, spots[k].film) *
                               correlation(i, Eigen::Index(k));
                       }
                     });
}

} // namespace calendem
