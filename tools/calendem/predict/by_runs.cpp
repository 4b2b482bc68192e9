// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/by_runs.h"
#include "base/child.h"
#include "base/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {
namespace {

double four_digits(double value) { return std::stod(fmt::format("{:.4g}", value)); }

/// The draws all of whose runs are usable, and these: draws x pressures.
struct OwnRuns {
  std::vector<Draw> draws;
  std::vector<std::vector<SimulatedRun>> runs;
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
      out.runs.back().push_back(read_simulated_run(*folder));
  }
  return out;
}

void make(const Study &study, const StudyOptions &options) {
  try {
    make_study(study, options);
  } catch (const Failure &f) {
    if (f.exit_status() == kBadInput || stop_requested() != 0)
      throw;
    fmt::print("predict: {}\nDraws with such runs are left out.\n", f.what());
  }
}

} // namespace

std::vector<Draw> some_draws(const Calibration &c, int runs) {
  std::vector<Draw> out;
  for (int k = 0; k < runs; ++k)
    out.push_back(c.draws[std::size_t((k + 0.5) / runs * double(c.draws.size()))]);
  return out;
}

Study own_runs(const FilmBank &bank, const std::vector<Draw> &draws, const Recipe &recipe,
               const std::vector<double> &pressures) {
  BankSpec spec = bank.spec();
  spec.name = recipe.settings.text("name") + ", by runs";
  spec.recipe_file = recipe.file;
  spec.pressures = pressures;
  std::vector<BankParameter> of_material;
  for (const BankParameter &p : spec.parameters)
    if (p.keys.front().rfind("case.", 0) == 0)
      of_material.push_back(p);
  spec.parameters = of_material;
  std::vector<BankPoint> points;
  for (const Draw &draw : draws) {
    BankPoint p;
    p.packing = int(points.size()) + 1;
    for (const double value : draw.material.parameters)
      p.base.push_back(four_digits(value));
    if (draw.material.effect >= 0) {
      p.effect = bank.effects()[std::size_t(draw.material.effect)].name;
      p.value = four_digits(key_value(bank, draw.material));
    }
    points.push_back(p);
  }
  return bank_study(spec, points);
}

ByRuns by_runs(const FilmBank &bank, const Calibration &c, const Recipe &recipe,
               const std::vector<double> &pressures, int runs, const StudyOptions &options) {
  const std::vector<Draw> draws = some_draws(c, runs);
  const Study study = own_runs(bank, draws, recipe, pressures);
  make(study, options);
  const OwnRuns own = usable(draws, finished_runs(study, options));
  if (int(own.draws.size()) < kFewestOwnRuns)
    throw Failure(kSimulationFailed,
                  fmt::format("{}: {} of {} draws have all their runs, {} are needed; see {}/runs.",
                              recipe.file, own.draws.size(), runs, kFewestOwnRuns, options.folder));
  const Film film = bank.described(recipe);
  std::map<FilmNumber, Guesses> all;
  for (const FilmNumber number : {FilmNumber::PorosityAfter, FilmNumber::Springback,
                                  FilmNumber::Cracked, FilmNumber::LogModulus})
    for (std::size_t d = 0; d < own.draws.size(); ++d) {
      std::vector<Guess> row = missed_given_data(bank, c, own.draws[d], {film, number, pressures});
      for (std::size_t k = 0; k < pressures.size(); ++k)
        row[k].mean += value_of(number, own.runs[d][k]);
      if (std::all_of(row.begin(), row.end(), [](const Guess &g) { return std::isfinite(g.mean); }))
        all[number].push_back(row); // a release may lack the rows of the modulus
    }
  for (const auto number : {FilmNumber::PorosityAfter, FilmNumber::LogModulus})
    if (all[number].empty())
      throw Failure(kSimulationFailed,
                    fmt::format("{}: no run says what is predicted; see {}/runs.", recipe.file,
                                options.folder));
  ByRuns out;
  out.of = [all](FilmNumber number) { return all.at(number); };
  out.predicted = predicted_from(film, pressures, out.of);
  out.predicted.runs = int(own.draws.size());
  return out;
}

} // namespace calendem
