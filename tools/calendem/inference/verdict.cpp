// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/verdict.h"
#include <algorithm>

namespace calendem::inference {

Verdict verdict_of(const PosteriorProblem &problem, const Posterior &posterior, int material,
                   double adequacy, const VerdictSettings &settings) {
  Verdict out;
  out.adequacy = adequacy;
  out.discrepancy = discrepancy_evidence(problem, posterior);
  out.credible = ranked_hypotheses(problem, posterior, material);
  double least = 1.0;
  for (const ActiveEffect &e : active_effects(problem, posterior, material)) {
    if (problem.effects[std::size_t(e.at.effect)].probability >= 1.0)
      continue;
    out.strongest = std::max(out.strongest, e.bayes_factor);
    if (e.probability >= settings.certain && e.bayes_factor > settings.unseen) {
      out.effects.push_back(e.at);
      least = std::min(least, e.probability);
    }
  }
  const std::vector<IndistinguishableEffects> groups =
      indistinguishable_effects(problem, posterior, material, settings.certain);
  const bool adequate = adequacy >= settings.adequate;
  const auto answer = [&](Verdict::Kind kind, double probability) {
    out.kind = kind;
    out.probability = probability;
  };
  if (!out.effects.empty() && adequate)
    answer(Verdict::explained, least);
  else if (!groups.empty() && adequate && out.strongest > settings.unseen) {
    out.effects = groups.front().effects;
    answer(Verdict::one_of, groups.front().probability);
  } else if (out.discrepancy.probability >= settings.certain &&
             out.discrepancy.bayes_factor > settings.unseen)
    answer(Verdict::unknown, out.discrepancy.probability);
  else if (adequate && out.strongest <= settings.unseen &&
           out.discrepancy.bayes_factor <= settings.unseen)
    answer(Verdict::nothing_seen, 1.0 - out.discrepancy.probability);
  return out;
}

} // namespace calendem::inference
