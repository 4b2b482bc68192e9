// SPDX-License-Identifier: GPL-2.0-or-later
// The emulator of a bank: what a run would give anywhere between the bank's runs, and how far that
// can be trusted.
#ifndef CALENDEM_INFERENCE_EMULATOR_H
#define CALENDEM_INFERENCE_EMULATOR_H

#include "inference/kernel.h"
#include <optional>

namespace calendem::inference {

/// A bank of runs as numbers.
struct TrainingRuns {
  Points at;
  std::vector<int> packing; ///< of each run; cells of two sizes are never one packing
  Matrix values;            ///< outputs x runs; NaN: the run does not have it
  std::vector<int> group;   ///< of each output, 0, 1, ...; a group shares hyperparameters
};

/// One list for each group, in the order of `Kernel`: to be kept beside the table of runs.
using Hyperparameters = std::vector<std::vector<double>>;

/// Rows: outputs in the order asked for; columns: points.
struct Expectation {
  Matrix mean;     ///< of the expectation over packings
  Matrix variance; ///< of that expectation: what the emulator does not know; empty if not asked for
  Matrix scatter;  ///< variance between packings of a cell of this size
};

/// How well an output of packings that were left out is predicted.
struct Accuracy {
  double q2 = 0.0;        ///< 1 - mean square error / variance of the values
  double error = 0.0;     ///< root mean square
  double spread = 0.0;    ///< standard deviation of the values
  double inside_50 = 0.0; ///< share of the values within their 50 % intervals
  double inside_90 = 0.0;
  double square = 0.0; ///< mean square of error / predicted standard deviation; 1 if calibrated
};

/// Every packing left out in turn, outputs x runs; NaN where the run lacks the output.
struct LeftOut {
  Matrix predicted;
  Matrix deviation; ///< predicted standard deviation of the run's value
};

/// Gaussian processes with the covariance of `Kernel`, one for each output. Values are centred and
/// divided by their spread; the scale of an output's covariance has a scaled inverse chi-squared prior
/// about 1 and is integrated out of the likelihood. Hyperparameters are where the likelihood,
/// averaged over a group's outputs, times their priors is largest; nothing is random.
class Emulator {
public:
  /// Hyperparameters that are missing, or a group's list that has not the length these runs need, are
  /// fitted on all cores: about a core-second a group for 340 runs, and by the cube of their number. An output
  /// that no run has is predicted as NaN.
  explicit Emulator(TrainingRuns runs, const std::optional<Hyperparameters> &known = {});

  const Hyperparameters &hyperparameters() const { return hyperparameters_; }
  const TrainingRuns &runs() const { return runs_; }

  Expectation predict(const Points &at, const std::vector<int> &outputs,
                      bool with_variance = true) const;
  LeftOut left_out() const;
  /// Between points, of what the emulator does not know of an output's expectation.
  Matrix correlation(const Points &at, int output) const;

private:
  /// Outputs of a group that the same runs have.
  struct Factor {
    int group;
    std::vector<int> outputs, runs;
    std::vector<int> packing;
    Points at;
    Cholesky covariance; ///< of the scaled values
    Matrix weights;      ///< runs x outputs: its inverse times the scaled values
    Vector scales;       ///< variance of each output in units of its covariance
  };
  struct Batch {
    Matrix mean;              ///< of the factor's outputs, scaled; outputs x points
    Vector variance, scatter; ///< in units of the covariance
  };
  TrainingRuns runs_;
  Hyperparameters hyperparameters_;
  std::vector<Kernel> kernels_; ///< of the groups
  std::vector<Factor> factors_;
  Vector centres_, spreads_; ///< of the outputs

  void set_scales();
  void add_factors(int group);
  Matrix scaled_values(const std::vector<int> &outputs, const std::vector<int> &runs) const;
  void fit(const std::vector<int> &groups);
  Vector fitted(int group) const;
  Batch predict_batch(std::size_t factor, const Points &at, bool with_variance) const;
  void leave_out(const Factor &factor, const Matrix &inverse, const std::vector<int> &of,
                 LeftOut &out) const;
};

/// Correlation between outputs of the errors of packings that were left out, in their predicted standard
/// deviations. Where it differs from `expected`, a correlation matrix, by less than chance would have it,
/// it is that; else the difference is shrunk by its own variance (the positive part of James and Stein).
Matrix error_correlation(const LeftOut &left_out, const Matrix &values, const Matrix &expected);

/// For each output; NaN where no run has it.
std::vector<Accuracy> accuracy_of(const LeftOut &left_out, const Matrix &values);

/// Minus the logarithm of likelihood times prior of scaled values (runs x outputs), averaged over
/// the outputs; `gradient` along the parameters.
double misfit(const Points &at, const std::vector<int> &packing, const Matrix &scaled_values,
              const Vector &parameters, Vector &gradient);

} // namespace calendem::inference

#endif
