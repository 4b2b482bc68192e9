// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/diffusion.h"
#include "base/messages.h"
#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
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

Matrix coarser(const Eigen::Ref<const Matrix> &fine, const std::vector<int> &parent, int unknowns) {
  Matrix collect(fine.rows(), unknowns);
  collect.reserve(Eigen::VectorXi::Constant(fine.rows(), 1));
  for (int i = 0; i < fine.rows(); ++i)
    collect.insert(i, parent[i]) = 1.0;
  const Matrix half = fine * collect;
  return (Matrix(collect.transpose()) * half) / kEnlarged;
}

void smooth_row(const Eigen::Ref<const Matrix> &a, const Eigen::VectorXd &right, Eigen::VectorXd &u,
                int i) {
  double sum = right[i], diagonal = 1.0;
  for (Eigen::Ref<const Matrix>::InnerIterator e(a, i); e; ++e)
    if (e.col() == i)
      diagonal = e.value();
    else
      sum -= e.value() * u[e.col()];
  u[i] = sum / diagonal;
}

} // namespace

Multigrid &Multigrid::compute(const Eigen::Ref<const Matrix> &matrix) {
  finest_.emplace(matrix);
  levels_.clear();
  levels_.emplace_back();
  for (size_t at = 0; matrix_of(at).rows() > kFewest; ++at) {
    std::vector<int> parent = aggregate(places_);
    const int unknowns = int(places_.size());
    if (unknowns == matrix_of(at).rows())
      break;
    Matrix next = coarser(matrix_of(at), parent, unknowns);
    levels_.back().parent = std::move(parent);
    levels_.emplace_back();
    levels_.back().matrix.swap(next);
  }
  Eigen::SparseMatrix<double> last = matrix_of(levels_.size() - 1);
  for (int i = 0; i < last.rows(); ++i)
    last.coeffRef(i, i) *= 1.0 + kAlmostNothing;
  coarsest_.compute(last);
  return *this;
}

void Multigrid::cycle(size_t level, const Eigen::VectorXd &right, Eigen::VectorXd &u) const {
  const Level &at = levels_[level];
  const View matrix = matrix_of(level);
  const int n = int(matrix.rows());
  if (at.parent.empty()) {
    u = coarsest_.solve(right);
    return;
  }
  const int visits = level == 0 || level + 2 >= levels_.size() ? 1 : 2;
  for (int visit = 0; visit < visits; ++visit) {
    for (int i = 0; i < n; ++i)
      smooth_row(matrix, right, u, i);
    const Eigen::VectorXd rest = right - matrix * u;
    Eigen::VectorXd coarse = Eigen::VectorXd::Zero(levels_[level + 1].matrix.rows());
    Eigen::VectorXd correction = coarse;
    for (int i = 0; i < n; ++i)
      coarse[at.parent[i]] += rest[i];
    cycle(level + 1, coarse, correction);
    for (int i = 0; i < n; ++i)
      u[i] += correction[at.parent[i]];
    for (int i = n; i-- > 0;)
      smooth_row(matrix, right, u, i);
  }
}

Eigen::VectorXd Multigrid::solve(const Eigen::VectorXd &right) const {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(right.size());
  cycle(0, right, u);
  return u;
}

namespace {

constexpr int kMostUnknowns = 20000000; // about 10 GB
constexpr double kTolerance = 1e-6;

/// A face between two unknowns, or between one and a held end (j < 0).
struct Face {
  int i, j;
  double conductance; ///< area/distance x diffusivity [um]
  double drop;        ///< of the mean field from i to j, for a gradient of 1 [um]
};

class Problem {
public:
  Problem(const DiffusionGrid &grid, int axis, const std::vector<char> &on_path)
      : grid_(grid), axis_(axis), unknown_(on_path.size(), -1) {
    for (size_t v = 0; v < on_path.size(); ++v)
      if (on_path[v]) {
        unknown_[v] = int(places_.size());
        places_.push_back(place(v));
      }
  }
  int unknowns() const { return int(places_.size()); }
  const std::vector<std::array<int, 3>> &places() const { return places_; }

  template <class Visit> void each_face(Visit visit) const {
    for (size_t v = 0; v < unknown_.size(); ++v)
      if (unknown_[v] >= 0)
        for (int a = 0; a < 3; ++a)
          faces_of(v, place(v)[a], a, visit);
  }

private:
  const DiffusionGrid &grid_;
  int axis_;
  std::vector<int> unknown_;
  std::vector<std::array<int, 3>> places_;

