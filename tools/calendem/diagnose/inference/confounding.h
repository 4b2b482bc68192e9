// SPDX-License-Identifier: GPL-2.0-or-later
// What effects add to the features beyond what recalibration takes up, which of them look alike on
// this data, and how small an effect can be seen.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_CONFOUNDING_H
#define CALENDEM_DIAGNOSE_INFERENCE_CONFOUNDING_H

#include "diagnose/inference/problem.h"
#include "diagnose/inference/which.h"

namespace calendem::inference {

struct ConfoundingSettings {
  int amplitudes = 24;   ///< steps from 0 to the end of an effect's range
  double decisive = 3.0; ///< log-odds from here on distinguish two hypotheses
};

struct DetectionLimit {
  std::string effect, rival; ///< rival: the hardest to distinguish at that amplitude
  /// Value of the first amplitude parameter, in its unit, within its prior, the farther from zero
  /// where it may have either sign; NaN: never.
  double amplitude = 0.0;
  double against_none = 0.0; ///< by the distance from none alone: what can be seen
};

struct Confounding {
  std::vector<std::string> effects;
  /// Cosines of the signatures of half-way amplitudes, in the inverse of `recalibrated_covariance`:
  /// what the base parameters can take up within their priors does not count.
  Matrix cosine;
  /// Share of each signature's squared length that recalibration takes up.
  Vector absorbed;
  /// Expected ln(p(data | row) / p(data | column)) when the row's effect is true at half-way
  /// amplitude and the column's may have any; the last column is none.
  Matrix log_odds;
  std::vector<DetectionLimit> limits;
  /// Groups of the hypotheses in the 95 % set, at their fitted amplitudes.
  std::vector<std::vector<std::string>> indistinguishable;
};

/// Expected log-odds (Signatures), truths and rivals at amplitudes from a grid. Without emulators'
/// errors that is half the squared distance (Box and Hill, Technometrics 9 (1967) 57). Limits are
/// where the log-odds reach `decisive`, the rivals recalibrated as far as their emulators say;
/// cosines, shares and the table take the base model for linear. The factor that an amplitude to
/// choose costs an effect counts beside none, which has none to choose, in `limits` (not in
/// against_none); beside each other's they cancel, about.
Confounding confounding(const Problem &problem, const Which &which,
                        const ConfoundingSettings &settings);

/// Whitened by the recalibrated covariance. What is expected to be seen of a rival has that
/// covariance, I here, the errors of its emulators and the scatter that its effects add.
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
  /// As odds(), but for the rival the base model is recalibrated as its emulators are, not as their
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
