// SPDX-License-Identifier: GPL-2.0-or-later
// The integral of likelihood times prior over a hypothesis's parameters, and what importance
// sampling draws from: the prior and t distributions at the modes.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_EVIDENCE_H
#define CALENDEM_DIAGNOSE_INFERENCE_EVIDENCE_H

#include "inference/numerics.h"
#include <cstdint>
#include <vector>

namespace calendem::inference {

struct EvidenceSettings {
  int samples = 512;        ///< of each of `shifts` shifted Sobol sequences
  int shifts = 2;           ///< their spread gives `error`
  double least_share = 0.1; ///< of effective samples; below, up to three more passes
  int draws = 200;          ///< equally weighted draws of the posterior that are kept
  /// Seed of the shifts. Not a bank's: its points would be among the prior's samples.
  unsigned long long seed = 0xe71d;
};

struct Evidence {
  double log_evidence = 0.0;
  double laplace = 0.0; ///< the same by Laplace's approximation at the highest mode
  double error = 0.0;   ///< standard error of `log_evidence` between shifts
  double effective_samples = 0.0;
  int samples = 0;
  Vector mode;       ///< where likelihood times prior is largest
  Vector mean;       ///< of the posterior
  Matrix covariance; ///< of the posterior
  Matrix draws;      ///< dimension x draws
};

/// ln of the integral of exp(log_likelihood) over `dimension` standard normal scores by importance
/// sampling: proposal is a mixture of the prior (15 %) and of t distributions (6 degrees of
/// freedom) at up to three modes with the covariance of Laplace's approximation, balanced (Veach
/// and Guibas 1995), one more where a sample weighs too much; Sobol points (Owen and Zhou, J. Am.
/// Stat. Assoc. 95 (2000) 135). Exact for linear-Gaussian likelihoods up to `error`; Laplace's is
/// exact there. `with_gradient`: the same likelihood; empty: by differences.
Evidence evidence(int dimension, const std::function<double(const Vector &)> &log_likelihood,
                  const EvidenceSettings &settings, const WithGradient &with_gradient = {});

/// A mode, and the covariance of the normal distribution that touches it there.
struct Peak {
  Vector at;
  Matrix covariance;
  double log_density = 0.0; ///< of likelihood times prior, at the mode
};

class Proposal {
public:
  explicit Proposal(const std::vector<Peak> &peaks);
  /// A further component, in equal share with the others.
  void add(const Peak &peak);
  /// `count` points, the components one after the other, each with its own Sobol sequence.
  Matrix points(int count, std::uint64_t shift) const;
  /// ln density of the mixture, with the shares that `count` points really have.
  double log_density(const Vector &point, int count) const;

private:
  struct Component {
    Vector at;
    Matrix factor; ///< lower triangle of the covariance
    double log_determinant;
  };
  std::vector<Component> components_;
  int of_prior(int count) const;
  int of_component(int which, int count) const;
};

} // namespace calendem::inference

#endif
