// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/scatter.h"
#include <algorithm>
#include <cmath>
#include <map>

namespace calendem::inference {

namespace {

constexpr double kFewestDegrees =
    3.0; // degrees of freedom: below, a t distribution has no variance

using Groups = std::map<int, std::vector<int>>; // runs by packing

/// Residuals (runs x features) averaged over the runs of each packing.
Matrix by_packing(const Matrix &residuals, const Groups &groups) {
  Matrix mean(Eigen::Index(groups.size()), residuals.cols());
  Eigen::Index row = 0;
  for (const auto &[id, runs] : groups) {
    for (Eigen::Index f = 0; f < mean.cols(); ++f)
      mean(row, f) = residuals.col(f)(runs).mean();
    ++row;
  }
  return mean;
}

/// What the residuals of single runs differ by from those means.
Matrix beside_packing(const Matrix &residuals, const Groups &groups, const Matrix &means) {
  Matrix left(residuals.rows(), residuals.cols());
  Eigen::Index row = 0;
  for (const auto &[id, runs] : groups) {
    for (Eigen::Index f = 0; f < left.cols(); ++f)
      left(runs, f) = residuals.col(f)(runs).array() - means(row, f);
    ++row;
  }
  return left;
}

double degrees_of(const GaussianProcess &g, int runs, int packings) {
  const double used = g.parameters_used();
  if (packings == runs)
    return std::max(kFewestDegrees, runs - used);
  const double between = g.packing_variance() / (g.packing_variance() + g.run_variance());
  return std::max(kFewestDegrees, 1.0 / (between * between / std::max(1.0, packings - 1.0) +
                                         (1.0 - between) * (1.0 - between) /
                                             std::max(1.0, runs - packings - used)));
}

} // namespace

Matrix shrunk_correlation(const Matrix &residuals, double &weight) {
  const double n = double(residuals.rows());
  const auto p = residuals.cols();
  Matrix x = residuals.rowwise() - residuals.colwise().mean();
  for (Eigen::Index j = 0; j < p; ++j)
    x.col(j) /= std::max(x.col(j).norm() / std::sqrt(n - 1.0), 1e-300);
  const Matrix correlation = x.transpose() * x / (n - 1.0);
  double variance = 0.0, square = 0.0;
  for (Eigen::Index j = 0; j < p; ++j)
    for (Eigen::Index i = 0; i < j; ++i) {
      const Eigen::ArrayXd w = x.col(i).array() * x.col(j).array();
      variance += n / std::pow(n - 1.0, 3) * (w - w.mean()).square().sum();
      square += correlation(i, j) * correlation(i, j);
    }
  weight = square > 0.0 ? std::clamp(variance / square, 0.0, 1.0) : 1.0;
  Matrix shrunk = (1.0 - weight) * correlation;
  shrunk.diagonal().setOnes();
  return shrunk;
}

Scatter shrunk_covariance(const Matrix &samples) {
  Scatter s;
  const Matrix centred = samples.rowwise() - samples.colwise().mean();
  const Vector sd = (centred.colwise().squaredNorm() / double(samples.rows() - 1)).cwiseSqrt();
  s.covariance = sd.asDiagonal() * shrunk_correlation(samples, s.shrinkage) * sd.asDiagonal();
  s.degrees_of_freedom = double(samples.rows() - 1);
  return s;
}

Matrix residuals_of(const std::vector<GaussianProcess> &features) {
  const auto runs = features.empty() ? 0 : features.front().residuals().size();
  Matrix out(runs, Eigen::Index(features.size()));
  for (std::size_t f = 0; f < features.size(); ++f)
    out.col(Eigen::Index(f)) = features[f].residuals();
  return out;
}

Scatter pooled_scatter(const std::vector<GaussianProcess> &features, const Matrix &residuals,
                       const std::vector<int> &packing) {
  Scatter s;
  const auto n = Eigen::Index(features.size());
  s.covariance = Matrix::Zero(n, n);
  s.degrees_of_freedom = kNormal;
  if (n == 0)
    return s;
  Groups groups;
  for (int i = 0; i < int(packing.size()); ++i)
    groups[packing[i]].push_back(i);
  const bool repeated = groups.size() < packing.size();
  const Matrix means = by_packing(residuals, groups);
  Vector between(n), within(n);
  std::vector<double> degrees;
  for (Eigen::Index f = 0; f < n; ++f) {
    between[f] = std::sqrt(features[f].packing_variance());
    within[f] = std::sqrt(features[f].run_variance());
    degrees.push_back(degrees_of(features[f], int(packing.size()), int(means.rows())));
  }
  std::sort(degrees.begin(), degrees.end());
  s.degrees_of_freedom = degrees[degrees.size() / 2];
  const auto add = [&](const Matrix &samples, const Vector &sd) {
    double weight = 0.0;
    s.covariance += sd.asDiagonal() * shrunk_correlation(samples, weight) * sd.asDiagonal();
    s.shrinkage += weight * sd.squaredNorm();
  };
  if (repeated) {
    add(means, between);
    add(beside_packing(residuals, groups, means), within);
  } else {
    add(means, (between.cwiseAbs2() + within.cwiseAbs2()).cwiseSqrt());
  }
  s.shrinkage /= std::max(s.covariance.trace(), 1e-300);
  return s;
}

} // namespace calendem::inference