  std::array<int, 3> place(size_t v) const {
    const size_t row = v / grid_.n[0];
    return {int(v % grid_.n[0]), int(row % grid_.n[1]), int(row / grid_.n[1])};
  }
  // The face above the voxel along axis a, and the held ends; `at` is its place along a.
  template <class Visit> void faces_of(size_t v, int at, int a, Visit visit) const {
    const double size = grid_.voxel[a], factor = grid_.voxel.prod() / (size * size);
    const double d = grid_.diffusivity[v];
    const bool round = grid_.periodic && a < 2, last = at + 1 == grid_.n[a];
    const bool held = a == axis_ && !round;
    if (held && at == 0)
      visit(Face{unknown_[v], -1, 2.0 * factor * d, -0.5 * size});
    if (held && last)
      visit(Face{unknown_[v], -1, 2.0 * factor * d, 0.5 * size});
    if (last && !round)
      return;
    const size_t step = a == 0 ? 1 : a == 1 ? size_t(grid_.n[0]) : size_t(grid_.n[0]) * grid_.n[1];
    const size_t w = last ? v - step * size_t(grid_.n[a] - 1) : v + step;
    const double e = grid_.diffusivity[w];
    if (unknown_[w] >= 0)
      visit(
          Face{unknown_[v], unknown_[w], factor * 2.0 * d * e / (d + e), a == axis_ ? size : 0.0});
  }
};

// c = mean field + u, u = 0 at held ends: div(D grad u) = -div(D grad(mean field)).
void assemble(const Problem &problem, Multigrid::Matrix &matrix, Eigen::VectorXd &right) {
  matrix.resize(problem.unknowns(), problem.unknowns());
  matrix.reserve(Eigen::VectorXi::Constant(problem.unknowns(), 7));
  right = Eigen::VectorXd::Zero(problem.unknowns());
  problem.each_face([&](const Face &f) {
    if (f.i == f.j) // an image one voxel wide is its own neighbour
      return;
    matrix.coeffRef(f.i, f.i) += f.conductance;
    right[f.i] += f.conductance * f.drop;
    if (f.j < 0)
      return;
    matrix.coeffRef(f.j, f.j) += f.conductance;
    right[f.j] -= f.conductance * f.drop;
    matrix.coeffRef(f.i, f.j) -= f.conductance;
    matrix.coeffRef(f.j, f.i) -= f.conductance;
  });
  matrix.makeCompressed();
}

Eigen::VectorXd solve(const Problem &problem, const DiffusionGrid &grid, Diffusion &out) {
  Multigrid::Matrix matrix;
  Eigen::VectorXd right;
  assemble(problem, matrix, right);
  if (right.norm() < 1e-12 * grid.voxel.prod()) // straight channels
    return Eigen::VectorXd::Zero(problem.unknowns());
  Eigen::ConjugateGradient<Multigrid::Matrix, Eigen::Lower | Eigen::Upper, Multigrid> solver;
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(1000);
  solver.preconditioner().set_places(problem.places());
  solver.compute(matrix);
  Eigen::VectorXd u = solver.solve(right);
  out.iterations = int(solver.iterations());
  out.residual = solver.error();
  if (solver.info() != Eigen::Success)
    throw Failure(kCheckFailed,
                  fmt::format("diffusion did not converge: residual {:.1e} after {} iterations, "
                              "{:.0e} is required. Please report this with the structure.",
                              out.residual, out.iterations, kTolerance));
  return u;
}

double energy(const Problem &problem, const Eigen::VectorXd &u) {
  double sum = 0.0;
  problem.each_face([&](const Face &f) {
    const double drop = (f.j < 0 ? 0.0 : u[f.j]) - u[f.i] + f.drop;
    sum += f.conductance * drop * drop;
  });
  return sum;
}

} // namespace

DiffusionGrid pore_space(const PhaseImage &image) {
  DiffusionGrid grid{image.n, image.voxel, image.periodic, {}};
  grid.diffusivity.reserve(image.label.size());
  for (size_t v = 0; v < image.label.size(); ++v)
    grid.diffusivity.push_back(image.phase(v) == VoxelPhase::pore ? 1.0F : 0.0F);
  return grid;
}

Diffusion diffusion(const DiffusionGrid &grid, int axis) {
  Diffusion out;
  const double voxels = double(grid.diffusivity.size());
  const double open = double(std::count_if(grid.diffusivity.begin(), grid.diffusivity.end(),
                                           [](float d) { return d > 0.0F; }));
  const std::vector<char> paths = on_paths(grid, axis);
  const double on_path = double(std::count(paths.begin(), paths.end(), 1));
  out.open = open / voxels;
  if (on_path == 0.0)
    return out;
  if (on_path > kMostUnknowns)
    throw Failure(kBadInput,
                  fmt::format("diffusion on {} voxels; allowed are {}. Take larger ones.", on_path,
                              kMostUnknowns));
  out.percolating = on_path / open;
  const Problem problem(grid, axis, paths);
  const Eigen::VectorXd u = solve(problem, grid, out);
  out.effective = energy(problem, u) / (grid.voxel.prod() * voxels);
  return out;
}

