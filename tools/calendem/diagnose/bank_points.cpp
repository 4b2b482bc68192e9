// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/bank_points.h"
#include "base/registry.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace calendem {

using inference::Vector;

const BankRow *run_to(const PressedTo &wanted, const PointRuns &runs) {
  for (const BankRow *row : runs)
    if (row->run.pressing == wanted.pressing && same_pressure(row->run.target, wanted.pressure))
      return row;
  return nullptr;
}

std::optional<SimulatedRun> run_at(const PointRuns &runs, const CoveredCondition &c,
                                   const Shows &see) {
  if (c.runs.empty())
    return std::nullopt;
  const std::string &pressing = c.condition.pressing;
  const BankRow *lower = run_to({c.runs.front(), pressing}, runs),
                *upper = run_to({c.runs.back(), pressing}, runs);
  if (!lower || !upper)
    return std::nullopt;
  return see(lower == upper ? lower->run : between_runs(lower->run, upper->run, c.pressure));
}

std::vector<double> pressures_of(const std::string &effect, const BankTable &table,
                                 const std::string &pressing) {
  std::vector<double> out;
  for (const BankRow &row : table.rows)
    if (row.point.effect == effect && row.run.pressing == pressing)
      out.push_back(row.run.target);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end(), same_pressure), out.end());
  return out;
}

SimulatedRun as_it_is(const SimulatedRun &run) { return run; }

namespace {

/// By effect and number of the base point.
using Points = std::map<std::pair<std::string, int>, PointRuns>;

Points points_of_cell(const BankTable &table) {
  Points points;
  for (const BankRow &row : table.rows)
    if (row.point.effect != kFullCell)
      points[{row.point.effect, row.point.base_point}].push_back(&row);
  for (auto &[key, runs] : points)
    std::sort(runs.begin(), runs.end(),
              [](const BankRow *a, const BankRow *b) { return a->run.target < b->run.target; });
  return points;
}

bool went_to(const PressedTo &wanted, const Points &points, const std::string &effect,
             int base_point) {
  const auto at = points.find({effect, base_point});
  return at != points.end() && run_to(wanted, at->second);
}

/// Points of each effect, and of the base model, that went there beside a base point that did.
std::map<std::string, int> count_to(const PressedTo &wanted, const Points &points) {
  std::map<std::string, int> count;
  for (const auto &[key, runs] : points)
    count[key.first] += run_to(wanted, runs) && went_to(wanted, points, "", key.second);
  return count;
}

} // namespace

std::vector<double> pressures_learnt(const BankTable &table, bool with_effects,
                                     const std::string &pressing) {
  const Points points = points_of_cell(table);
  const std::vector<double> pressures = pressures_of("", table, pressing);
  std::map<std::string, int> most;
  for (const double p : pressures)
    for (const auto &[effect, n] : count_to({p, pressing}, points))
      most[effect] = std::max(most[effect], n);
  std::vector<double> out;
  for (const double p : pressures) {
    const auto count = count_to({p, pressing}, points);
    const bool enough = std::all_of(count.begin(), count.end(), [&](const auto &of) {
      const int fewest =
          inference::kFewestRuns + (of.first.empty() ? int(table.spec.parameters.size()) : 0);
      return of.second >= std::min(fewest, most[of.first]) || (!of.first.empty() && !with_effects);
    });
    if (enough)
      out.push_back(p);
  }
  return out;
}

std::vector<double> beside(double pressure, const std::vector<double> &pressures) {
  for (const double p : pressures)
    if (same_pressure(pressure, p))
      return {p};
  for (std::size_t k = 1; k < pressures.size(); ++k)
    if (pressures[k - 1] < pressure && pressure < pressures[k])
      return {pressures[k - 1], pressures[k]};
  return {};
}

std::vector<PressedTo> runs_for(const std::vector<CoveredCondition> &all) {
  std::set<std::pair<std::string, double>> runs;
  for (const CoveredCondition &c : all)
    for (const double pressure : c.runs)
      runs.emplace(c.condition.pressing, pressure);
  std::vector<PressedTo> out;
  for (const auto &[pressing, pressure] : runs)
    out.push_back({pressure, pressing});
  return out;
}

std::vector<PointRuns> points_of(const BankTable &table, const std::vector<PressedTo> &wanted,
                                 std::vector<std::string> &not_said) {
  const Points points = points_of_cell(table);
  std::vector<PointRuns> out;
  for (const auto &[key, runs] : points)
    if (std::all_of(wanted.begin(), wanted.end(), [&, &of = key](const PressedTo &to) {
          return went_to(to, points, of.first, of.second) && went_to(to, points, "", of.second);
        }))
      out.push_back(runs);
  if (out.size() < points.size()) {
    std::vector<std::string> names;
    for (const PressedTo &to : wanted)
      names.push_back(fmt::format("{:g} MPa{}", to.pressure,
                                  to.pressing.empty() ? "" : " (" + to.pressing + ")"));
    not_said.push_back(fmt::format("{} of the bank's {} points lack a run to {}, or their base "
                                   "point does, and are left out.",
                                   points.size() - out.size(), points.size(),
                                   fmt::join(names, " or ")));
  }
  return out;
}

Vector values_of(const std::vector<CoveredCondition> &all, const PointRuns &runs,
                 const Shows &see) {
  std::vector<double> values;
  for (const CoveredCondition &c : all) {
    const std::optional<SimulatedRun> run = run_at(runs, c, see);
    for (const Observable &o : c.observables)
      values.push_back(run ? o.simulated(*run) : NAN);
  }
  return Eigen::Map<Vector>(values.data(), Eigen::Index(values.size()));
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
          const std::optional<SimulatedRun> run = run_at(runs, c, as_it_is);
          const double slope = run ? derivative(*run) : NAN;
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
    const Vector values = values_of({covered}, p, as_it_is);
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
    const Vector values = values_of({c}, p, as_it_is);
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
    const std::vector<PointRuns> points = points_of(table, runs_for({c}), reported);
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

} // namespace calendem
