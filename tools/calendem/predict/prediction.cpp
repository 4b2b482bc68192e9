// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/prediction.h"
#include "base/messages.h"
#include "base/normal_law.h"
#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <fmt/format.h>
#include <future>
#include <map>
#include <numeric>

namespace calendem {

namespace {

double share_below(const MeanVariance &g, double value) {
  if (!(g.variance > 0.0))
    return g.mean < value ? 1.0 : 0.0;
  return normal_cdf((value - g.mean) / std::sqrt(g.variance));
}

std::vector<Band> bands_of(const Predictions &draws, double low, double high) {
  std::vector<Band> out;
  for (std::size_t k = 0; k < draws.front().size(); ++k) {
    Mixture m; // a run may lack a number, as the rows of a release
    for (const std::vector<MeanVariance> &d : draws)
      if (std::isfinite(d[k].mean))
        m.of.push_back(d[k]);
    out.push_back(band_of(m, low, high));
  }
  return out;
}

} // namespace

Predictions under_draws(const FilmBank &bank, const Calibration &c, const Query &query,
                        double pressure_sd) {
  if (!bank.knows(query.number))
    return {};
  Query around = query;
  around.pressures.clear();
  for (const double p : query.pressures) {
    const auto [below, above] = bank.beside(p);
    around.pressures.insert(around.pressures.end(), {below, p, above});
  }
  Predictions out;
  for (const std::vector<MeanVariance> &all : given_data(bank, c, c.draws, around)) {
    out.emplace_back();
    for (std::size_t k = 0; k < all.size(); k += 3) {
      MeanVariance g = all[k + 1];
      const double slope =
          (all[k + 2].mean - all[k].mean) / std::log(around.pressures[k + 2] / around.pressures[k]);
      g.variance += std::pow(slope * pressure_sd, 2);
      out.back().push_back(g);
    }
  }
  return out;
}

Predictions under_load_of(const Predictions &after, const Predictions &springback) {
  Predictions out = after;
  for (std::size_t d = 0; d < after.size(); ++d)
    for (std::size_t k = 0; k < after[d].size(); ++k) {
      const double solid = 1.0 - after[d][k].mean, s = 1.0 + springback[d][k].mean;
      out[d][k] = {1.0 - solid * s,
                   s * s * after[d][k].variance + solid * solid * springback[d][k].variance};
    }
  return out;
}

double Mixture::probability_below(double value) const {
  double sum = 0.0;
  for (const MeanVariance &g : of)
    sum += share_below(g, value);
  return sum / double(of.size());
}

double Mixture::quantile(double share) const {
  double low = INFINITY, high = -INFINITY;
  for (const MeanVariance &g : of) {
    low = std::min(low, g.mean - 8.0 * std::sqrt(g.variance) - 1e-9);
    high = std::max(high, g.mean + 8.0 * std::sqrt(g.variance) + 1e-9);
  }
  const auto [left, right] =
      boost::math::tools::bisect([&](double value) { return probability_below(value) - share; },
                                 low, high, boost::math::tools::eps_tolerance<double>(30));
  return 0.5 * (left + right);
}

Band band_of(const Mixture &m, double low, double high) {
  const auto at = [&](double share) { return std::clamp(m.quantile(share), low, high); };
  return {at(0.5), at(0.25), at(0.75), at(0.05), at(0.95)};
}

Band tortuosity_of(const Band &b) {
  return {1.0 / b.median, 1.0 / b.high50, 1.0 / b.low50, 1.0 / b.high90, 1.0 / b.low90};
}

PredictedFilm predicted_from(const Film &film, const std::vector<double> &pressures,
                             const PredictionsOf &of) {
  const Predictions after = of(FilmNumber::PorosityAfter), springback = of(FilmNumber::Springback);
  PredictedFilm out;
  out.film = film;
  out.pressures = pressures;
  out.after = bands_of(after, 0.0, 1.0);
  out.springback = bands_of(springback, 0.0, 1.0);
  out.under_load = bands_of(under_load_of(after, springback), 0.0, 1.0);
  out.cracked = bands_of(of(FilmNumber::Cracked), 0.0, 1.0);
  out.modulus = bands_of(of(FilmNumber::LogModulus), -INFINITY, INFINITY);
  for (Band &b : out.modulus)
    for (double Band::*part :
         {&Band::median, &Band::low50, &Band::high50, &Band::low90, &Band::high90})
      b.*part = std::exp(b.*part);
  if (const Predictions broken = of(FilmNumber::Broken); !broken.empty())
    out.broken = bands_of(broken, 0.0, 1.0);
  if (const Predictions inverse = of(FilmNumber::InverseTortuosity); !inverse.empty())
    for (const Band &b : bands_of(inverse, 1.0 / kMostTortuosity, 1.0))
      out.tortuosity.push_back(tortuosity_of(b));
  if (const Predictions pores = of(FilmNumber::CbdNanoporosity); !pores.empty())
    out.cbd_nanoporosity = bands_of(pores, 0.0, 1.0);
  return out;
}

PredictedFilm predicted(const FilmBank &bank, const Calibration &c, const Film &film,
                        const std::vector<double> &pressures, double pressure_sd) {
  PredictedFilm out = predicted_from(film, pressures, [&](FilmNumber number) {
    return under_draws(bank, c, {film, number, pressures}, pressure_sd);
  });
  out.beyond = bank.beyond(film);
  return out;
}

Band band_of_reading(const FilmBank &bank, const Calibration &c, const Film &film, const Datum &d) {
  auto draws = under_draws(bank, c, {film, d.number, {d.pressure}}, d.pressure_sd);
  for (std::vector<MeanVariance> &of : draws)
    of.front().variance += d.sd * d.sd;
  return bands_of(draws, 0.0, 1.0).front();
}

std::vector<Chance> chances_from(const std::vector<double> &settings, const PredictionsOf &of,
                                 const Target &target) {
  const Predictions after = of(FilmNumber::PorosityAfter), cracked = of(FilmNumber::Cracked),
                    inverse = of(FilmNumber::InverseTortuosity);
  const bool any_tortuosity = target.tortuosity_below >= kMostTortuosity;
  if (!any_tortuosity && inverse.size() != after.size())
    throw Failure(kBadInput,
                  "--tortuosity-below: the bank, or these runs, have no tortuosity. Leave it out.");
  std::vector<Chance> out;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    Chance chance;
    chance.at = settings[k];
    std::vector<double> all;
    for (std::size_t d = 0; d < after.size(); ++d) {
      if (!std::isfinite(after[d][k].mean + cracked[d][k].mean) ||
          (!any_tortuosity && !std::isfinite(inverse[d][k].mean)))
        continue; // a run may lack a number
      const double porosity = share_below(after[d][k], target.porosity + target.within) -
                              share_below(after[d][k], target.porosity - target.within);
      const double whole =
          target.cracked_below >= 1.0 ? 1.0 : share_below(cracked[d][k], target.cracked_below);
      const double open =
          any_tortuosity ? 1.0 : 1.0 - share_below(inverse[d][k], 1.0 / target.tortuosity_below);
      chance.porosity += porosity;
      chance.cracked += whole;
      chance.tortuosity += open;
      all.push_back(porosity * whole * open);
    }
    if (all.empty()) { // no run has all that is asked for
      out.push_back(chance);
      continue;
    }
    const auto n = double(all.size());
    for (double *sum : {&chance.porosity, &chance.cracked, &chance.tortuosity})
      *sum /= n;
    chance.all = std::accumulate(all.begin(), all.end(), 0.0) / n;
    // 1 - 0.8 is a little less than a fifth
    const auto least = all.begin() + std::ptrdiff_t((1.0 - kAssured) * n + 1e-9);
    std::nth_element(all.begin(), least, all.end());
    chance.assured = *least;
    out.push_back(chance);
  }
  return out;
}

