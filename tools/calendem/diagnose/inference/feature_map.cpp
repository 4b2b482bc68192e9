// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/feature_map.h"
#include <algorithm>
#include <cmath>

namespace calendem::inference {
namespace {

constexpr double kLeftOut = 0.1; // of a run's squared distance, in standard deviations squared

} // namespace

double normal_score(double chi2, int degrees_of_freedom) {
  const double spread = 2.0 / (9.0 * degrees_of_freedom);
  return (std::cbrt(chi2 / degrees_of_freedom) - 1.0 + spread) / std::sqrt(spread);
}

NormalMoments score_moments(const Vector &measured, double factor) {
  const Eigen::ArrayXd weight = 1.0 + (factor * factor - 1.0) * measured.array();
  const double k = double(weight.size()), mean = weight.sum(),
               h = mean * mean / weight.square().sum();
  const double grown = std::cbrt(mean / k), spread = 2.0 / (9.0 * k), of_sum = 2.0 / (9.0 * h);
  return {(grown * (1.0 - of_sum) - 1.0 + spread) / std::sqrt(spread),
          grown * grown * of_sum / spread};
}

FeatureMap::FeatureMap(const std::vector<ObservableId> &observables, const Matrix &simulated,
                       const Vector &sd, const Matrix &measurement)
    : blocks_(blocks_of(observables)), mean_(simulated.rowwise().mean()), sd_(sd) {
  const Matrix scaled = sd.cwiseInverse().asDiagonal() * (simulated.colwise() - mean_);
  std::vector<Matrix> kept;
  Eigen::Index rows = 0;
  for (int b = 0; b < int(blocks_.size()); ++b) {
    add_block(b, scaled, measurement, kept);
    rows += kept.back().cols();
  }
  linear_ = Matrix::Zero(rows, mean_.size());
  back_ = Matrix::Zero(mean_.size(), rows);
  rows = 0;
  for (int b = 0; b < int(blocks_.size()); ++b)
    for (Eigen::Index k = 0; k < kept[b].cols(); ++k, ++rows) {
      features_.push_back({b, true});
      for (Eigen::Index m = 0; m < kept[b].rows(); ++m) {
        const int place = blocks_[b].members[m];
        linear_(rows, place) = kept[b](m, k) / sd_[place];
        back_(place, rows) = kept[b](m, k) * sd_[place];
      }
    }
  for (std::size_t t = 0; t < truncations_.size(); ++t) {
    features_.push_back({truncations_[t].block, false});
    roughness_[t].feature = int(features_.size()) - 1;
  }
}

void FeatureMap::add_block(int block, const Matrix &scaled, const Matrix &measurement,
                           std::vector<Matrix> &kept) {
  const auto &members = blocks_[block].members;
  const auto m = Eigen::Index(members.size()), runs = scaled.cols();
  if (m == 1) {
    kept.push_back(Matrix::Identity(1, 1));
    return;
  }
  const Matrix here = scaled(members, Eigen::all);
  // Left singular vectors and squared singular values, the smallest first.
  const Eigen::SelfAdjointEigenSolver<Matrix> squares(here * here.transpose());
  const Matrix vectors = squares.eigenvectors().rowwise().reverse();
  Vector left = Vector::Zero(m); // squared length, per run, from each vector on
  double sum = 0.0;
  for (Eigen::Index k = m; k-- > 0;)
    left[k] = sum += std::max(squares.eigenvalues()[m - 1 - k], 0.0) / double(runs);
  Eigen::Index keep = 1;
  while (keep < m && keep < kMost && left[keep] > kLeftOut)
    ++keep;
  kept.push_back(vectors.leftCols(keep));
  if (keep == m)
    return;
  const Matrix outside = vectors.rightCols(m - keep).transpose();
  const Vector inverse_sd = sd_(members).cwiseInverse();
  const Matrix across = outside * inverse_sd.asDiagonal();
  const Matrix of_bank = outside * here;
  Matrix covariance = of_bank * of_bank.transpose() / double(runs);
  const double shrink = double(m - keep) / double(m - keep + runs);
  covariance = (1.0 - shrink) * covariance + shrink * Matrix(covariance.diagonal().asDiagonal());
  const Matrix measured = across * measurement(members, members) * across.transpose();
  covariance += measured;
  truncations_.push_back({block, across, Cholesky(covariance)});
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> shares(measured, covariance,
                                                                Eigen::EigenvaluesOnly);
  roughness_.push_back({0, shares.eigenvalues().cwiseMax(0.0)});
}

Matrix FeatureMap::emulated_of(const Matrix &simulated) const {
  return linear_ * (simulated.colwise() - mean_);
}

Vector FeatureMap::observables_of(const Vector &emulated) const { return mean_ + back_ * emulated; }

Vector FeatureMap::variances_of(const Matrix &emulated) const {
  return (back_ * emulated * back_.transpose()).diagonal();
}

Vector FeatureMap::features_of(const Vector &measured) const {
  Vector all(size());
  all.head(emulated()) = emulated_of(measured);
  for (int t = 0; t < int(truncations_.size()); ++t) {
    const Truncation &left = truncations_[t];
    const auto &members = blocks_[left.block].members;
    const Vector e = left.across * (measured - mean_)(members);
    all[emulated() + t] = normal_score(e.dot(left.covariance.solve(e)), int(e.size()));
  }
  return all;
}

Matrix FeatureMap::covariance(const Matrix &of_observables) const {
  Matrix all = Matrix::Identity(size(), size());
  all.topLeftCorner(emulated(), emulated()) = linear_ * of_observables * linear_.transpose();
  return all;
}

Matrix FeatureMap::discrepancy(const Matrix &of_observables) const {
  Matrix all = covariance(of_observables);
  for (int t = 0; t < int(truncations_.size()); ++t) {
    const Truncation &left = truncations_[t];
    const auto &members = blocks_[left.block].members;
    const Matrix here = left.across * of_observables(members, members) * left.across.transpose();
    const int k = int(here.rows());
    const double grown = normal_score(k + left.covariance.solve(here).trace(), k);
    all(emulated() + t, emulated() + t) = std::max(1.0, grown * grown);
  }
  return all;
}

} // namespace calendem::inference
