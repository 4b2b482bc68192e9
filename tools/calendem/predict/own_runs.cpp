// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/own_runs.h"
#include "base/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {

namespace {

/// Keys of the nanoporosity: of the packing [%], and of the effect that changes it (0-1).
constexpr const char *kNanoporosityKeys[] = {"recipe.cbd.nanoporosity_percent",
                                             "case.effects.cbd_collapse.initial_nanoporosity"};

double four_digits(double value) { return std::stod(fmt::format("{:.4g}", value)); }

/// The draws all of whose runs are usable, and these: draws x pressures.
struct OwnRuns {
  std::vector<Draw> draws;
  std::vector<std::vector<bank::PressedFilm>> runs;
};

OwnRuns usable(const std::vector<Draw> &draws, const std::vector<std::string> &folders) {
  const std::size_t pressures = folders.size() / draws.size();
  OwnRuns out;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const auto first = folders.begin() + std::ptrdiff_t(d * pressures),
               end = first + std::ptrdiff_t(pressures);
    if (std::find(first, end, "") != end)
      continue;
    out.draws.push_back(draws[d]);
    out.runs.emplace_back();
    for (auto folder = first; folder != end; ++folder)
      out.runs.back().push_back(bank::read_run_of({}, *folder).presses.back());
  }
  return out;
}

/// Keys of the case and their values: how a film is pressed.
using Pressing = std::vector<std::pair<std::string, std::string>>;

/// A calibration holds for the particles that it was made with.
void stop_if_other_grains(const FilmBank &bank, const Recipe &recipe) {
  const std::string grains = recipe.settings.text("particles.grains"),
                    of_bank = bank.recipe().settings.text("particles.grains");
  if (recipe.structure.given() || grains == of_bank)
    return;
  throw Failure(
      kBadInput,
      fmt::format("{}: particles.grains is \"{}\", and the material is calibrated with \"{}\": "
                  "runs of both together mean nothing. Give material = \"{}\", as the bank has it, "
                  "or leave --runs out.",
                  recipe.file, grains, of_bank, bank.recipe().settings.text("material")));
}

/// The draws' materials as points, each on a packing of its own.
bank::Columns columns_of(const FilmBank &bank, const std::vector<Draw> &draws, const Recipe &recipe,
                         int material) {
  bank::Design design;
  for (const bank::Input &input : bank.spec().design.inputs)
    if (!input.is_film())
      design.inputs.push_back(input);
  const bool varies = bank.spec().nanoporosity_within > 0.0 && !recipe.structure.given();
  if (varies)
    for (const char *key : kNanoporosityKeys) {
      design.inputs.emplace_back();
      design.inputs.back().name = key;
      design.inputs.back().keys = {key};
    }
  std::vector<bank::Point> points;
  for (const Draw &draw : draws) {
    const Material &of = draw.materials[std::size_t(material)];
    bank::Point p;
    p.packing = int(points.size()) + 1;
    std::size_t of_case = 0;
    for (const bank::Input &input : design.inputs)
      p.values.push_back(input.is_effect() || of_case >= of.parameters.size()
                             ? NAN
                             : four_digits(of.parameters[of_case++]));
    if (varies) {
      const double nanoporosity = bank.nanoporosity(bank.described(recipe), of);
      p.values.end()[-2] = four_digits(100.0 * nanoporosity);
      p.values.end()[-1] = four_digits(nanoporosity);
    }
    for (const ActiveEffect &a : of.effects)
      for (std::size_t d = 0; d < design.inputs.size(); ++d)
        if (design.inputs[d].name == bank.effects()[std::size_t(a.effect)].name)
          p.values[d] = four_digits(key_value(bank, a));
    points.push_back(p);
  }
  return bank::columns_of(design, points, {});
}

/// Every draw pressed in each of these ways, by draw.
Study study_of(const FilmBank &bank, const std::vector<Draw> &draws, const Recipe &recipe,
               int material, const std::vector<Pressing> &pressings) {
  stop_if_other_grains(bank, recipe);
  bank::Bank spec = bank.spec();
  spec.name = recipe.settings.text("name") + ", by runs";
  spec.recipe_file = recipe.file;
  const bank::Columns of_draws = columns_of(bank, draws, recipe, material);
  bank::Columns all;
  all.names = of_draws.names;
  for (const auto &[key, value] : pressings.front())
    all.names.push_back("case." + key);
  for (const std::vector<std::string> &row : of_draws.rows)
    for (const Pressing &pressing : pressings) {
      all.rows.push_back(row);
      for (const auto &[key, value] : pressing)
        all.rows.back().push_back(value);
    }
  return bank::study_of(spec, all);
}