std::vector<Chance> chances(const FilmBank &bank, const Calibration &c, const Film &film,
                            const std::vector<double> &pressures, double pressure_sd,
                            const Target &target) {
  return chances_from(
      pressures,
      [&](FilmNumber number) {
        return under_draws(bank, c, {film, number, pressures}, pressure_sd);
      },
      target);
}

std::size_t best_of(const std::vector<Chance> &chances) {
  constexpr double kLeast = 0.01;
  const auto largest = [&](double Chance::*value) {
    return std::max_element(chances.begin(), chances.end(),
                            [&](const Chance &a, const Chance &b) { return a.*value < b.*value; });
  };
  const auto assured = largest(&Chance::assured);
  return std::size_t((assured->assured < kLeast ? largest(&Chance::all) : assured) -
                     chances.begin());
}

std::vector<double> spread_pressures(double low, double high, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k)
    out.push_back(low * std::pow(high / low, double(k) / (count - 1)));
  return out;
}

using inference::Vector;
namespace {

double heckel(const std::vector<double> &c, double before, double pressure) {
  return before * std::exp(-pressure / c[0] - c[1]);
}

double meyer(const std::vector<double> &c, double before, double pressure) {
  return c[0] + (before - c[0]) * std::exp(-pressure / c[1]);
}

double squares(const RuleOfThumb &rule, const std::vector<double> &constants,
               const std::vector<Pressed> &data) {
  double sum = 0.0;
  for (const Pressed &d : data)
    sum += std::pow(rule.porosity(constants, d.before, d.pressure) - d.after, 2);
  return sum;
}

/// From that start, in the logarithms of the constants.
void fit(RuleOfThumb &rule, const std::vector<Pressed> &data) {
  const auto constants = [&](const Vector &at) {
    std::vector<double> out;
    for (const double x : at)
      out.push_back(std::exp(x));
    return out;
  };
  Vector start{Eigen::Index(rule.constants.size())};
  for (std::size_t k = 0; k < rule.constants.size(); ++k)
    start[Eigen::Index(k)] = std::log(rule.constants[k]);
  const double scale = 1e4; // squared points
  rule.constants =
      constants(inference::minimise(inference::with_differences([&](const Vector &at) {
                                      return scale * squares(rule, constants(at), data);
                                    }),
                                    start)
                    .at);
}

Calibration without(const Calibration &all, int film) {
  Calibration out = all;
  out.data.clear();
  for (const Datum &d : all.data)
    if (d.film != film)
      out.data.push_back(d);
  out.films[std::size_t(film)].loading = NAN; // is no film of the data
  return out;
}

std::vector<Pressed> pressed_of(const FilmBank &bank, const Calibration &c, int but) {
  std::vector<Pressed> out;
  for (const Datum &d : c.data)
    if (d.film != but && d.number == FilmNumber::PorosityAfter)
      out.push_back({porosity_before(bank, c.films[std::size_t(d.film)]), d.pressure, d.measured});
  return out;
}

} // namespace

