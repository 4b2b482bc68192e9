// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/prediction.h"
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>

namespace calendem {
namespace {

double share_below(const Guess &g, double value) {
  if (!(g.variance > 0.0))
    return g.mean < value ? 1.0 : 0.0;
  return cdf(boost::math::normal(g.mean, std::sqrt(g.variance)), value);
}

/// By draws and pressures, with what an error of the press's pressure adds.
Guesses under_draws(const FilmBank &bank, const Calibration &c, const Wanted &wanted,
                    double pressure_sd) {
  constexpr double kStep = 0.05; // of ln p
  Wanted around = wanted;
  around.pressures.clear();
  for (const double p : wanted.pressures)
    for (const double step : {-kStep, 0.0, kStep})
      around.pressures.push_back(p * std::exp(step));
  Guesses out;
  for (const Draw &draw : c.draws) {
    const std::vector<Guess> all = given_data(bank, c, draw, around);
    out.emplace_back();
    for (std::size_t k = 0; k < all.size(); k += 3) {
      Guess g = all[k + 1];
      const double slope = (all[k + 2].mean - all[k].mean) / (2.0 * kStep);
      g.variance += std::pow(slope * pressure_sd, 2);
      out.back().push_back(g);
    }
  }
  return out;
}

std::vector<Band> bands_of(const Guesses &draws, double low, double high) {
  std::vector<Band> out;
  for (std::size_t k = 0; k < draws.front().size(); ++k) {
    Mixture m;
    for (const std::vector<Guess> &d : draws)
      m.of.push_back(d[k]);
    out.push_back(band_of(m, low, high));
  }
  return out;
}

/// Porosity under load from that after release and the springback, which scatter independently.
Guesses under_load_of(const Guesses &after, const Guesses &springback) {
  Guesses out = after;
  for (std::size_t d = 0; d < after.size(); ++d)
    for (std::size_t k = 0; k < after[d].size(); ++k) {
      const double solid = 1.0 - after[d][k].mean, s = 1.0 + springback[d][k].mean;
      out[d][k] = {1.0 - solid * s,
                   s * s * after[d][k].variance + solid * solid * springback[d][k].variance};
    }
  return out;
}

} // namespace

double Mixture::probability_below(double value) const {
  double sum = 0.0;
  for (const Guess &g : of)
    sum += share_below(g, value);
  return sum / double(of.size());
}

double Mixture::quantile(double share) const {
  double low = INFINITY, high = -INFINITY;
  for (const Guess &g : of) {
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

PredictedFilm predicted_from(const Film &film, const std::vector<double> &pressures,
                             const GuessesOf &of) {
  const Guesses after = of(FilmNumber::PorosityAfter), springback = of(FilmNumber::Springback);
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

Band porosity_band(const FilmBank &bank, const Calibration &c, const Film &film, double pressure,
                   double pressure_sd, double sd) {
  auto draws = under_draws(bank, c, {film, FilmNumber::PorosityAfter, {pressure}}, pressure_sd);
  for (std::vector<Guess> &d : draws)
    d.front().variance += sd * sd;
  return bands_of(draws, 0.0, 1.0).front();
}

std::vector<Chance> chances_from(const std::vector<double> &pressures, const GuessesOf &of,
                                 const Target &target) {
  const Guesses after = of(FilmNumber::PorosityAfter), cracked = of(FilmNumber::Cracked);
  std::vector<Chance> out;
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    Chance chance;
    chance.pressure = pressures[k];
    for (std::size_t d = 0; d < after.size(); ++d) {
      const double porosity = share_below(after[d][k], target.porosity + target.within) -
                              share_below(after[d][k], target.porosity - target.within);
      const double whole =
          target.cracked_below >= 1.0 ? 1.0 : share_below(cracked[d][k], target.cracked_below);
      chance.porosity += porosity / double(after.size());
      chance.cracked += whole / double(after.size());
      chance.both += porosity * whole / double(after.size());
    }
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

std::vector<double> spread_pressures(double low, double high, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k)
    out.push_back(low * std::pow(high / low, double(k) / (count - 1)));
  return out;
}

} // namespace calendem
