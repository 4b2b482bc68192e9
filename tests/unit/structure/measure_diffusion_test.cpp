// SPDX-License-Identifier: GPL-2.0-or-later
// Diffusion and tortuosity against closed forms.
#include "measure/diffusion.h"
#include "measure_support.h"
#include <Eigen/IterativeLinearSolvers>
#include <random>

namespace {
using namespace calendem;
using namespace calendem_test;

DiffusionGrid grid_of(const PhaseImage &image, float am, float cbd = 0.0F) {
  DiffusionGrid grid = pore_space(image);
  for (size_t v = 0; v < image.label.size(); ++v)
    if (image.phase(v) != VoxelPhase::pore)
      grid.diffusivity[v] = image.phase(v) == VoxelPhase::am ? am : cbd;
  return grid;
}

// Requirement: straight channels, whatever their width, have tau = 1, along every axis and with
// either kind of ends; the walls' direction has no path and tau is infinite.
TEST(Diffusion, StraightChannels) {
  for (const bool periodic : {false, true})
    for (int axis = 0; axis < 3; ++axis) {
      const int b = (axis + 1) % 3;
      const PhaseImage image = phases({12, 12, 12}, periodic, [&](const Eigen::Vector3d &x) {
        return x[b] < 1 || (x[b] > 4 && x[b] < 9) ? 0 : 1;
      });
      const Diffusion along = diffusion(pore_space(image), axis);
      EXPECT_NEAR(along.effective, 0.5, 1e-9) << axis;
      EXPECT_DOUBLE_EQ(along.percolating, 1.0);
      EXPECT_NEAR(tortuosity(image, axis).tau, 1.0, 1e-9);
      const Tortuosity across = tortuosity(image, b);
      EXPECT_EQ(across.tau, INFINITY);
      EXPECT_EQ(across.effective, 0.0);
      EXPECT_DOUBLE_EQ(across.percolating, 0.0);
      EXPECT_NEAR(across.porosity, 0.5, 1e-12);
    }
}

// Requirement: layers of two diffusivities: harmonic mean across them, arithmetic mean along them.
TEST(Diffusion, LayersInSeriesAndInParallel) {
  for (const bool periodic : {false, true})
    for (int axis = 0; axis < 3; ++axis) {
      const PhaseImage image = phases({8, 8, 8}, periodic, [&](const Eigen::Vector3d &x) {
        return x[axis] < 2 || x[axis] > 6 ? 0 : 1;
      });
      const DiffusionGrid grid = grid_of(image, 0.25F);
      EXPECT_NEAR(diffusion(grid, axis).effective, 1.0 / (0.5 / 1 + 0.5 / 0.25), 1e-9) << axis;
      EXPECT_NEAR(diffusion(grid, (axis + 1) % 3).effective, 0.5 * (1 + 0.25), 1e-9) << axis;
    }
}

// Requirement: a checkerboard has the geometric mean (Keller, J. Math. Phys. 5 (1964) 548).
TEST(Diffusion, Checkerboard) {
  const PhaseImage image = phases({64, 64, 1}, true, [](const Eigen::Vector3d &x) {
    return (x.x() < 32) == (x.y() < 32) ? 0 : 1;
  });
  EXPECT_NEAR(diffusion(grid_of(image, 0.25F), 0).effective, 0.5, 0.005);
}

// One voxel wide: enters the lowest row at its right end and snakes up, `turns` times across.
PhaseImage bent_channel(int width, int turns, double voxel) {
  const int rows = 2 * turns + 1;
  return phases(
      {width, 1, rows}, false,
      [&](const Eigen::Vector3d &x) {
        const int i = int(x.x() / voxel), k = int(x.z() / voxel);
        if (k % 2 == 1 || k == 0 || k == rows - 1) // one voxel up
          return i == ((k / 2) % 2 == (k == rows - 1) ? width - 1 : 0) ? 0 : 1;
        return 0; // across
      },
      voxel);
}

// Requirement: tau of a channel one voxel wide is (length of the path/thickness)^2.
TEST(Diffusion, ABentChannelOfKnownLength) {
  const int width = 9, turns = 6;
  const PhaseImage image = bent_channel(width, turns, 0.3);
  const long path = std::count(image.label.begin(), image.label.end(), 0);
  ASSERT_EQ(path, (turns - 1) * width + turns + 2);
  const Diffusion d = diffusion(pore_space(image), 2);
  EXPECT_DOUBLE_EQ(d.percolating, 1.0);
  const double length = double(path) / (2 * turns + 1);
  EXPECT_NEAR(d.open / d.effective, length * length, 1e-5 * length * length);
}

// Requirement: dead ends and closed pores count in eps and carry nothing.
TEST(Diffusion, DeadEndsCarryNothing) {
  PhaseImage image =
      phases({6, 6, 6}, false, [](const Eigen::Vector3d &x) { return x.x() < 2 ? 0 : 1; });
  const double straight = diffusion(pore_space(image), 2).effective;
  image.label[image.index(4, 4, 4)] = 0; // closed
  image.label[image.index(4, 1, 5)] = 0; // open at one end only
  const Diffusion d = diffusion(pore_space(image), 2);
  EXPECT_NEAR(d.effective, straight, 1e-12);
  EXPECT_NEAR(d.open, 74.0 / 216.0, 1e-12);
  EXPECT_NEAR(d.percolating, 72.0 / 74.0, 1e-12);
}

// Requirement: tau counts them in eps: a channel of 1/3 beside a closed hollow of 2/9 has 5/3.
TEST(Tortuosity, CountsClosedPoresAsPores) {
  const PhaseImage image = phases({12, 12, 12}, true, [](const Eigen::Vector3d &x) {
    const bool hollow = x.x() > 6 && x.x() < 10 && x.z() > 2 && x.z() < 10;
    return x.x() < 4 || hollow ? 0 : 1;
  });
  const Tortuosity t = tortuosity(image, 2);
  EXPECT_NEAR(t.tau, 5.0 / 3.0, 1e-9);
  EXPECT_NEAR(t.percolating, 0.6, 1e-12);
}

// Requirement: in a periodic image a path must meet itself in the next cell: a ring does not, nor a
// channel that leaves the cell elsewhere than it enters; through held ends the latter leads.
TEST(OnPaths, PeriodicPathsMeetThemselves) {
  const auto channel = [](const Eigen::Vector3d &x) {
    const bool low = x.y() > 2 && x.y() < 3 && x.x()<6, high = x.y()> 5 && x.y() < 6 && x.x() > 5;
    return low || high || (x.x() > 5 && x.x() < 6 && x.y() > 2 && x.y() < 6) ? 0 : 1;
  };
  EXPECT_EQ(diffusion(pore_space(phases({12, 12, 1}, true, channel)), 0).effective, 0.0);
  EXPECT_GT(diffusion(pore_space(phases({12, 12, 1}, false, channel)), 0).effective, 0.0);
  const PhaseImage ring = phases({12, 12, 1}, true, [](const Eigen::Vector3d &x) {
    const double r = (x - Eigen::Vector3d(6, 6, 0.5)).cwiseAbs().maxCoeff();
    return r < 4 && r > 2 ? 0 : 1;
  });
  EXPECT_EQ(diffusion(pore_space(ring), 0).effective, 0.0);
}

// Requirement: layers tilted against the axis: tau = 1/cos^2 of the angle to the channels.
TEST(Tortuosity, TiltedChannels) {
  const auto layers = [](int a, int b) {
    return phases({80, 80, 2}, true, [=](const Eigen::Vector3d &x) {
      return std::fmod(a * x.x() + b * x.y(), 80.0) < 40.0 ? 0 : 1;
    });
  };
  EXPECT_NEAR(tortuosity(layers(1, 1), 0).tau, 2.0, 0.001 * 2.0); // 45 degrees
  EXPECT_NEAR(tortuosity(layers(1, 2), 1).tau, 5.0, 0.001 * 5.0); // 63.4 degrees
  EXPECT_NEAR(tortuosity(layers(1, 2), 0).tau, 1.25, 0.001 * 1.25);
}

// Spheres of volume fraction f on a simple cubic lattice, somewhere in a cell of n voxels.
PhaseImage cubic_array(double f, int n) {
  const double radius = std::cbrt(0.75 * f / kPi) * n;
  const Eigen::Vector3d centre =
      Eigen::Vector3d::Constant(0.5 * n) + Eigen::Vector3d(0.37, 0.26, 0.11);
  return phases({n, n, n}, true,
                [&](const Eigen::Vector3d &x) { return (x - centre).norm() < radius ? 1 : 0; });
}

// Rayleigh (1892) with the coefficient corrected by Runge (1925), 1.306 x 3/4 for spheres that
// conduct nothing; the next terms are below 0.1 % at f = 0.4.
double rayleigh(double f) { return 1 - 3 * f / (2 + f - 0.9795 * std::pow(f, 10.0 / 3.0)); }

// Requirement: cubic arrays of spheres, radius 11 voxels up, within 1.5 %; on the voxels alone the
// error is of first order, which is why tau is extrapolated.
TEST(Tortuosity, CubicArraysOfSpheres) {
  for (const double f : {0.2, 0.4}) {
    const double known = (1 - f) / rayleigh(f);
    for (const int n : {32, 48, 64})
      for (const int axis : {0, 2}) { // endless, and held at planes of symmetry (nearly)
        const Tortuosity t = tortuosity(cubic_array(f, n), axis);
        EXPECT_NEAR(t.tau / known, 1.0, 0.015) << f << " " << n << " " << axis;
      }
    const double coarse = rayleigh(f) / tortuosity(cubic_array(f, 24), 0).on_voxels - 1;
    const double fine = rayleigh(f) / tortuosity(cubic_array(f, 48), 0).on_voxels - 1;
    EXPECT_GT(fine, 0.01) << f;
    EXPECT_NEAR(coarse / fine, 2.0, 0.25) << f;
  }
}

// Requirement: where pores are too narrow for voxels of twice the size, tau is that of the voxels
// and said to be an upper bound.
TEST(Tortuosity, IsNotExtrapolatedWherePoresAreTooNarrow) {
  const PhaseImage image = phases({8, 8, 8}, true, [](const Eigen::Vector3d &x) {
    return x.x() > 3 && x.x() < 4 ? 0 : 1; // every second voxel misses it
  });
  const Tortuosity t = tortuosity(image, 2);
  EXPECT_FALSE(t.extrapolated);
  EXPECT_NEAR(t.tau, 1.0, 1e-9);
}

// Requirement: the preconditioner leads to the solution, in a number of iterations that does not
// grow with the grid: random pores just above percolation.
TEST(Multigrid, SolvesInFewIterations) {
  for (const int n : {20, 50}) {
    std::mt19937 random(3);
    const PhaseImage image = phases(
        {n, n, n}, false, [&](const Eigen::Vector3d &) { return random() % 100 < 45 ? 0 : 1; });
    const Diffusion d = diffusion(pore_space(image), 2);
    EXPECT_GT(d.effective, 0.0);
    EXPECT_LT(d.iterations, 60) << n;
    EXPECT_LT(d.residual, 1e-6);
  }
}

TEST(Multigrid, AgreesWithADirectSolution) {
  const int n = 16, unknowns = n * n * n;
  Multigrid::Matrix matrix(unknowns, unknowns);
  std::vector<std::array<int, 3>> places;
  std::mt19937 random(5);
  for (int v = 0; v < unknowns; ++v) {
    places.push_back({v % n, v / n % n, v / n / n});
    matrix.coeffRef(v, v) += 1e-3;
    for (const auto &[axis, step] : {std::pair{0, 1}, {1, n}, {2, n * n}})
      if (places[v][axis] + 1 < n) {
        const double g = 0.01 + double(random() % 100);
        matrix.coeffRef(v, v) += g;
        matrix.coeffRef(v + step, v + step) += g;
        matrix.coeffRef(v, v + step) -= g;
        matrix.coeffRef(v + step, v) -= g;
      }
  }
  matrix.makeCompressed();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  right[5] = 1.0;
  right[4000] = -2.0;
  Eigen::ConjugateGradient<Multigrid::Matrix, Eigen::Lower | Eigen::Upper, Multigrid> solver;
  solver.setTolerance(1e-12);
  solver.preconditioner().set_places(places);
  solver.compute(matrix);
  const Eigen::VectorXd u = solver.solve(right);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> direct(matrix);
  const Eigen::VectorXd known = direct.solve(right);
  EXPECT_LT((u - known).norm(), 1e-8 * known.norm());
  EXPECT_LT(solver.iterations(), 60);
}

} // namespace
