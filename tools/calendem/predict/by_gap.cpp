// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/by_gap.h"
#include "base/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr int kGrid = 41;
constexpr std::size_t kBeside = 4; // points on each side by which a slope is taken
constexpr double kNearlyAll = 0.99;

/// One draw at one gap: the logarithm of its pressure, and other numbers at that pressure.
struct Met {
  MeanVariance log_pressure;
  bool below = false, above = false; ///< the bank's pressures
  double place = 0.0;                ///< in the grid
};

/// Variance of the logarithm of the pressure at which a curve of this variance meets a value: by the slope about
/// place k, and at most that of any pressure of the curve.
double variance_of_log(const std::vector<double> &logs, const std::vector<MeanVariance> &load,
                       std::size_t k, double variance) {
  const std::size_t from = k - std::min(k, kBeside),
                    to = std::min(k + 1 + kBeside, load.size() - 1);
  const double most = std::pow(logs.back() - logs.front(), 2) / 12.0,
               slope = (load[to].mean - load[from].mean) / (logs[to] - logs[from]);
  return slope < 0.0 ? std::min(variance / (slope * slope), most) : most;
}

/// Where a falling curve meets a value; the ends where it does not.
Met meets(const std::vector<double> &logs, const std::vector<MeanVariance> &load, double porosity) {
  Met out;
  const std::size_t last = load.size() - 1;
  std::size_t k = 0;
  while (k < last && load[k + 1].mean > porosity)
    ++k;
  out.below = porosity >= load[0].mean;
  out.above = porosity < load[last].mean;
  k = std::min(k, last - 1);
  const double drop = std::min(load[k + 1].mean - load[k].mean, -1e-9),
               step = logs[k + 1] - logs[k];
  out.place = double(k) + std::clamp((porosity - load[k].mean) / drop, 0.0, 1.0);
  const double at = out.place - double(k);
  const double variance = (1.0 - at) * load[k].variance + at * load[k + 1].variance;
  out.log_pressure = {logs[k] + at * step, variance_of_log(logs, load, k, variance)};
  return out;
}

/// A number at the draw's pressure, with what the error of that pressure adds.
MeanVariance number_at(const std::vector<MeanVariance> &row, const Met &met, double step) {
  const auto k = std::min(std::size_t(met.place), row.size() - 2);
  const double at = met.place - double(k), slope = (row[k + 1].mean - row[k].mean) / step;
  return {(1.0 - at) * row[k].mean + at * row[k + 1].mean,
          (1.0 - at) * row[k].variance + at * row[k + 1].variance +
              slope * slope * met.log_pressure.variance};
}

void check_gap(const Film &film, double gap, double solid, double before) {
  if (!(gap > solid))
    throw Failure(kBadInput, fmt::format("--gap {:g}: {} without pores is {:.1f} um thick. Ask for "
                                         "more; the foil does not count.",
                                         gap, film.name, solid));
  if (!(gap < solid / (1.0 - before)))
    throw Failure(kBadInput, fmt::format("--gap {:g}: {} is {:.1f} um thick before it is pressed. "
                                         "Ask for less; the foil does not count.",
                                         gap, film.name, solid / (1.0 - before)));
}

Mixture of_gap(const Predictions &draws, std::size_t gap) {
  Mixture out;
  for (const std::vector<MeanVariance> &d : draws)
    if (std::isfinite(d[gap].mean))
      out.of.push_back(d[gap]);
  return out;
}

AtGap at_gap(const GapDraws &d, std::size_t k) {
  AtGap out;
  out.gap = d.gaps[k];
  out.pressure = band_of(of_gap(d.log_pressure, k), std::log(d.lowest), std::log(d.highest));
  out.springback = band_of(of_gap(d.springback, k), 0.0, 1.0);
  out.cracked = band_of(of_gap(d.cracked, k), 0.0, 1.0);
  if (!d.broken.empty())
    out.broken = band_of(of_gap(d.broken, k), 0.0, 1.0);
  if (!d.inverse_tortuosity.empty())
    out.tortuosity =
        tortuosity_of(band_of(of_gap(d.inverse_tortuosity, k), 1.0 / kMostTortuosity, 1.0));
  out.below = d.below[k];
  out.above = d.above[k];
  out.runs = d.runs;
  for (double Band::*part :
       {&Band::median, &Band::low50, &Band::high50, &Band::low90, &Band::high90}) {
    out.pressure.*part = std::exp(out.pressure.*part);
    out.thickness_after.*part = out.gap * (1.0 + out.springback.*part);
    out.after.*part = 1.0 - d.solid / out.thickness_after.*part;
  }
  return out;
}

/// Porosity of the film after release, from its springback.
MeanVariance porosity_left(const MeanVariance &springback, double gap, double solid) {
  const double thickness = gap * (1.0 + springback.mean),
               slope = solid * gap / (thickness * thickness);
  return {1.0 - solid / thickness, slope * slope * springback.variance};
}

} // namespace

std::vector<double> pressures_of_curves(const FilmBank &bank) {
  return spread_pressures(bank.pressures().front(), bank.pressures().back(), kGrid);
}

FilmCurves curves_at(const std::vector<double> &pressures, const PredictionsOf &of) {
  FilmCurves out;
  out.pressures = pressures;
  out.springback = of(FilmNumber::Springback);
  out.cracked = of(FilmNumber::Cracked);
  out.broken = of(FilmNumber::Broken);
  out.inverse_tortuosity = of(FilmNumber::InverseTortuosity);
  out.load = under_load_of(of(FilmNumber::PorosityAfter), out.springback);
  return out;
}

