// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/by_gap.h"
#include "base/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr int kGrid = 41;

/// Of one draw at one gap: the logarithm of its pressure, and other numbers at that pressure.
struct Met {
  Guess log_pressure;
  bool below = false, above = false; ///< the bank's pressures
  double place = 0.0;                ///< in the grid
};

/// Where a falling curve meets a value; the ends where it does not.
Met meets(const std::vector<double> &logs, const std::vector<Guess> &load, double porosity) {
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
  out.log_pressure = {logs[k] + at * step, variance * std::pow(step / drop, 2)};
  return out;
}

/// A number at the draw's pressure, with what the error of that pressure adds.
Guess number_at(const std::vector<Guess> &row, const Met &met, double step) {
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

/// Curves of a film at a grid of pressures: draws x pressures.
struct Curves {
  std::vector<double> logs;                                      ///< of the pressures
  Guesses springback, load, cracked, broken, inverse_tortuosity; ///< empty: not known
};

Curves curves_of(const FilmBank &bank, const Calibration &c, const Film &film) {
  Curves out;
  const std::vector<double> pressures =
      spread_pressures(bank.spec().pressures.front(), bank.spec().pressures.back(), kGrid);
  for (const double p : pressures)
    out.logs.push_back(std::log(p));
  const auto of = [&](FilmNumber number) {
    return under_draws(bank, c, {film, number, pressures}, 0.0);
  };
  out.springback = of(FilmNumber::Springback);
  out.cracked = of(FilmNumber::Cracked);
  out.broken = of(FilmNumber::Broken);
  out.inverse_tortuosity = of(FilmNumber::InverseTortuosity);
  out.load = under_load_of(of(FilmNumber::PorosityAfter), out.springback);
  return out;
}

AtGap at_gap(const Curves &curves, double gap, double solid) {
  AtGap out;
  out.gap = gap;
  Mixture pressure, springback, cracked, broken, inverse;
  const double step = curves.logs[1] - curves.logs[0];
  for (std::size_t d = 0; d < curves.load.size(); ++d) {
    const Met met = meets(curves.logs, curves.load[d], 1.0 - solid / gap);
    pressure.of.push_back(met.log_pressure);
    springback.of.push_back(number_at(curves.springback[d], met, step));
    cracked.of.push_back(number_at(curves.cracked[d], met, step));
    if (!curves.broken.empty())
      broken.of.push_back(number_at(curves.broken[d], met, step));
    if (!curves.inverse_tortuosity.empty())
      inverse.of.push_back(number_at(curves.inverse_tortuosity[d], met, step));
    out.below += met.below / double(curves.load.size());
    out.above += met.above / double(curves.load.size());
  }
  out.pressure = band_of(pressure, curves.logs.front(), curves.logs.back());
  out.springback = band_of(springback, 0.0, 1.0);
  out.cracked = band_of(cracked, 0.0, 1.0);
  if (!broken.of.empty())
    out.broken = band_of(broken, 0.0, 1.0);
  if (!inverse.of.empty())
    out.tortuosity = tortuosity_of(band_of(inverse, 1.0 / kMostTortuosity, 1.0));
  for (double Band::*part :
       {&Band::median, &Band::low50, &Band::high50, &Band::low90, &Band::high90}) {
    out.pressure.*part = std::exp(out.pressure.*part);
    out.thickness_after.*part = gap * (1.0 + out.springback.*part);
    out.after.*part = 1.0 - solid / out.thickness_after.*part;
  }
  return out;
}

} // namespace

std::vector<AtGap> at_gaps(const FilmBank &bank, const Calibration &c, const Film &film,
                           const std::vector<double> &gaps) {
  const double solid = bank.solid_column(film);
  for (const double gap : gaps)
    check_gap(film, gap, solid, porosity_before(bank, film));
  const Curves curves = curves_of(bank, c, film);
  std::vector<AtGap> out;
  for (const double gap : gaps)
    out.push_back(at_gap(curves, gap, solid));
  return out;
}

} // namespace calendem
