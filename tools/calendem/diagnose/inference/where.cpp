// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/where.h"
#include "base/random.h"
#include "diagnose/inference/scatter.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr double kMismatch = 0.01;                 // p below which something cannot be matched
constexpr std::uint64_t kResidualsStream = 0x3e5e; // of the stream of simulated residuals

/// |z| of every block of a residual with covariance `spread`.
class BlockDistance {
public:
  BlockDistance(const std::vector<std::vector<int>> &blocks, const Matrix &spread)
      : blocks_(blocks) {
    for (const auto &b : blocks)
      factors_.emplace_back(Matrix(spread(b, b)));
  }
  double square(int block, const Vector &residual) const {
    return factors_[block].matrixL().solve(Vector(residual(blocks_[block]))).squaredNorm();
  }
  double z(int block, const Vector &residual) const {
    return equivalent_z(square(block, residual), int(blocks_[block].size()));
  }

private:
  const std::vector<std::vector<int>> &blocks_;
  std::vector<Cholesky> factors_;
};

double family_wise_threshold(const BlockDistance &distance, int blocks, const Matrix &spread,
                             double degrees_of_freedom, const WhereSettings &settings) {
  Random random(settings.seed, kResidualsStream);
  const Matrix factor = Cholesky(spread).matrixL();
  const bool normal = degrees_of_freedom >= kNormal;
  const boost::math::chi_squared squares(normal ? 1.0 : degrees_of_freedom);
  std::vector<double> largest(settings.simulations);
  Vector draw(spread.rows());
  for (double &top : largest) {
    for (double &d : draw)
      d = random.normal();
    Vector residual = factor * draw;
    if (!normal)
      residual *= std::sqrt(degrees_of_freedom / quantile(squares, random.uniform()));
    for (int b = 0; b < blocks; ++b)
      top = std::max(top, distance.z(b, residual));
  }
  const auto at = largest.begin() + int((1.0 - settings.false_alarm) * (settings.simulations - 1));
  std::nth_element(largest.begin(), at, largest.end());
  return *at;
}

std::vector<int> both(const std::vector<int> &a, const std::vector<int> &b) {
  std::vector<int> all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

/// p of what the base model predicts for some features, whatever its parameters.
double p_of(const std::vector<int> &features, const Vector &residual, const Matrix &covariance,
            double degrees_of_freedom) {
  const Cholesky factor(Matrix(covariance(features, features)));
  return chance_beyond(factor.matrixL().solve(Vector(residual(features))).squaredNorm(),
                       int(features.size()), degrees_of_freedom);
}

void find_conflicts(Where &w, const std::vector<std::vector<int>> &blocks, const Vector &residual,
                    const Matrix &covariance, double degrees_of_freedom) {
  const int n = int(blocks.size());
  w.conflict = Matrix::Ones(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j)
      w.conflict(i, j) = w.conflict(j, i) = p_of(i == j ? blocks[i] : both(blocks[i], blocks[j]),
                                                 residual, covariance, degrees_of_freedom);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j)
      if (w.conflict(i, j) < kMismatch / (0.5 * n * (n - 1)) && w.conflict(i, i) >= kMismatch &&
          w.conflict(j, j) >= kMismatch)
        w.conflicts.push_back({j, i, w.conflict(i, j)});
  std::stable_sort(w.conflicts.begin(), w.conflicts.end(),
                   [](const Conflict &a, const Conflict &b) { return a.p < b.p; });
}

/// Posterior of the base scores from some features, linear about `base`.
StageFit fit_stage(const std::string &stage, const std::vector<int> &features,
                   const Vector &residual, const Linearised &base) {
  const Matrix j = base.sensitivity(features, Eigen::all);
  const Cholesky factor(Matrix(base.covariance(features, features)));
  Matrix precision = j.transpose() * factor.solve(j);
  precision.diagonal().array() += 1.0;
  const Matrix covariance = Cholesky(precision).solve(Matrix::Identity(j.cols(), j.cols()));
  return {stage, covariance * (j.transpose() * factor.solve(Vector(residual(features)))),
          covariance.diagonal().cwiseSqrt()};
}

} // namespace

std::vector<std::vector<int>> features_by_block(const Problem &problem) {
  std::vector<std::vector<int>> blocks(problem.blocks.size());
  for (int f = 0; f < int(problem.features.size()); ++f)
    blocks[problem.features[f].block].push_back(f);
  return blocks;
}

Where where(const Problem &problem, const Linearised &base, const WhereSettings &settings) {
  Where w;
  const auto blocks = features_by_block(problem);
  const int n = int(blocks.size());
  const Matrix all = recalibrated_covariance(base);
  Matrix spread = base.covariance * Cholesky(all).solve(base.covariance);
  spread = 0.5 * (spread + spread.transpose()).eval();
  const Vector residual = base.mean - problem.observed;
  const BlockDistance distance(blocks, spread);
  w.threshold = family_wise_threshold(distance, n, spread, problem.degrees_of_freedom, settings);
  double sum = 0.0;
  for (int b = 0; b < n; ++b)
    sum += distance.square(b, residual);
  for (int b = 0; b < n; ++b) {
    const double z = distance.z(b, residual);
    w.rows.push_back({b, std::copysign(z, residual(blocks[b]).sum()),
                      sum > 0.0 ? distance.square(b, residual) / sum : 0.0, z > w.threshold});
  }
  std::stable_sort(w.rows.begin(), w.rows.end(), [](const WhereRow &a, const WhereRow &b) {
    return std::fabs(a.z) > std::fabs(b.z);
  });
  // Against the prior's centre: observed - mean + J at = J scores + error.
  const Vector from_centre = base.sensitivity * base.at - residual;
  find_conflicts(w, blocks, from_centre, all, problem.degrees_of_freedom);
  std::vector<std::string> stages;
  for (const Block &b : problem.blocks)
    if (std::find(stages.begin(), stages.end(), b.stage) == stages.end())
      stages.push_back(b.stage);
  for (const std::string &stage : stages) {
    std::vector<int> features;
    for (int b = 0; b < n; ++b)
      if (problem.blocks[b].stage == stage)
        features = both(features, blocks[b]);
    w.stages.push_back(fit_stage(stage, features, from_centre, base));
  }
  return w;
}

} // namespace calendem::inference
