// SPDX-License-Identifier: GPL-2.0-or-later
// The explanations that compete, and the likelihood of the data under each.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_HYPOTHESIS_H
#define CALENDEM_DIAGNOSE_INFERENCE_HYPOTHESIS_H

#include "diagnose/inference/evidence.h"
#include "diagnose/inference/problem.h"
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
  double size = 0.0; ///< of the unknown, in standard deviations; 0: to be found, its last score

  bool single() const { return kind == effects && on.size() == 1; }
};

/// Its effects, on at these scores of base parameters and effects.
std::vector<Applied> applied_at(const Problem &problem, const Hypothesis &hypothesis,
                                const Vector &scores);

/// ln p(observed | scores), multivariate t. Scores: the base parameters', then the effects' in
/// order, then of the factor of noise or of the standard deviation of the unknown.
class Likelihood {
public:
  /// `unknown`: covariance of the discrepancy for one standard deviation, off the sensitivities.
  Likelihood(const Problem &problem, const Hypothesis &hypothesis, const Matrix &unknown);

  int dimension() const;
  double log(const Vector &scores) const;
  /// With its gradient.
  double log(const Vector &scores, Vector &gradient) const;
  /// Square of observed - predicted in the inverse covariance, with its gradient. Of a hypothesis
  /// that makes a prediction.
  double square(const Vector &scores, Vector &gradient) const;
  /// Sum of the square and ln of the covariance's determinant.
  double deviance(const Vector &scores, Vector &gradient) const;
  /// Covariance of observed - predicted.
  Matrix covariance(const Vector &scores, const Prediction &prediction) const;
  Prediction predict(const Vector &scores) const;

private:
  const Problem &problem_;
  const Hypothesis &hypothesis_;
  const Matrix &unknown_;

  bool has_size() const;
  double noise_factor(const Vector &scores) const;
  Prediction bare(const Vector &scores) const;
  Slopes bare_slopes(const Vector &scores) const;
  Prediction shifted(const Vector &scores, const Prediction &bare) const;
  double log_of_points(const Vector &scores) const;
  double log_about(const Vector &scores, const Prediction &bare) const;
  Misfit misfit(const Vector &scores, const Slopes &bare) const;
};

/// With the likelihood's own gradients.
Evidence evidence(const Likelihood &likelihood, const EvidenceSettings &settings);

/// Standard deviation of the unknown (in those of the observables) and factor of understated noise.
extern const Prior kUnknownSize, kNoiseFactor;

} // namespace calendem::inference

#endif
