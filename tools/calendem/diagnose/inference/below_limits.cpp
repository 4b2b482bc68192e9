// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/which.h"
#include <cmath>

namespace calendem::inference {
namespace {

/// Share of the posterior in which all effects of a hypothesis are below their limits.
double share_below(const Problem &problem, const Judged &j, const std::vector<double> &limits) {
  const Matrix &draws = j.evidence.draws;
  Eigen::Index below = 0;
  for (Eigen::Index k = 0; k < draws.cols(); ++k) {
    bool all = true;
    Eigen::Index score = problem.base_parameters;
    for (const int e : j.hypothesis.on)
      for (const Parameter &p : problem.effects[std::size_t(e)].parameters) {
        const double limit = limits[std::size_t(e)];
        all &= !p.amplitude || !(std::fabs(p.prior.value(draws(score, k))) >= limit);
        ++score;
      }
    below += all;
  }
  return draws.cols() > 0 ? double(below) / double(draws.cols()) : 0.0;
}

} // namespace

void set_limits(Which &w, const Problem &problem, const std::vector<double> &limits) {
  for (Judged &j : w.judged)
    if (j.hypothesis.kind == Hypothesis::none)
      j.below_limits = 1.0;
    else if (j.hypothesis.kind == Hypothesis::effects)
      j.below_limits = share_below(problem, j, limits);
  for (Judged &j : w.judged) // what acts like an effect is seen where that is
    if (j.hypothesis.kind == Hypothesis::unknown) {
      j.below_limits = 0.0;
      for (const Judged &known : w.judged)
        if (const auto at = j.of_place.find("like " + known.hypothesis.name);
            at != j.of_place.end())
          j.below_limits += at->second * known.below_limits;
    }
}

} // namespace calendem::inference
