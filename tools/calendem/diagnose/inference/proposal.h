// SPDX-License-Identifier: GPL-2.0-or-later
// What importance sampling draws from: the prior and t distributions at the modes.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_PROPOSAL_H
#define CALENDEM_DIAGNOSE_INFERENCE_PROPOSAL_H

#include "diagnose/inference/linear.h"
#include <cstdint>
#include <vector>

namespace calendem::inference {

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
