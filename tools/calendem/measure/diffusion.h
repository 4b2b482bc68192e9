// SPDX-License-Identifier: GPL-2.0-or-later
// Steady diffusion through voxels and the tortuosity factor of the pores. The preconditioner is ours:
// Eigen has none whose work grows with the voxels only.
#ifndef CALENDEM_MEASURE_DIFFUSION_H
#define CALENDEM_MEASURE_DIFFUSION_H

#include "measure/phases.h"
#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <optional>
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

  /// Place of every unknown, in cells; set before `compute`, which uses them up. The matrix given to
  /// `compute` is not copied.
  void set_places(std::vector<std::array<int, 3>> places) { places_ = std::move(places); }
  Multigrid &compute(const Eigen::Ref<const Matrix> &matrix);
  // Eigen's solver calls these instead of compute().
  Multigrid &analyzePattern(const Eigen::Ref<const Matrix> &) { return *this; }
  Multigrid &factorize(const Eigen::Ref<const Matrix> &matrix) { return compute(matrix); }
  Eigen::ComputationInfo info() const { return Eigen::Success; }
  Eigen::VectorXd solve(const Eigen::VectorXd &right) const;

private:
  using View = Eigen::Ref<const Matrix>;
  struct Level {
    Matrix matrix;           ///< empty on the first, which views the matrix itself
    std::vector<int> parent; ///< unknown of the next level; empty on the last
  };
  std::vector<std::array<int, 3>> places_;
  std::optional<View> finest_;
  std::vector<Level> levels_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> coarsest_;

  View matrix_of(size_t level) const { return level == 0 ? *finest_ : View(levels_[level].matrix); }
  void cycle(size_t level, const Eigen::VectorXd &right, Eigen::VectorXd &u) const;
};

/// Diffusivity of every voxel over that of the free electrolyte; 0 is closed.
struct DiffusionGrid {
  std::array<int, 3> n = {0, 0, 0};
  Eigen::Vector3d voxel = Eigen::Vector3d::Ones(); ///< [um]
  bool periodic = false;                           ///< in x and y
  std::vector<float> diffusivity;                  ///< x runs fastest
};

/// 1 in pores, 0 in AM and CBD: CBD counts as solid.
DiffusionGrid pore_space(const PhaseImage &image);

struct Diffusion {
  double effective = 0.0;   ///< D_eff over the free diffusivity
  double open = 0.0;        ///< share of the voxels that are open
  double percolating = 0.0; ///< share of the open voxels that lie on a path through
  int iterations = 0;
  double residual = 0.0; ///< of the linear system, over its right-hand side
};

/// div(D grad c) = 0 with a mean gradient along `axis` (0, 1, 2), on finite volumes: flux between
/// two voxels by the harmonic mean of their diffusivities. Along z, and along every axis of an
/// image that is not periodic, c is held at both ends; along x and y of a periodic one the
/// structure goes on for ever. No flux through the other sides that are not periodic.
/// Open voxels without a path through carry nothing and are left out; without any path `effective`
/// is 0. Eigen's conjugate gradients; D_eff from the energy of the field, which is exact to second
/// order in the field's error. Throws Failure(2) above 2e7 voxels on paths, Failure(4) if it does
/// not converge.
Diffusion diffusion(const DiffusionGrid &grid, int axis);

/// Marks the open voxels that lie on a path through: connected by faces to both ends, or in the
/// periodic case to their own image in the next cell.
std::vector<char> on_paths(const DiffusionGrid &grid, int axis);

/// Tortuosity factor tau = eps D/D_eff; eps is the macro porosity, dead ends and closed pores
/// included. Infinite where no path leads through.
struct Tortuosity {
  double tau = 0.0;        ///< with `effective`
  double effective = 0.0;  ///< D_eff/D for voxels of size 0
  double on_voxels = 0.0;  ///< ... on the voxels
  double on_doubled = 0.0; ///< ... on voxels of twice the size
  bool extrapolated =
      true;              ///< false: pores are too narrow for doubled voxels; tau is an upper bound
  double porosity = 0.0; ///< on the voxels
  double percolating = 0.0; ///< share of the pores that lie on a path through
  Eigen::Vector3d voxel;    ///< [um]; larger than the image's where that has too many
  int stride = 1;           ///< every so many-th of the image's voxels

  /// What programs without that step give, such as TauFactor.
  double tau_on_voxels() const { return on_voxels > 0.0 ? porosity / on_voxels : INFINITY; }
};

/// The stairs of voxels narrow every pore, so 1/tau is too low by an error that goes with the first
/// power of their size: 1/tau(0) = 2/tau(h) - 1/tau(2h). Errors (test structure.Tortuosity):
/// cubic arrays of spheres of 11 voxels radius up 1.5 % (on the voxels alone 2-5 %); channels of 10
/// voxels tilted against the axes 0.1 %. Narrow pores need smaller voxels: the demo at 150 MPa has
/// 2.48 on 0.15 um and 2.33 on 0.1 um. Above 1.2e7 pore voxels every 2nd, 3rd ... one is taken.
Tortuosity tortuosity(const PhaseImage &image, int axis);

} // namespace calendem

#endif