std::string number(double value) { return fmt::format("{:g}", value); }

} // namespace

bool can_be_run(const FilmBank &bank, const Draw &draw, const Recipe &recipe, int material) {
  try {
    study_of(bank, {draw}, recipe, material, {{}});
    return true;
  } catch (const Failure &) {
    return false;
  }
}

std::vector<std::size_t> spread_draws(std::size_t count, int runs,
                                      const std::function<bool(std::size_t)> &can_be_run) {
  std::vector<std::size_t> out;
  for (int k = 0; k < runs; ++k) {
    const auto first = std::size_t((k + 0.5) / runs * double(count));
    std::size_t on = 0;
    while (on < count && !can_be_run((first + on) % count))
      ++on;
    out.push_back((first + on) % count);
  }
  return out;
}

std::vector<Draw> some_draws(const FilmBank &bank, const Calibration &c, const Recipe &recipe,
                             int material, int runs) {
  std::vector<Draw> out;
  for (const std::size_t place : spread_draws(c.draws.size(), runs, [&](std::size_t d) {
         return can_be_run(bank, c.draws[d], recipe, material);
       }))
    out.push_back(c.draws[place]);
  return out;
}

Study own_runs(const FilmBank &bank, const std::vector<Draw> &draws, const Recipe &recipe,
               int material, const std::vector<double> &pressures) {
  std::vector<Pressing> pressings;
  for (const double pressure : pressures)
    pressings.push_back({{"platen.max_pressure_MPa", fmt::format("{}", pressure)},
                         {"platen.presses", "1"},
                         {"platen.first_pressure_MPa", "0"}});
  return study_of(bank, draws, recipe, material, pressings);
}

Study own_runs_at_gaps(const FilmBank &bank, const std::vector<Draw> &draws, const Recipe &recipe,
                       int material, const std::vector<double> &gaps, int passes) {
  const Film film = bank.described(recipe);
  const double before = bank.solid_column(film) / (1.0 - porosity_before(bank, film));
  std::vector<Pressing> pressings;
  for (const double gap : gaps)
    pressings.push_back(
        {{"platen.control", "roll_gap"},
         {"platen.presses", "1"},
         {"platen.first_pressure_MPa", "0"},
         {"platen.roll_gap_um", number(gap)},
         {"roll.passes", number(passes)},
         {"roll.first_gap_um",
          number(passes > 1 ? four_digits(before - (before - gap) / passes) : 0.0)}});
  return study_of(bank, draws, recipe, material, pressings);
}

void add_press_error(Predictions &draws, const std::vector<double> &pressures, double pressure_sd) {
  const std::size_t last = pressures.size() - 1;
  const auto mean_at = [&](std::size_t k) {
    double sum = 0.0, n = 0.0;
    for (const std::vector<MeanVariance> &d : draws)
      if (std::isfinite(d[k].mean)) {
        sum += d[k].mean;
        n += 1.0;
      }
    return sum / n;
  };
  for (std::size_t k = 0; k <= last; ++k) {
    const std::size_t low = k > 0 ? k - 1 : 0, high = std::min(k + 1, last);
    const double slope =
        (mean_at(high) - mean_at(low)) / std::log(pressures[high] / pressures[low]);
    for (std::vector<MeanVariance> &d : draws)
      d[k].variance += std::pow(slope * pressure_sd, 2);
  }
}

namespace {

/// Some run has the number at every pressure or gap. One may lack it, as the rows of a release.
bool known(const Predictions &draws) {
  for (std::size_t k = 0; !draws.empty() && k < draws.front().size(); ++k)
    if (std::none_of(draws.begin(), draws.end(),
                     [k](const auto &row) { return std::isfinite(row[k].mean); }))
      return false;
  return !draws.empty();
}

OwnRuns made(const Study &study, const std::vector<Draw> &draws, const StudyOptions &options) {
  const OwnRuns own = usable(draws, make_what_runs(study, options, "Draws"));
  if (int(own.draws.size()) < kFewestOwnRuns)
    throw Failure(kSimulationFailed,
                  fmt::format("{}: {} of {} draws have all their runs, {} are needed; see {}/runs.",
                              study.recipe_file, own.draws.size(), draws.size(), kFewestOwnRuns,
                              options.folder));
  return own;
}

} // namespace

