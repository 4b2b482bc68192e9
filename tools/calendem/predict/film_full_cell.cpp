// SPDX-License-Identifier: GPL-2.0-or-later
// The full cell: what a thicker film on a larger cell differs by from the bank's.
#include "base/messages.h"
#include "predict/film_bank.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace calendem {
namespace {

double mean_of(const std::map<int, double> &changes) {
  double sum = 0.0;
  for (const auto &[point, change] : changes)
    sum += change;
  return sum / double(changes.size());
}

/// About their mean, so that the sum of their squares is the variance of a further one about it.
std::vector<double> off_of(const std::map<int, double> &changes, const std::set<int> &points) {
  const double n = double(changes.size()), mean = mean_of(changes),
               factor = std::sqrt((1.0 + 1.0 / n) / (n - 1.0));
  std::vector<double> out;
  for (const int point : points) {
    const auto at = changes.find(point);
    out.push_back(at == changes.end() ? 0.0 : factor * (at->second - mean));
  }
  return out;
}

} // namespace

/// What runs on the full cell differ by from the emulators, for the film that they are of. The
/// modulus differs as at the next pressure where the release left too few rows to read it.
void FilmBank::learn_full_cell(const BankTable &table) {
  const auto pressure_of = [&](const BankRow &row) {
    return std::find(spec_.pressures.begin(), spec_.pressures.end(), row.run.target);
  };
  std::vector<const BankRow *> rows;
  for (const BankRow &row : table.rows)
    if (row.point.effect == kFullCell && pressure_of(row) != spec_.pressures.end())
      rows.push_back(&row);
  if (rows.empty())
    return;
  if (spec_.full_cell.other_electrode)
    throw Failure(kBadInput, fmt::format("{}: a bank that stands for another electrode is for "
                                         "diagnose. To predict, make one of that electrode.",
                                         spec_.file));
  const Recipe recipe = read_recipe(spec_.full_cell.recipe_file);
  const Film film = film_of(recipe);
  for (int number = 0; number < kByBase; ++number) {
    if (!knows(FilmNumber(number)))
      continue;
    std::vector<std::map<int, double>> changes(spec_.pressures.size()); // by base point
    std::set<int> points;
    for (const BankRow *row : rows) {
      Material material;
      for (std::size_t k = 0; k < of_film_.size(); ++k)
        if (!of_film_[k])
          material.parameters.push_back(row->point.base[k]);
      material.parameters.resize(material_.size(), 0.0); // of the recipe's nanoporosity
      const auto p = std::size_t(pressure_of(*row) - spec_.pressures.begin());
      const double change = value_of(FilmNumber(number), row->run) -
                            at_pressures(FilmNumber(number), film, material).at(p).mean;
      if (std::isfinite(change))
        changes[p][*points.insert(row->point.base_point).first] = change;
    }
    const auto few = [](const std::map<int, double> &of) { return of.size() < 2; };
    if (may_be_missing(FilmNumber(number)) && std::any_of(changes.begin(), changes.end(), few)) {
      forget(FilmNumber(number));
      continue;
    }
    for (std::size_t p = 0; p < changes.size(); ++p) {
      const auto known = number == int(FilmNumber::LogModulus)
                             ? std::find_if_not(changes.begin() + long(p), changes.end(), few)
                             : changes.begin() + long(p);
      if (known == changes.end() || few(*known))
        throw Failure(kBadInput,
                      fmt::format("{}: {} of the runs on the full cell are usable at {:g} MPa; at "
                                  "least 2 are needed, or a bank without [full_cell].",
                                  spec_.file, changes[p].size(), spec_.pressures[p]));
      full_cell_[std::size_t(number)].change.push_back(mean_of(*known));
      full_cell_[std::size_t(number)].off.push_back(off_of(*known, points));
    }
  }
  full_loading_ = recipe.loading;
}

// A film's faces weigh by 1 / loading: no change on the bank's film, all of it on the full cell's.
double FilmBank::full_cell_share(const Film &film) const {
  return full_loading_ > 0.0
             ? (1.0 - recipe_.loading / film.loading) / (1.0 - recipe_.loading / full_loading_)
             : 0.0;
}

std::vector<double> FilmBank::full_cell_errors(FilmNumber number, const Film &film,
                                               double pressure) const {
  const std::vector<std::vector<double>> &off = full_cell_[std::size_t(number)].off;
  if (full_loading_ <= 0.0 || off.empty())
    return {};
  const std::vector<double> &bank = spec_.pressures;
  const double at = std::clamp(pressure, bank.front(), bank.back());
  std::size_t right = 1;
  while (right + 1 < bank.size() && bank[right] < at)
    ++right;
  const double share = full_cell_share(film),
               along = std::log(at / bank[right - 1]) / std::log(bank[right] / bank[right - 1]);
  std::vector<double> out;
  for (std::size_t k = 0; k < off[right].size(); ++k)
    out.push_back(share * (off[right - 1][k] + along * (off[right][k] - off[right - 1][k])));
  return out;
}

} // namespace calendem
