// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/bank_points.h"
#include "base/registry.h"
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

Vector values_of(const std::vector<CoveredCondition> &all, const PointRuns &runs,
                 const Shows &see) {
  std::vector<double> values;
  for (const CoveredCondition &c : all) {
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

Vector mean_of_base(const std::vector<CoveredCondition> &all, const std::vector<PointRuns> &points,
                    const std::function<const Derivative &(const Observable &)> &of) {
  std::vector<double> out;
  for (const CoveredCondition &c : all)
    for (const Observable &o : c.observables) {
      const Derivative &derivative = of(o);
      double sum = 0.0;
      int n = 0;
      for (const PointRuns &runs : points)
        if (derivative && runs.front()->point.effect.empty()) {
          const double slope =
              derivative(run_at(runs, c.pressure, [](const SimulatedRun &r) { return r; }));
          sum += std::isfinite(slope) ? slope : 0.0; // NaN: the run ends before that pressure
          n += std::isfinite(slope);
        }
      out.push_back(n > 0 ? sum / n : 0.0);
    }
  return Eigen::Map<Vector>(out.data(), Eigen::Index(out.size()));
}

Vector by_pressure(const std::vector<CoveredCondition> &all, const std::vector<PointRuns> &points) {
  Vector out =
      mean_of_base(all, points, [](const Observable &o) -> const Derivative & { return o.slope; });
  Eigen::Index next = 0;
  for (const CoveredCondition &c : all)
    for (std::size_t k = 0; k < c.observables.size(); ++k)
      out[next++] *= c.condition.max_pressure_MPa->sd;
  return out;
}

using inference::Cholesky;
using inference::Matrix;
namespace {

constexpr std::size_t kFewestRows = 8;
constexpr double kRowLacks = 0.1; // of the points may lack a row

/// A row's distance from the line between its neighbours: rows - 2 x rows.
Matrix second_differences(const std::vector<Observable> &rows) {
  const auto n = Eigen::Index(rows.size());
  Matrix d = Matrix::Zero(n - 2, n);
  for (Eigen::Index k = 0; k + 2 < n; ++k) {
    const double left = rows[std::size_t(k)].pressure, right = rows[std::size_t(k + 2)].pressure;
    const double share = (rows[std::size_t(k + 1)].pressure - left) / (right - left);
    d(k, k) = share - 1.0;
    d(k, k + 1) = 1.0;
    d(k, k + 2) = -share;
  }
  return d;
}

/// Base parameters and amplitudes of the effects, a column each, and one of ones: points x columns.
Matrix design_of(const std::vector<PointRuns> &points, const BankSpec &spec) {
  const auto parameters = Eigen::Index(points.front().front()->point.base.size());
  Matrix design =
      Matrix::Zero(Eigen::Index(points.size()), 1 + parameters + Eigen::Index(spec.effects.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const BankPoint &p = points[k].front()->point;
    const auto row = Eigen::Index(k);
    design(row, 0) = 1.0;
    for (Eigen::Index j = 0; j < parameters; ++j)
      design(row, 1 + j) = p.base[std::size_t(j)];
    const auto effect = std::find(spec.effects.begin(), spec.effects.end(), p.effect);
    if (effect != spec.effects.end())
      design(row, 1 + parameters + (effect - spec.effects.begin())) =
          find_effect(p.effect).parameter.amplitude(p.value);
  }
  return design;
}

/// The points that have every row, and what they show there: points x rows.
Matrix shown_by(const std::vector<PointRuns> &points, const CoveredCondition &covered,
                std::vector<PointRuns> &whole) {
  Matrix all(Eigen::Index(points.size()), Eigen::Index(covered.observables.size()));
  for (const PointRuns &p : points) {
    const Vector values = values_of({covered}, p, [](const SimulatedRun &r) { return r; });
    if (!values.allFinite())
      continue;
    all.row(Eigen::Index(whole.size())) = values.transpose();
    whole.push_back(p);
  }
  return all.topRows(Eigen::Index(whole.size()));
}

inference::PointNoise noise_of(const CoveredCondition &covered,
                               const std::vector<PointRuns> &points, const Matrix &shown,
                               const BankSpec &spec, double cells) {
  const auto &rows = covered.observables;
  const Matrix differences = second_differences(rows);
  const Matrix of_bank = shown * differences.transpose();
  const Vector mean = of_bank.colwise().mean();
  const Matrix design = design_of(points, spec);
  const auto solver = design.colPivHouseholderQr();
  const Matrix fitted = design * solver.solve(of_bank), left = of_bank - fitted;
  const Matrix moved = fitted.rowwise() - mean.transpose();
  const double n = double(of_bank.rows()), free = std::max(1.0, n - double(solver.rank()));
  Matrix scatter = left.transpose() * left / free;
  const double k = double(scatter.rows()), shrink = k / (k + free);
  scatter = (1.0 - shrink) * scatter + shrink * Matrix(scatter.diagonal().asDiagonal());
  Vector values(Eigen::Index(rows.size())), variance(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = rows[std::size_t(i)].measured;
    variance[i] = rows[std::size_t(i)].sd * rows[std::size_t(i)].sd;
  }
  const Matrix measured = differences * variance.asDiagonal() * differences.transpose();
  const Matrix all = measured + scatter / cells + moved.transpose() * moved / n;
  const Vector off = differences * values - mean;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> shares(measured, all,
                                                                Eigen::EigenvaluesOnly);
  return {covered.condition.id,
          inference::normal_score(off.dot(Cholesky(all).solve(off)), int(off.size())),
          shares.eigenvalues().cwiseMax(0.0).cwiseMin(1.0)};
}

} // namespace

namespace {

/// Rows that nearly all points reach; the bank's releases begin a little below their maximum.
std::vector<Observable> reached(const std::vector<PointRuns> &points, const CoveredCondition &c) {
  std::vector<int> lacking(c.observables.size(), 0);
  for (const PointRuns &p : points) {
    const Vector values = values_of({c}, p, [](const SimulatedRun &r) { return r; });
    for (std::size_t k = 0; k < lacking.size(); ++k)
      lacking[k] += !std::isfinite(values[Eigen::Index(k)]);
  }
  std::vector<Observable> out;
  for (std::size_t k = 0; k < lacking.size(); ++k)
    if (double(lacking[k]) <= kRowLacks * double(points.size()))
      out.push_back(c.observables[k]);
  return out;
}

} // namespace

std::vector<inference::PointNoise> point_noise_of(const Experiment &e, const BankTable &table,
                                                  double cells,
                                                  std::vector<std::string> &not_said) {
  std::vector<std::string> reported; // with the rest of what the bank lacks
  const std::vector<PointRuns> points = points_of(table, reported);
  std::vector<inference::PointNoise> out;
  for (CoveredCondition &c : covered_conditions(e, table, {}, reported)) {
    c.observables = release_rows(e, c.condition);
    if (c.observables.empty() || !has_release(table))
      continue;
    if (!(c.condition.curve_sd_um > 0.0)) {
      not_said.push_back(fmt::format("{}: without curve_sd_um the scatter of its release says "
                                     "nothing about noise.",
                                     c.condition.id));
      continue;
    }
    const std::size_t given = c.observables.size();
    c.observables = reached(points, c);
    std::vector<PointRuns> whole;
    if (c.observables.size() >= kFewestRows) {
      const Matrix shown = shown_by(points, c, whole);
      if (whole.size() > c.observables.size()) {
        out.push_back(noise_of(c, whole, shown, table.spec, cells));
        continue;
      }
    }
    not_said.push_back(fmt::format(
        "{}: how much its points scatter is not judged: of {} rows of the release the bank's runs "
        "reach {}, {} are needed.",
        c.condition.id, given, c.observables.size(), kFewestRows));
  }
  return out;
}

FullCellChange full_cell_change(const Experiment &e, const BankTable &bank,
                                const std::vector<CoveredCondition> &all,
                                std::vector<std::string> &not_said) {
  std::map<int, std::map<std::string, PointRuns>> runs;
  for (const BankRow &row : bank.rows)
    if (row.point.effect.empty() || row.point.effect == kFullCell)
      runs[row.point.base_point][row.point.effect].push_back(&row);
  const auto as_it_is = [](const SimulatedRun &r) { return r; };
  std::vector<Vector> changes;
  for (auto &[point, of] : runs)
    if (of[kFullCell].size() == bank.spec.pressures.size() && of[kFullCell].size() == of[""].size())
      changes.push_back(values_of(all, of[kFullCell], as_it_is) - values_of(all, of[""], as_it_is));
  if (changes.size() < 2)
    return {};
  const double small = read_recipe(bank.spec.recipe_file).loading,
               full = read_recipe(bank.spec.full_cell.recipe_file).loading;
  const bool other = bank.spec.full_cell.other_electrode;
  if (small == full && !other)
    return {};
  const double share =
      other ? 1.0 : (1.0 / small - 1.0 / e.recipe.loading) / (1.0 / small - 1.0 / full);
  const double n = double(changes.size());
  Matrix d(changes[0].size(), Eigen::Index(changes.size()));
  for (std::size_t k = 0; k < changes.size(); ++k)
    d.col(Eigen::Index(k)) = changes[k];
  const Vector mean = d.rowwise().mean();
  d.colwise() -= mean;
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
  return {share * mean, share * share * (1.0 + 1.0 / n) / (n - 1.0) * d * d.transpose()};
}

} // namespace calendem