std::vector<RuleOfThumb> rules_of_thumb(const std::vector<Pressed> &data) {
  std::vector<RuleOfThumb> out = {{"Heckel", {300.0, 0.3}, heckel}, {"Meyer", {0.2, 50.0}, meyer}};
  for (RuleOfThumb &rule : out)
    fit(rule, data);
  return out;
}

namespace {

std::vector<LeftOut> readings_left_out(const FilmBank &bank, const Calibration &all,
                                       const CalibrationSettings &settings, int film) {
  std::vector<LeftOut> out;
  Calibration others = without(all, film);
  if (others.data.empty() || others.data.size() == all.data.size())
    return out;
  calibrate(bank, settings, others);
  const Film &f = all.films[std::size_t(film)];
  const std::vector<RuleOfThumb> no_rules, rules = rules_of_thumb(pressed_of(bank, all, film));
  for (const Datum &d : all.data) {
    if (d.film != film)
      continue;
    LeftOut row = {f.name,     d.condition, d.number,
                   d.pressure, d.measured,  band_of_reading(bank, others, f, d),
                   {}};
    for (const RuleOfThumb &rule : d.number == FilmNumber::PorosityAfter ? rules : no_rules)
      row.rules[rule.name] = rule.porosity(rule.constants, porosity_before(bank, f), d.pressure);
    out.push_back(row);
  }
  return out;
}

} // namespace

std::vector<LeftOut> left_out(const FilmBank &bank, const Calibration &all,
                              const CalibrationSettings &settings) {
  bank.error_correlation(); // made once, before several ask for it
  std::vector<std::future<std::vector<LeftOut>>> films;
  for (int film = 0; film < int(all.films.size()) && all.films.size() > 1; ++film)
    films.push_back(std::async(std::launch::async, [&bank, &all, &settings, film] {
      return readings_left_out(bank, all, settings, film);
    }));
  std::vector<LeftOut> out;
  for (auto &film : films)
    for (LeftOut &row : film.get())
      out.push_back(std::move(row));
  return out;
}

} // namespace calendem
