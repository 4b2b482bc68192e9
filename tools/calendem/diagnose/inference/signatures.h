// SPDX-License-Identifier: GPL-2.0-or-later
// What effects add to the features beyond what recalibration takes up.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_SIGNATURES_H
#define CALENDEM_DIAGNOSE_INFERENCE_SIGNATURES_H

#include "diagnose/inference/problem.h"

namespace calendem::inference {

/// Whitened by the recalibrated covariance. What is expected to be seen of a rival has that
/// covariance, I here, and the errors of its emulators.
struct Signature {
  std::vector<Applied> on; ///< empty: none
  Vector mean;
  Matrix precision;                          ///< inverse of that sum; empty: I
  double log_determinant = 0.0, trace = 0.0; ///< of the sum; of its inverse
};

/// About one point of the base parameters.
class Signatures {
public:
  /// Both are referred to.
  Signatures(const Problem &problem, const Linearised &base);

  Vector white(const std::vector<Applied> &on) const;
  Signature of(const std::vector<Applied> &on) const;
  Signature off() const;
  /// Share of the squared length that recalibration takes up.
  double absorbed(const std::vector<Applied> &on) const;

  /// Expected log-odds of a true signature, seen with the recalibrated covariance, against a
  /// rival's: half of (square of the distance in the rival's covariance + ln det of the rival's
  /// over the truth's + what noise adds to the squares), base linearised.
  static double odds(const Signature &truth, const Signature &rival);
  /// The same, but for the rival the base model is recalibrated as its emulators are, not as their
  /// tangents are: the square becomes the least of that to the prediction and that of the way there
  /// in scores. Costs as much as a search for a mode.
  double odds_recalibrated(const Signature &truth, const Signature &rival) const;

private:
  const Problem &problem_;
  const Linearised &base_;
  Cholesky factor_;
  Vector base_variance_;

  Vector raw(const std::vector<Applied> &on) const;
};

} // namespace calendem::inference

#endif