Tortuosity tortuosity(const PhaseImage &whole, int axis) {
  constexpr double kMostPores = 1.2e7;
  const double pores = phase_fractions(whole).pore * double(whole.label.size());
  Tortuosity t;
  t.stride = std::max(1, int(std::ceil(std::cbrt(pores / kMostPores) - 1e-9)));
  const PhaseImage image = every_nth(whole, t.stride);
  t.voxel = image.voxel;
  const Diffusion fine = diffusion(pore_space(image), axis);
  const Diffusion doubled = diffusion(pore_space(every_nth(image, 2)), axis);
  t.on_voxels = fine.effective;
  t.on_doubled = doubled.effective;
  t.porosity = fine.open;
  t.percolating = fine.percolating;
  const double extrapolated =
      doubled.effective > 0.0 ? 2.0 * fine.effective - doubled.effective * fine.open / doubled.open
                              : 0.0;
  t.extrapolated = extrapolated > 0.0;
  t.effective = t.extrapolated ? extrapolated : fine.effective;
  t.tau = t.effective > 0.0 ? t.porosity / t.effective : INFINITY;
  return t;
}

// Which open voxels lie on a path through the image. VTK's filter of connected parts knows no
// periodic faces.

namespace {

class Walk {
public:
  Walk(const DiffusionGrid &grid, int axis)
      : grid_(grid), axis_(axis), step_{1, size_t(grid.n[0]), size_t(grid.n[0]) * grid.n[1]} {}

  int place(size_t v, int axis) const { return int(v / step_[axis] % grid_.n[axis]); }

  /// Voxel at the side -1 or 1 along an axis. `turns`: +-1 if that crosses the periodic face of the
  /// axis of the walk. False if there is none.
  bool next(size_t v, int axis, int side, size_t &w, int &turns) const {
    const int at = place(v, axis) + side;
    turns = 0;
    w = v + size_t(side) * step_[axis];
    if (at >= 0 && at < grid_.n[axis])
      return true;
    if (!grid_.periodic || axis == 2)
      return false;
    w -= size_t(side) * step_[axis] * size_t(grid_.n[axis]);
    turns = axis == axis_ ? side : 0;
    return true;
  }

  /// All open voxels connected to those of the first or last layer, without the periodic face.
  std::vector<char> from_end(int layer) const {
    std::vector<char> reached(grid_.diffusivity.size(), 0);
    std::vector<size_t> front;
    for (size_t v = 0; v < reached.size(); ++v)
      if (place(v, axis_) == layer && grid_.diffusivity[v] > 0.0F) {
        reached[v] = 1;
        front.push_back(v);
      }
    while (!front.empty()) {
      const size_t v = front.back();
      front.pop_back();
      each_open_neighbour(v, [&](size_t w, int) {
        if (!reached[w]) {
          reached[w] = 1;
          front.push_back(w);
        }
      });
    }
    return reached;
  }

  /// Visits the part that holds `start`; true if it meets itself in another cell along the axis.
  bool meets_itself(size_t start, std::vector<int> &turn, std::vector<size_t> &part) const {
    bool meets = false;
    turn[start] = 0;
    part = {start};
    for (size_t p = 0; p < part.size(); ++p) {
      const size_t v = part[p];
      each_open_neighbour(v, [&](size_t w, int turns) {
        if (turn[w] == kUnseen) {
          turn[w] = turn[v] + turns;
          part.push_back(w);
        } else if (turn[w] != turn[v] + turns)
          meets = true;
      });
    }
    return meets;
  }

  static constexpr int kUnseen = std::numeric_limits<int>::min();

private:
  const DiffusionGrid &grid_;
  int axis_;
  size_t step_[3];

  template <class Visit> void each_open_neighbour(size_t v, Visit visit) const {
    size_t w = 0;
    int turns = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int side : {-1, 1})
        if (next(v, axis, side, w, turns) && grid_.diffusivity[w] > 0.0F)
          visit(w, turns);
  }
};

} // namespace

std::vector<char> on_paths(const DiffusionGrid &grid, int axis) {
  const Walk walk(grid, axis);
  if (!grid.periodic || axis == 2) {
    std::vector<char> from_first = walk.from_end(0);
    const std::vector<char> from_last = walk.from_end(grid.n[axis] - 1);
    for (size_t v = 0; v < from_first.size(); ++v)
      from_first[v] = char(from_first[v] & from_last[v]);
    return from_first;
  }
  std::vector<char> out(grid.diffusivity.size(), 0);
  std::vector<int> turn(out.size(), Walk::kUnseen);
  std::vector<size_t> part;
  for (size_t v = 0; v < out.size(); ++v)
    if (grid.diffusivity[v] > 0.0F && turn[v] == Walk::kUnseen && walk.meets_itself(v, turn, part))
      for (const size_t w : part)
        out[w] = 1;
  return out;
}

} // namespace calendem