ByRuns by_runs(const FilmBank &bank, const Calibration &c, const Recipe &recipe, int material,
               const std::vector<double> &pressures, double pressure_sd, int runs,
               const StudyOptions &options) {
  const std::vector<Draw> draws = some_draws(bank, c, recipe, material, runs);
  const OwnRuns own = made(own_runs(bank, draws, recipe, material, pressures), draws, options);
  Film film = bank.described(recipe);
  film.material = material;
  std::map<FilmNumber, Predictions> all;
  for (int n = 0; n < kFilmNumbers; ++n) {
    const auto number = FilmNumber(n);
    all[number] = missed_given_data(bank, c, own.draws, {film, number, pressures});
    for (std::size_t d = 0; d < own.draws.size(); ++d)
      for (std::size_t k = 0; k < pressures.size(); ++k)
        all[number][d][k].mean += bank::value_of(number, own.runs[d][k]);
    if (!known(all[number]))
      all[number].clear();
  }
  for (const auto number : {FilmNumber::PorosityAfter, FilmNumber::LogModulus})
    if (all[number].empty())
      throw Failure(kSimulationFailed,
                    fmt::format("{}: no run says what is predicted; see {}/runs.", recipe.file,
                                options.folder));
  if (pressure_sd > 0.0)
    for (auto &[number, draws_of_number] : all)
      if (!draws_of_number.empty())
        add_press_error(draws_of_number, pressures, pressure_sd);
  ByRuns out;
  out.of = [all](FilmNumber number) { return all.at(number); };
  out.predicted = predicted_from(film, pressures, out.of);
  out.predicted.runs = int(own.draws.size());
  return out;
}

namespace {

/// What the emulators say of a film under a draw.
double emulated(const FilmBank &bank, const Draw &draw, const Film &film, FilmNumber number,
                double pressure) {
  return bank.at(bank.at_pressures(number, film, draw.of(film)), pressure).mean;
}

/// Emulated porosity under load.
double emulated_load(const FilmBank &bank, const Draw &draw, const Film &film, double pressure) {
  return 1.0 - (1.0 - emulated(bank, draw, film, FilmNumber::PorosityAfter, pressure)) *
                   (1.0 + emulated(bank, draw, film, FilmNumber::Springback, pressure));
}

/// Emulated means with the model error of runs.
Predictions emulated_and_missed(const FilmBank &bank, const Calibration &c,
                                const std::vector<Draw> &draws, const Query &query) {
  if (!bank.knows(query.number))
    return {};
  Predictions out = missed_given_data(bank, c, draws, query);
  for (std::size_t d = 0; d < draws.size(); ++d) {
    const std::vector<MeanVariance> curve =
        bank.at_pressures(query.number, query.film, draws[d].of(query.film));
    for (std::size_t k = 0; k < query.pressures.size(); ++k)
      out[d][k].mean += bank.at(curve, query.pressures[k]).mean;
  }
  return out;
}

} // namespace

