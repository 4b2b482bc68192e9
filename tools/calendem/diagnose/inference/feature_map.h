// SPDX-License-Identifier: GPL-2.0-or-later
// Curves as a few numbers that emulators can learn, and one number for what those leave out.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_FEATURE_MAP_H
#define CALENDEM_DIAGNOSE_INFERENCE_FEATURE_MAP_H

#include "inference/quantities.h"

namespace calendem::inference {

struct Feature {
  int block = 0;        ///< of `blocks()`
  bool emulated = true; ///< false: the truncation residual, the same under every known hypothesis
};

/// A truncation residual: its variance has a share of measurement in each of its directions.
struct Roughness {
  int feature = 0;
  Vector measured; ///< the shares, 0..1
};

struct NormalMoments {
  double mean = 0.0, variance = 1.0;
};

/// Moments of the normal_score of a squared length in directions whose variance has these shares of
/// measurement, if its errors are `factor` times those stated. A sum of squares with such weights
/// is about g chi-squared of h degrees of freedom, with its mean and variance (Satterthwaite,
/// Biometrics Bull. 2 (1946) 110), whose cube root is about normal.
NormalMoments score_moments(const Vector &measured, double factor);

/// Each block is divided by `sd`, and its runs decomposed by singular values (Higdon et al., J. Am.
/// Stat. Assoc. 103 (2008) 570). Kept are the first vectors, until what is left of a run is on
/// average below a tenth of one squared standard deviation, or `kMost`. What a measured curve has
/// outside their span becomes one feature: its squared length q in the covariance of measurement
/// and bank there, k degrees of freedom, as ((q/k)^(1/3) - 1 + 2/(9k)) / sqrt(2/(9k)): about
/// standard normal (Wilson and Hilferty, PNAS 17 (1931) 684).
class FeatureMap {
public:
  static constexpr int kMost = 6;

  /// `simulated`: observables x runs, all runs of the bank. `sd` > 0 in the observables' units.
  FeatureMap(const std::vector<ObservableId> &observables, const Matrix &simulated,
             const Vector &sd, const Matrix &measurement);

  const std::vector<Block> &blocks() const { return blocks_; }
  /// The emulated ones first, by blocks; then the truncation residuals.
  const std::vector<Feature> &features() const { return features_; }
  int emulated() const { return int(linear_.rows()); }
  int size() const { return int(features_.size()); }

  /// Emulated features of simulated values; columns are runs.
  Matrix emulated_of(const Matrix &simulated) const;
  /// All features of measured values.
  Vector features_of(const Vector &measured) const;
  /// Covariance of all features from that of the observables; 1 for a truncation residual.
  Matrix covariance(const Matrix &of_observables) const;
  /// Covariance of features for a discrepancy of the model: a truncation residual gets the square
  /// of what it is expected to grow to, or 1: an unknown effect need not be smooth.
  Matrix discrepancy(const Matrix &of_observables) const;
  /// Roughness of every truncation residual.
  const std::vector<Roughness> &roughness() const { return roughness_; }
  /// Observables that have these emulated features.
  Vector observables_of(const Vector &emulated) const;
  /// Variances of the observables where emulated features have this covariance.
  Vector variances_of(const Matrix &emulated) const;

private:
  struct Truncation {
    int block;
    Matrix across; ///< k x members: the vectors left out, divided by sd
    Cholesky covariance;
  };
  std::vector<Block> blocks_;
  std::vector<Feature> features_;
  std::vector<Truncation> truncations_;
  std::vector<Roughness> roughness_;
  Vector mean_, sd_;
  Matrix linear_; ///< emulated features = linear_ (values - mean_)
  Matrix back_;   ///< values = mean_ + back_ emulated features

  void add_block(int block, const Matrix &scaled, const Matrix &measurement,
                 std::vector<Matrix> &kept);
};

/// Wilson and Hilferty's normal score of a chi-squared variable.
double normal_score(double chi2, int degrees_of_freedom);

} // namespace calendem::inference

#endif