void add_met(const FilmCurves &curves, const std::vector<std::vector<double>> &porosities,
             GapDraws &draws) {
  std::vector<double> logs;
  for (const double p : curves.pressures)
    logs.push_back(std::log(p));
  draws.below.assign(draws.gaps.size(), 0.0);
  draws.above = draws.below;
  const double step = logs[1] - logs[0], share = 1.0 / double(curves.load.size());
  for (std::size_t d = 0; d < curves.load.size(); ++d) {
    std::vector<Met> met;
    std::vector<MeanVariance> log_pressures;
    for (std::size_t k = 0; k < draws.gaps.size(); ++k) {
      met.push_back(meets(logs, curves.load[d], porosities[d][k]));
      log_pressures.push_back(met[k].log_pressure);
      draws.below[k] += met[k].below * share;
      draws.above[k] += met[k].above * share;
    }
    draws.log_pressure.push_back(log_pressures);
    const auto add = [&](const Predictions &of, Predictions &to) {
      if (of.empty())
        return;
      to.emplace_back();
      for (const Met &m : met)
        to.back().push_back(number_at(of[d], m, step));
    };
    add(curves.springback, draws.springback);
    add(curves.cracked, draws.cracked);
    add(curves.broken, draws.broken);
    add(curves.inverse_tortuosity, draws.inverse_tortuosity);
  }
}

GapDraws gaps_of(const FilmBank &bank, const Film &film, const std::vector<double> &gaps) {
  GapDraws out;
  out.film = film;
  out.gaps = gaps;
  out.solid = bank.solid_column(film);
  const double before = porosity_before(bank, film);
  for (const double gap : gaps)
    check_gap(film, gap, out.solid, before);
  out.lowest = bank.pressures().front();
  out.highest = bank.pressures().back();
  return out;
}

GapDraws under_gaps(const FilmBank &bank, const Calibration &c, const Film &film,
                    const std::vector<double> &gaps) {
  GapDraws out = gaps_of(bank, film, gaps);
  const std::vector<double> pressures = pressures_of_curves(bank);
  const FilmCurves curves = curves_at(pressures, [&](FilmNumber number) {
    return under_draws(bank, c, {film, number, pressures}, 0.0);
  });
  std::vector<double> porosities;
  for (const double gap : gaps)
    porosities.push_back(1.0 - out.solid / gap);
  add_met(curves, std::vector<std::vector<double>>(curves.load.size(), porosities), out);
  return out;
}

void check_reached(const GapDraws &draws) {
  for (std::size_t k = 0; k < draws.gaps.size(); ++k)
    if (std::max(draws.below[k], draws.above[k]) > kNearlyAll) {
      const bool below = draws.below[k] > draws.above[k];
      throw Failure(
          kBadInput,
          fmt::format("--gap {:g}: {} takes {} than {:g} MPa there, where the bank {}: nothing can "
                      "be said of it. Ask for {}, or simulate it (--runs 16).",
                      draws.gaps[k], draws.film.name, below ? "less" : "more",
                      below ? draws.lowest : draws.highest, below ? "begins" : "ends",
                      below ? "less" : "more"));
    }
}

std::vector<AtGap> at_gaps(const GapDraws &draws) {
  std::vector<AtGap> out;
  for (std::size_t k = 0; k < draws.gaps.size(); ++k)
    out.push_back(at_gap(draws, k));
  return out;
}

PredictionsOf numbers_at_gaps(const GapDraws &draws) {
  return [draws](FilmNumber number) -> Predictions {
    switch (number) {
    case FilmNumber::PorosityAfter: {
      Predictions out = draws.springback;
      for (std::vector<MeanVariance> &d : out)
        for (std::size_t k = 0; k < d.size(); ++k)
          d[k] = porosity_left(d[k], draws.gaps[k], draws.solid);
      return out;
    }
    case FilmNumber::Springback:
      return draws.springback;
    case FilmNumber::Cracked:
      return draws.cracked;
    case FilmNumber::Broken:
      return draws.broken;
    case FilmNumber::InverseTortuosity:
      return draws.inverse_tortuosity;
    case FilmNumber::LogModulus:
    case FilmNumber::CbdNanoporosity:
      return {};
    }
    return {};
  };
}

std::vector<std::string> beyond_at_gaps(const FilmBank &bank, const Film &film, int runs) {
  Film own = film;
  if (runs > 0)
    own.sizes = 0.0; // runs have its own particles
  return bank.beyond(own);
}

PredictedFilm film_at_gaps(const FilmBank &bank, const GapDraws &draws) {
  PredictedFilm out;
  out.film = draws.film;
  out.beyond = beyond_at_gaps(bank, draws.film, draws.runs);
  out.runs = draws.runs;
  for (const AtGap &at : at_gaps(draws)) {
    out.pressures.push_back(at.pressure.median);
    const double load = 1.0 - draws.solid / at.gap;
    out.under_load.push_back({load, load, load, load, load});
    out.after.push_back(at.after);
    out.springback.push_back(at.springback);
    out.cracked.push_back(at.cracked);
    if (at.broken)
      out.broken.push_back(*at.broken);
    if (at.tortuosity)
      out.tortuosity.push_back(*at.tortuosity);
  }
  return out;
}

} // namespace calendem
