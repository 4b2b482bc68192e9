// SPDX-License-Identifier: GPL-2.0-or-later
// Emulator of one number: a Gaussian process with the packing as a random effect.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_GAUSSIAN_PROCESS_H
#define CALENDEM_DIAGNOSE_INFERENCE_GAUSSIAN_PROCESS_H

#include "inference/numerics.h"
#include <vector>

namespace calendem::inference {

/// What an emulator learns from. Inputs are scaled to -1..1 over their priors.
struct Training {
  Matrix inputs;            ///< dimension x runs
  Matrix amplitudes;        ///< of an effect, 0..1, amplitudes x runs; 0 rows: the base model
  std::vector<int> packing; ///< number of each run's packing
  Vector values;            ///< of the runs; for an effect the differences on - off
  double usual_noise = 0.0; ///< variance between runs that is expected; 0: not known
};

struct Mean {
  double mean = 0.0, variance = 0.0; ///< of the expectation over packings; variance: emulator's
};

/// A `Mean` and its derivatives along the inputs and the amplitudes.
struct MeanSlopes {
  Mean here;
  Vector mean_inputs, mean_amplitudes, variance_inputs, variance_amplitudes;
};

/// How well it predicts runs of packings it has not seen.
struct Quality {
  double q2 = 0.0;      ///< 1 - mean square error / variance (for an effect: / mean square)
  double error = 0.0;   ///< root mean square, in units of the values
  double spread = 0.0;  ///< what q2 is relative to: root mean square of the values (less the mean)
  double scatter = 0.0; ///< part of the error that is the packings' and the runs': not to be learnt
  double own = 0.0;     ///< the other part, the emulator's
};

/// Share of the variance `all` that is learnt if `missed` is not, both without the runs' scatter:
/// 0 to 1; 0 where nothing could be told from the scatter.
double learnt_share(double missed, double all);

/// What a Gaussian process could be asked for: a run that was not made, on a packing, or the
/// expectation over packings (packing kExpectation).
struct Asked {
  Matrix inputs, amplitudes; ///< as in Training
  std::vector<int> packing;
};
constexpr int kExpectation = -1;

/// k(x, x') = g { c + b x.x' + s^2 M(x, x') + p^2 [same packing] } + n^2 [same run]
/// with M the Matern 5/2 kernel with a length for each input (Rasmussen and Williams 2006,
/// eqs 4.17 and 5.2), c and b priors of a linear trend, wide but for an effect's slopes, and g = 1
/// for the base model, g = a.a' for the difference an effect of amplitudes a makes: 0 at 0 by
/// construction. Values are divided by their spread before. s, p, n and the lengths are where
/// marginal likelihood times a log-normal prior is largest, from three starts; nothing is random.
class GaussianProcess {
public:
  explicit GaussianProcess(Training training);

  /// Expectation over packings at one point. Far from all runs the variance is the prior's.
  Mean at(const Vector &input, const Vector &amplitudes) const;
  MeanSlopes slopes_at(const Vector &input, const Vector &amplitudes) const;

  /// Covariance of all that is asked for, given the runs that it learnt from.
  Matrix covariance(const Asked &asked) const;

  /// Every packing left out in turn (every run, when there are fewer than `kFewestPackings`).
  Quality left_out() const;
  static constexpr int kFewestPackings = 4;

  /// Variance between packings of the base model, or of an effect per square of amplitude.
  double packing_variance() const { return square_ * packing_; }
  /// Variance between runs of one packing; with one run for each packing it is the whole scatter.
  double run_variance() const { return square_ * noise_; }
  /// What the expectation does not explain.
  const Vector &residuals() const { return residuals_; }
  /// Runs that the expectation's adaptation uses up.
  double parameters_used() const { return parameters_used_; }

private:
  Training training_;
  double centre_ = 0.0, square_ = 1.0; ///< shift and square of the scale of the values
  double slopes_ = 0.0;                ///< prior variance of the trend's slopes
  double signal_ = 0.0, packing_ = 0.0, noise_ = 1.0; ///< variances, in the scaled values
  Vector lengths_;
  Matrix amplitude_product_, covariance_inverse_;
  Matrix factor_;                 ///< Cholesky's, of the covariance
  Matrix inputs_, scaled_inputs_; ///< runs x dimension; scaled: divided by the lengths
  Vector weights_, residuals_, scaled_values_;
  double parameters_used_ = 0.0;
  bool repeated_ = false; ///< a packing has more than one run

  /// A point beside the runs, before the amplitudes: the shape of the kernel, and the covariance.
  struct Near {
    Vector root, decay; ///< sqrt(5) distance in lengths, exp(-root)
    Vector covariance;
  };
  Near near(const Vector &input) const;
  /// `white`: the covariances times the inverse of the factor.
  Mean mean_of(const Vector &input, const Vector &amplitudes, const Vector &covariances,
               const Vector &white) const;
  Matrix expected_covariance() const;
  double misfit(const Vector &logarithms, Vector &gradient) const;
  void use(const Vector &logarithms);
  void learn();
};

/// 1 - sum (predicted - actual)^2 / sum (actual - mean)^2 on runs held out.
double q2_of(const Vector &predicted, const Vector &actual);

} // namespace calendem::inference

#endif
