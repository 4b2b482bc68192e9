// SPDX-License-Identifier: GPL-2.0-or-later
// Preconditioner for diffusion on voxels: Eigen has none whose work grows with the voxels only.
#ifndef CALENDEM_MEASURE_MULTIGRID_H
#define CALENDEM_MEASURE_MULTIGRID_H

#include <Eigen/SparseCholesky>
#include <array>
#include <vector>

namespace calendem {

/// Multigrid by aggregation: the unknowns of 2 x 2 x 2 cells become one, again and again, until few
/// are left, which are solved directly. One cycle as a preconditioner (symmetric: Gauss-Seidel
/// forwards before, backwards after; two visits of every coarser level) for Eigen's conjugate
/// gradients. Coarse corrections are enlarged by 1.8, because constant pieces are too stiff
/// (Braess, Computing 55 (1995) 379).
class Multigrid {
public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  using StorageIndex = int; // asked for by Eigen
  enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic };

  /// Place of every unknown, in cells; set before `compute`, which uses them up.
  void set_places(std::vector<std::array<int, 3>> places) { places_ = std::move(places); }
  Multigrid &compute(const Eigen::Ref<const Matrix> &matrix);
  // Eigen's solver calls these instead of compute().
  Multigrid &analyzePattern(const Eigen::Ref<const Matrix> &) { return *this; }
  Multigrid &factorize(const Eigen::Ref<const Matrix> &matrix) { return compute(matrix); }
  Eigen::ComputationInfo info() const { return Eigen::Success; }
  Eigen::VectorXd solve(const Eigen::VectorXd &right) const;

private:
  struct Level {
    Matrix matrix;
    std::vector<int> parent; ///< unknown of the next level; empty on the last
  };
  std::vector<std::array<int, 3>> places_;
  std::vector<Level> levels_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> coarsest_;

  void cycle(size_t level, const Eigen::VectorXd &right, Eigen::VectorXd &u) const;
};

} // namespace calendem

#endif
