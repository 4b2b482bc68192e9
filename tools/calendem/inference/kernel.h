// SPDX-License-Identifier: GPL-2.0-or-later
// Covariance between runs of a bank: a sum of main effects and pairs, packings and noise.
#ifndef CALENDEM_INFERENCE_KERNEL_H
#define CALENDEM_INFERENCE_KERNEL_H

#include "inference/numerics.h"
#include <vector>

namespace calendem::inference {

/// Places in the space of the bank, one a column.
struct Points {
  Matrix inputs;     ///< inputs x points, scaled to -1..1 over the bank
  Matrix amplitudes; ///< effects x points, strengths 0..1; at 0 an effect is off
};

// clang-format off
/// Expectation over packings, with x the inputs and g the strengths of the effects:
///   k = T { c0 + E + h/2 (E^2 - sum_e c_e^2 G_e^2) } + M (s0 + r E)
///   E = sum_e c_e G_e,   G_e = g_e g_e' + q f_e f_e',   f = g (2 g - 1)
/// E is what effects do one by one, f bends the response to an amplitude, the term with h is their pairs:
/// strong effects act on each other most. M is a Matern 5/2 kernel over the inputs with a length for
/// each (Rasmussen and Williams 2006, eq. 4.17). T = 1 / (1 + |x - x'|^2 / (16 d)) for d inputs (their
/// eq. 4.19 with alpha = 1) is little below 1 between runs and vanishes far from all.
/// Values of runs have in addition
///   u u' p0 [same packing] + u^2 n [same run],   u^2 = exp(sum_e t_e g_e),
/// [..] = 1 where that is true, else 0: packings differ more, or less, where an effect is on.
// clang-format on
class Kernel {
public:
  /// `parameters`: see `Layout`; logarithms but for t.
  Kernel(int inputs, int effects, const Vector &parameters);

  /// Covariance of expectations: `of` x `with`.
  Matrix expected(const Points &of, const Points &with) const;
  /// Variance of the expectation before any run.
  Vector prior_variance(const Points &of) const;
  /// Variance between packings: of one run's value about the expectation.
  Vector scatter(const Points &of) const;
  /// Covariance of the runs' values.
  Matrix of_runs(const Points &runs, const std::vector<int> &packing) const;
  /// sum_ij weight_ij d of_runs_ij / d parameter, for each; `weight` is symmetric.
  Vector gradient(const Points &runs, const std::vector<int> &packing, const Matrix &weight) const;

  /// Normal priors of the parameters.
  static Vector prior_means(int inputs, int effects);
  static Vector prior_spreads(int inputs, int effects);

private:
  struct Parts;
  int inputs_, effects_;
  double smooth_, varying_, bend_, pairs_, packing_, noise_; ///< s0, r, q, h, p0, n
  Vector lengths_, effect_variances_, growth_;               ///< lengths of M, c_e, t_e

  Parts parts(const Points &of, const Points &with, bool slopes) const;
  Matrix sum_of(const Parts &p) const;
  Vector roughness(const Points &of) const;
  Vector length_slopes(const Matrix &pull, const Points &runs) const;
  void effect_slopes(const Parts &p, const Points &runs, const Matrix &weight, Vector &out) const;
};

} // namespace calendem::inference

#endif
