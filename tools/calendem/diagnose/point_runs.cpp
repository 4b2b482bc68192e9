// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/point_runs.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {
using inference::Vector;
namespace {

/// The point's run to a condition's pressure; `see` is how its press shows it.
SimulatedRun run_at(const PointRuns &runs, double pressure, const Shows &see) {
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (std::fabs(runs[k]->run.target - pressure) <= 0.02 * pressure)
      return see(runs[k]->run);
  for (std::size_t k = 1; k < runs.size(); ++k)
    if (runs[k]->run.target > pressure)
      return see(between_runs(runs[k - 1]->run, runs[k]->run, pressure));
  return see(runs.back()->run);
}

} // namespace

std::vector<PointRuns> points_of(const BankTable &table, std::vector<std::string> &not_said) {
  std::map<std::pair<std::string, int>, PointRuns> points;
  for (const BankRow &row : table.rows)
    if (row.point.effect != kFullCell)
      points[{row.point.effect, row.point.base_point}].push_back(&row);
  std::vector<PointRuns> out;
  const auto whole = [&](const std::string &effect, int base_point) {
    const auto at = points.find({effect, base_point});
    return at != points.end() && at->second.size() == table.spec.pressures.size();
  };
  for (auto &[key, runs] : points) {
    std::sort(runs.begin(), runs.end(),
              [](const BankRow *a, const BankRow *b) { return a->run.target < b->run.target; });
    if (whole(key.first, key.second) && whole("", key.second))
      out.push_back(runs);
  }
  if (out.size() < points.size())
    not_said.push_back(fmt::format("{} of the bank's {} points lack a run, or that of their base "
                                   "point, and are left out.",
                                   points.size() - out.size(), points.size()));
  return out;
}

Vector values_of(const std::vector<Covered> &all, const PointRuns &runs, const Shows &see) {
  std::vector<double> values;
  for (const Covered &c : all) {
    const SimulatedRun run = run_at(runs, c.pressure, see);
    for (const Observable &o : c.observables)
      values.push_back(o.simulated(run));
  }
  return Eigen::Map<Vector>(values.data(), Eigen::Index(values.size()));
}

double film_ratio(const Experiment &experiment, const BankTable &bank) {
  double sum = 0.0;
  int n = 0;
  for (const BankRow &row : bank.rows)
    if (row.point.effect.empty()) {
      sum += row.run.solid_column;
      ++n;
    }
  return sum / n / solid_thickness_um(experiment, experiment.recipe.loading);
}

Vector by_pressure(const std::vector<Covered> &all, const std::vector<PointRuns> &points) {
  std::vector<double> out;
  for (const Covered &c : all)
    for (const Observable &o : c.observables) {
      double sum = 0.0;
      int n = 0;
      for (const PointRuns &runs : points)
        if (runs.front()->point.effect.empty()) {
          const double slope =
              o.slope(run_at(runs, c.pressure, [](const SimulatedRun &r) { return r; }));
          sum += std::isfinite(slope) ? slope : 0.0; // NaN: the run ends before that pressure
          n += std::isfinite(slope);
        }
      out.push_back(n > 0 ? sum / n * c.condition.max_pressure_MPa->sd : 0.0);
    }
  return Eigen::Map<Vector>(out.data(), Eigen::Index(out.size()));
}

} // namespace calendem
