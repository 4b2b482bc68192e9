// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/multigrid.h"
#include <algorithm>
#include <numeric>

namespace calendem {
namespace {

using Matrix = Multigrid::Matrix;
using Places = std::vector<std::array<int, 3>>;

constexpr int kFewest = 2000;           // unknowns that are solved directly
constexpr double kEnlarged = 1.8;       // coarse corrections
constexpr double kAlmostNothing = 1e-9; // a part of the pores that no end holds is singular

/// Unknowns in the same 2 x 2 x 2 cells get the same number; `places` become those of the cells.
std::vector<int> aggregate(Places &places) {
  for (auto &p : places)
    p = {p[0] / 2, p[1] / 2, p[2] / 2};
  std::vector<int> order(places.size()), parent(places.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return std::array{places[i][2], places[i][1], places[i][0]}; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  Places cells;
  for (const int i : order) {
    if (cells.empty() || cells.back() != places[i])
      cells.push_back(places[i]);
    parent[i] = int(cells.size()) - 1;
  }
  places = std::move(cells);
  return parent;
}

Matrix coarser(const Matrix &fine, const std::vector<int> &parent, int unknowns) {
  Matrix collect(fine.rows(), unknowns);
  collect.reserve(Eigen::VectorXi::Constant(fine.rows(), 1));
  for (int i = 0; i < fine.rows(); ++i)
    collect.insert(i, parent[i]) = 1.0;
  const Matrix half = fine * collect;
  return (Matrix(collect.transpose()) * half) / kEnlarged;
}

void smooth_row(const Matrix &a, const Eigen::VectorXd &right, Eigen::VectorXd &u, int i) {
  double sum = right[i], diagonal = 1.0;
  for (Matrix::InnerIterator e(a, i); e; ++e)
    if (e.col() == i)
      diagonal = e.value();
    else
      sum -= e.value() * u[e.col()];
  u[i] = sum / diagonal;
}

} // namespace

Multigrid &Multigrid::compute(const Eigen::Ref<const Matrix> &matrix) {
  levels_.clear();
  levels_.emplace_back();
  levels_.back().matrix = matrix;
  while (levels_.back().matrix.rows() > kFewest) {
    std::vector<int> parent = aggregate(places_);
    const int unknowns = int(places_.size());
    if (unknowns == levels_.back().matrix.rows())
      break;
    Matrix next = coarser(levels_.back().matrix, parent, unknowns);
    levels_.back().parent = std::move(parent);
    levels_.emplace_back();
    levels_.back().matrix.swap(next);
  }
  Eigen::SparseMatrix<double> last = levels_.back().matrix;
  for (int i = 0; i < last.rows(); ++i)
    last.coeffRef(i, i) *= 1.0 + kAlmostNothing;
  coarsest_.compute(last);
  return *this;
}

void Multigrid::cycle(size_t level, const Eigen::VectorXd &right, Eigen::VectorXd &u) const {
  const Level &at = levels_[level];
  const int n = int(at.matrix.rows());
  if (at.parent.empty()) {
    u = coarsest_.solve(right);
    return;
  }
  const int visits = level == 0 || level + 2 >= levels_.size() ? 1 : 2;
  for (int visit = 0; visit < visits; ++visit) {
    for (int i = 0; i < n; ++i)
      smooth_row(at.matrix, right, u, i);
    const Eigen::VectorXd rest = right - at.matrix * u;
    Eigen::VectorXd coarse = Eigen::VectorXd::Zero(levels_[level + 1].matrix.rows());
    Eigen::VectorXd correction = coarse;
    for (int i = 0; i < n; ++i)
      coarse[at.parent[i]] += rest[i];
    cycle(level + 1, coarse, correction);
    for (int i = 0; i < n; ++i)
      u[i] += correction[at.parent[i]];
    for (int i = n; i-- > 0;)
      smooth_row(at.matrix, right, u, i);
  }
}

Eigen::VectorXd Multigrid::solve(const Eigen::VectorXd &right) const {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(right.size());
  cycle(0, right, u);
  return u;
}

} // namespace calendem
