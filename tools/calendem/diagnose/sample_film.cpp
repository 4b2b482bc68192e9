// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/sample_film.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {

using inference::Matrix;
using inference::Vector;

namespace {

/// Runs of the base model and of the full cell, by base point and then effect.
std::map<int, std::map<std::string, PointRuns>> runs_of_both(const BankTable &bank) {
  std::map<int, std::map<std::string, PointRuns>> out;
  for (const BankRow &row : bank.rows)
    if (row.point.effect.empty() || row.point.effect == kFullCell)
      out[row.point.base_point][row.point.effect].push_back(&row);
  return out;
}

} // namespace

OtherFilm::OtherFilm(const BankTable &bank) : pressures_(pressures_of(kFullCell, bank)) {
  auto both = runs_of_both(bank);
  if (bank.spec.full_cell.other_electrode)
    for (auto &[point, of] : both)
      if (!of[kFullCell].empty() && !of[""].empty())
        pairs_.emplace_back(of[""], of[kFullCell]);
}

SimulatedRun OtherFilm::operator()(const SimulatedRun &run) const {
  if (pairs_.empty())
    return run;
  CoveredCondition at;
  at.pressure = std::clamp(run.target, pressures_.front(), pressures_.back());
  at.runs = beside(at.pressure, pressures_);
  std::vector<std::pair<SimulatedRun, SimulatedRun>> pairs;
  for (const auto &[here, there] : pairs_) {
    const auto a = run_at(here, at, as_it_is), b = run_at(there, at, as_it_is);
    if (a && b)
      pairs.emplace_back(*a, *b);
  }
  return with_mean_change(run, pairs);
}

double film_ratio(const Experiment &experiment, const BankTable &bank) {
  double sum = 0.0;
  int n = 0;
  std::vector<std::string> none_left_out;
  const auto add = [&](const BankRow &row) {
    sum += row.run.solid_column;
    ++n;
  };
  if (bank.spec.full_cell.other_electrode)
    for (const BankRow &row : bank.rows)
      if (row.point.effect == kFullCell)
        add(row);
  if (n == 0)
    for (const PointRuns &runs : points_of(bank, {}, none_left_out))
      if (runs.front()->point.effect.empty())
        add(*runs.front());
  return sum / n / solid_thickness_um(experiment, experiment.recipe.loading);
}

namespace {

/// Sets for one observable the mean of its changes, and what each is off it, so that the sum of
/// their squares is the variance of a further one about the mean.
void set_change(const std::vector<Vector> &changes, Eigen::Index observable, double &mean,
                Matrix &off) {
  double sum = 0.0, n = 0.0;
  for (const Vector &c : changes)
    if (std::isfinite(c[observable])) {
      sum += c[observable];
      n += 1.0;
    }
  mean = n < 2.0 ? NAN : sum / n;
  if (n < 2.0)
    return;
  for (std::size_t k = 0; k < changes.size(); ++k)
    if (const double change = changes[k][observable]; std::isfinite(change))
      off(observable, Eigen::Index(k)) = std::sqrt((1.0 + 1.0 / n) / (n - 1.0)) * (change - mean);
}

} // namespace

FullCellChange full_cell_change(const Experiment &e, const BankTable &bank,
                                const std::vector<CoveredCondition> &all,
                                std::vector<std::string> &not_said) {
  auto runs = runs_of_both(bank);
  const std::vector<double> pressures = pressures_of(kFullCell, bank);
  std::vector<CoveredCondition> here = all;
  std::vector<bool> while_it_rests;
  for (CoveredCondition &c : here) {
    c.runs = beside(c.pressure, pressures);
    c.condition.pressing.clear(); // what the film changes, it changes however it is pressed
    for (const Observable &o : c.observables)
      while_it_rests.push_back(o.stage == kDwell);
  }
  std::vector<Vector> changes;
  for (auto &[point, of] : runs)
    if (!of[kFullCell].empty() && !of[""].empty())
      changes.push_back(values_of(here, of[kFullCell], as_it_is) -
                        values_of(here, of[""], as_it_is));
  if (changes.size() < 2)
    return {};
  const double small = read_recipe(bank.spec.recipe_file).loading,
               full = read_recipe(bank.spec.full_cell.recipe_file).loading;
  const bool other = bank.spec.full_cell.other_electrode;
  if (small == full && !other)
    return {};
  const double share =
      other ? 1.0 : (1.0 / small - 1.0 / e.recipe.loading) / (1.0 / small - 1.0 / full);
  Vector mean = Vector::Zero(changes[0].size());
  Matrix off = Matrix::Zero(mean.size(), Eigen::Index(changes.size()));
  for (Eigen::Index i = 0; i < mean.size() && share != 0.0; ++i)
    if (!while_it_rests[std::size_t(i)])
      set_change(changes, i, mean[i], off);
  if (other)
    not_said.push_back(fmt::format(
        "The bank's runs are of another electrode: shifted by what {} runs of this one differ by; "
        "how well that is known counts as uncertainty. Effects are taken to do the same on both.",
        changes.size()));
  else if (share != 0.0)
    not_said.push_back(fmt::format(
        "The bank's cell carries {:g} mg/cm2, the sample {:g}: its runs are shifted by {:.0f} % of "
        "what {} runs of {:g} mg/cm2 differ by; how well that is known counts as uncertainty.",
        small, e.recipe.loading, 100.0 * share, changes.size(), full));
  return {share * mean, share * share * off * off.transpose()};
}

} // namespace calendem
