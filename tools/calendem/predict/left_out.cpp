// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/left_out.h"
#include <algorithm>
#include <cmath>

namespace calendem {

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
  out.films[std::size_t(film)].name += " (left out)"; // no film of the data has this name
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

double porosity_before(const FilmBank &bank, const Film &film) {
  for (std::size_t k = 0; k < bank.film().size(); ++k)
    if (bank.film()[k].keys.front() == "recipe.coating.porosity_total_percent")
      return 0.01 * film.recipe[k];
  return read_recipe(bank.spec().recipe_file).porosity_total;
}

std::vector<RuleOfThumb> rules_of_thumb(const std::vector<Pressed> &data) {
  std::vector<RuleOfThumb> out = {{"Heckel", {300.0, 0.3}, heckel}, {"Meyer", {0.2, 50.0}, meyer}};
  for (RuleOfThumb &rule : out)
    fit(rule, data);
  return out;
}

std::vector<LeftOut> left_out(const FilmBank &bank, const Calibration &all,
                              const CalibrationSettings &settings) {
  std::vector<LeftOut> out;
  for (int film = 0; film < int(all.films.size()) && all.films.size() > 1; ++film) {
    Calibration others = without(all, film);
    if (others.data.empty() || others.data.size() == all.data.size())
      continue;
    calibrate(bank, settings, others);
    const auto rules = rules_of_thumb(pressed_of(bank, all, film));
    for (const Datum &d : all.data) {
      if (d.film != film || d.number != FilmNumber::PorosityAfter)
        continue;
      const Film &f = all.films[std::size_t(film)];
      LeftOut row = {f.name,
                     d.condition,
                     d.pressure,
                     d.measured,
                     porosity_band(bank, others, f, d.pressure, d.pressure_sd, d.sd),
                     {}};
      for (const RuleOfThumb &rule : rules)
        row.rules[rule.name] = rule.porosity(rule.constants, porosity_before(bank, f), d.pressure);
      out.push_back(row);
    }
  }
  return out;
}

} // namespace calendem
