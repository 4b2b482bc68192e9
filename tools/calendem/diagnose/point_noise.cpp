// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/point_noise.h"
#include "base/effects.h"
#include "diagnose/covered.h"
#include "diagnose/point_runs.h"
#include <algorithm>

namespace calendem {
using inference::Cholesky;
using inference::Matrix;
using inference::Vector;
namespace {

constexpr std::size_t kFewestRows = 8;

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
Matrix shown_by(const std::vector<PointRuns> &points, const Covered &covered,
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

inference::PointNoise noise_of(const Covered &covered, const std::vector<PointRuns> &points,
                               const Matrix &shown, const BankSpec &spec, double cells) {
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

std::vector<inference::PointNoise> point_noise_of(const Experiment &e, const BankTable &table,
                                                  double cells) {
  std::vector<std::string> told; // with the rest of what the bank lacks
  const std::vector<PointRuns> points = points_of(table, told);
  std::vector<inference::PointNoise> out;
  for (Covered &c : covered_by(e, table, {}, told)) {
    c.observables = release_rows(e, c.condition);
    if (c.observables.size() < kFewestRows)
      continue;
    std::vector<PointRuns> whole;
    const Matrix shown = shown_by(points, c, whole);
    if (whole.size() > c.observables.size())
      out.push_back(noise_of(c, whole, shown, table.spec, cells));
  }
  return out;
}

} // namespace calendem
