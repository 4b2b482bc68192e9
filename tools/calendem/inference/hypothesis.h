// SPDX-License-Identifier: GPL-2.0-or-later
// The explanations that compete, and the likelihood of the data under each.
#ifndef CALENDEM_INFERENCE_HYPOTHESIS_H
#define CALENDEM_INFERENCE_HYPOTHESIS_H

#include "inference/problem.h"
#include <string>

namespace calendem::inference {

struct Hypothesis {
  enum Kind {
    none,    ///< the base model, recalibrated
    effects, ///< one or more effects or measurement faults are on
    noise,   ///< the measurement's standard deviations are understated
    unknown  ///< a smooth discrepancy that no base parameter can take up, alone or beside effects
  };
  Kind kind = none;
  std::vector<int> on; ///< places in the problem's effects
  std::string name;    ///< none, unknown, noise, or the effects' names joined by " + "
  double prior = 0.0;

  bool single() const { return kind == effects && on.size() == 1; }
};

/// ln p(observed | scores), multivariate t. Scores: the base parameters', then the effects' in
/// order, then of the factor of noise or of the standard deviation of the unknown.
class Likelihood {
public:
  /// `unknown`: covariance of the discrepancy for one standard deviation, off the sensitivities.
  Likelihood(const Problem &problem, const Hypothesis &hypothesis, const Matrix &unknown);

  int dimension() const;
  double log(const Vector &scores) const;
  /// Square of observed - predicted in the inverse covariance.
  double square(const Vector &scores) const;
  /// Covariance of observed - predicted.
  Matrix covariance(const Vector &scores, const Prediction &prediction) const;
  Prediction predict(const Vector &scores) const;

private:
  const Problem &problem_;
  const Hypothesis &hypothesis_;
  const Matrix &unknown_;
};

/// Standard deviation of the unknown (in those of the observables) and factor of understated noise.
extern const Prior kUnknownSize, kNoiseFactor;

} // namespace calendem::inference

#endif
