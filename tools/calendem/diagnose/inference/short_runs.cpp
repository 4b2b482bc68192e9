// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/confounding.h"
#include "diagnose/inference/which.h"

namespace calendem::inference {
namespace {

constexpr double kMostAlike = 0.85; // cosine: what the two most alike of the table have on a curve
constexpr double kReached = 0.5;
constexpr double kMayBeClaimed = 0.01; // probability of a hypothesis that may be claimed
constexpr double kEnd = 3.0;           // score of the end of a range

/// The strongest that was run: amplitudes at the end of their ranges, shapes in the middle.
Applied strongest(const Problem &problem, int effect) {
  const std::vector<Parameter> &all = problem.effects[std::size_t(effect)].parameters;
  Vector scores = Vector::Zero(Eigen::Index(all.size()));
  for (std::size_t j = 0; j < all.size(); ++j)
    if (all[j].amplitude)
      scores[Eigen::Index(j)] = all[j].prior.kind == Prior::normal ? 2.0 : kEnd;
  return {effect, scores};
}

void add_rivals(const Problem &problem, const Signatures &signatures, const Applied &applied,
                std::vector<ShortRuns> &to) {
  const ModelledEffect &own = problem.effects[std::size_t(applied.effect)];
  const Vector signature = signatures.white({applied});
  if (own.computed || !(signature.norm() > 0.0))
    return;
  for (int k = 0; k < int(problem.effects.size()); ++k) {
    const ModelledEffect &rival = problem.effects[std::size_t(k)];
    if (k == applied.effect || rival.computed)
      continue;
    const Vector end = signatures.white({strongest(problem, k)});
    const double reached = end.norm() / signature.norm();
    const double cosine =
        reached > 0.0 ? end.dot(signature) / (end.norm() * signature.norm()) : 0.0;
    if (cosine >= kMostAlike && reached < kReached)
      to.push_back({own.name, rival.name, cosine, reached});
  }
}

} // namespace

void set_short_runs(Which &w, const Problem &problem) {
  const Signatures signatures(problem, w.base);
  for (Judged &j : w.judged) {
    j.short_runs.clear();
    if (j.hypothesis.kind == Hypothesis::effects && j.probability >= kMayBeClaimed)
      for (const Applied &on : applied_at(problem, j.hypothesis, j.evidence.mode))
        add_rivals(problem, signatures, on, j.short_runs);
  }
}

} // namespace calendem::inference