GapDraws from_runs_at_gaps(const FilmBank &bank, const Calibration &c, GapDraws at,
                           const std::vector<Draw> &draws,
                           const std::vector<std::vector<bank::PressedFilm>> &runs) {
  const Film &film = at.film;
  std::vector<std::vector<double>> porosities;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    porosities.emplace_back();
    for (const bank::PressedFilm &run : runs[d])
      porosities.back().push_back(emulated_load(bank, draws[d], film, run.pressure));
  }
  const std::vector<double> pressures = pressures_of_curves(bank);
  const FilmCurves curves = curves_at(pressures, [&](FilmNumber number) {
    return emulated_and_missed(bank, c, draws, {film, number, pressures});
  });
  add_met(curves, porosities, at);
  const auto add_run = [&](FilmNumber number, Predictions &to, std::size_t d, std::size_t k) {
    const bank::PressedFilm &run = runs[d][k];
    const double of_run =
        number == FilmNumber::Springback // from the gap: the porosity left follows
            ? at.solid / (at.gaps[k] * (1.0 - run.porosity_after)) - 1.0
            : bank::value_of(number, run);
    if (!to.empty())
      to[d][k].mean += of_run - emulated(bank, draws[d], film, number, run.pressure);
  };
  for (std::size_t d = 0; d < draws.size(); ++d)
    for (std::size_t k = 0; k < at.gaps.size(); ++k) {
      add_run(FilmNumber::Springback, at.springback, d, k);
      add_run(FilmNumber::Cracked, at.cracked, d, k);
      add_run(FilmNumber::Broken, at.broken, d, k);
      add_run(FilmNumber::InverseTortuosity, at.inverse_tortuosity, d, k);
    }
  const double share = 1.0 / double(draws.size());
  for (std::size_t k = 0; k < at.gaps.size(); ++k) { // no emulator says what these take
    double below = 0.0, above = 0.0;
    for (const std::vector<bank::PressedFilm> &of : runs) {
      below += of[k].pressure < at.lowest ? share : 0.0;
      above += of[k].pressure > at.highest ? share : 0.0;
    }
    at.below[k] = std::max(at.below[k], below);
    at.above[k] = std::max(at.above[k], above);
  }
  at.runs = int(draws.size());
  for (Predictions *of : {&at.broken, &at.inverse_tortuosity})
    if (!known(*of))
      of->clear();
  return at;
}

GapDraws runs_at_gaps(const FilmBank &bank, const Calibration &c, const Recipe &recipe,
                      int material, const std::vector<double> &gaps, int passes, int runs,
                      const StudyOptions &options) {
  Film film = bank.described(recipe);
  film.material = material;
  const GapDraws at = gaps_of(bank, film, gaps);
  const std::vector<Draw> draws = some_draws(bank, c, recipe, material, runs);
  const OwnRuns own =
      made(own_runs_at_gaps(bank, draws, recipe, material, gaps, passes), draws, options);
  return from_runs_at_gaps(bank, c, at, own.draws, own.runs);
}

namespace {

std::vector<const Datum *> porosities_of(const Calibration &c, int film) {
  std::vector<const Datum *> out;
  for (const Datum &d : c.data)
    if (d.film == film && d.number == FilmNumber::PorosityAfter)
      out.push_back(&d);
  std::stable_sort(out.begin(), out.end(),
                   [](const Datum *a, const Datum *b) { return a->pressure < b->pressure; });
  return out;
}

Confirmed confirmed_at(const FilmBank &bank, const Film &film, const Datum &datum,
                       const OwnRuns &own, std::size_t pressure) {
  Confirmed out = {film.name, datum.pressure, datum.measured, datum.sd, int(own.draws.size())};
  out.low = 1.0;
  double squares = 0.0;
  const auto n = double(own.draws.size());
  for (std::size_t k = 0; k < own.draws.size(); ++k) {
    const double run = own.runs[k][pressure].porosity_after;
    const double emulated =
        bank.at(bank.at_pressures(FilmNumber::PorosityAfter, film, own.draws[k].of(film)),
                datum.pressure)
            .mean;
    out.mean += run / n;
    out.emulated += emulated / n;
    out.low = std::min(out.low, run);
    out.high = std::max(out.high, run);
    squares += (run - emulated) * (run - emulated);
  }
  const double off = out.mean - out.emulated;
  out.error = std::sqrt(std::max(0.0, squares / n - off * off) / (n - 1.0));
  return out;
}

} // namespace

std::vector<Confirmed> confirmed_by_runs(const FilmBank &bank, const Calibration &c, int film,
                                         const Recipe &recipe, int runs,
                                         const StudyOptions &options) {
  const std::vector<const Datum *> data = porosities_of(c, film);
  std::vector<double> pressures;
  for (const Datum *d : data)
    if (pressures.empty() || d->pressure > pressures.back())
      pressures.push_back(d->pressure);
  std::vector<Confirmed> out;
  if (data.empty())
    return out;
  const Film &of = c.films[std::size_t(film)];
  const std::vector<Draw> draws = some_draws(bank, c, recipe, of.material, runs);
  const OwnRuns own = made(own_runs(bank, draws, recipe, of.material, pressures), draws, options);
  for (const Datum *d : data)
    out.push_back(
        confirmed_at(bank, of, *d, own,
                     std::size_t(std::find(pressures.begin(), pressures.end(), d->pressure) -
                                 pressures.begin())));
  return out;
}

} // namespace calendem
