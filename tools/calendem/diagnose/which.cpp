// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/which.h"
#include "diagnose/chances.h"
#include "diagnose/quasi_newton.h"
#include "spec/messages.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem::diagnose {
namespace {

Judged judge(const Problem &problem, const Hypothesis &hypothesis, const Matrix &unknown,
             const WhichSettings &settings) {
  Judged j;
  j.hypothesis = hypothesis;
  const Likelihood likelihood(problem, hypothesis, unknown);
  j.evidence = evidence(
      likelihood.dimension(), [&](const Vector &s) { return likelihood.log(s); },
      settings.evidence);
  if (hypothesis.kind == Hypothesis::none || hypothesis.kind == Hypothesis::effects) {
    const auto square = [&](const Vector &s) { return likelihood.square(s) + s.squaredNorm(); };
    const Minimum least = minimise(with_differences(square), j.evidence.mode);
    j.adequacy_p =
        chance_beyond(least.value, int(problem.observed.size()), problem.degrees_of_freedom);
  }
  return j;
}

std::string joined(const Problem &problem, const std::vector<int> &on) {
  std::string name = problem.effects[on[0]].name;
  for (std::size_t k = 1; k < on.size(); ++k)
    name += " + " + problem.effects[on[k]].name;
  return name;
}

/// The best single effects joined with every other, if one of them beats the base model.
std::vector<Hypothesis> greedy_pairs(const Problem &problem, const Which &so_far, int seeds) {
  std::vector<std::pair<double, int>> singles;
  for (const Judged &j : so_far.judged)
    if (j.hypothesis.kind == Hypothesis::effects)
      singles.emplace_back(-j.evidence.log_evidence, j.hypothesis.on[0]);
  std::sort(singles.begin(), singles.end());
  std::vector<Hypothesis> pairs;
  if (singles.empty() || -singles[0].first < so_far.of("none").evidence.log_evidence)
    return pairs;
  for (int s = 0; s < std::min(seeds, int(singles.size())); ++s)
    for (int o = s + 1; o < int(singles.size()); ++o) {
      std::vector<int> on{singles[s].second, singles[o].second};
      std::sort(on.begin(), on.end());
      pairs.push_back({Hypothesis::effects, on, joined(problem, on), 0.0});
    }
  return pairs;
}

} // namespace

const Judged &Which::of(const std::string &name) const {
  for (const Judged &j : judged)
    if (j.hypothesis.name == name)
      return j;
  throw Failure(kBadInput, fmt::format("no hypothesis '{}' was computed", name));
}

Which which(const Problem &problem, const WhichSettings &settings) {
  Which w;
  const Matrix nothing;
  w.judged.push_back(judge(problem, {Hypothesis::none, {}, "none", 0.0}, nothing, settings));
  w.base = linearise(problem, w.judged[0].evidence.mode);
  w.unknown = beyond_recalibration(w.base, problem.discrepancy);
  w.judged.push_back(
      judge(problem, {Hypothesis::unknown, {}, "unknown", 0.0}, w.unknown, settings));
  if (settings.noise)
    w.judged.push_back(judge(problem, {Hypothesis::noise, {}, "noise", 0.0}, nothing, settings));
  for (int e = 0; e < int(problem.effects.size()); ++e)
    w.judged.push_back(judge(problem, {Hypothesis::effects, {e}, problem.effects[e].name, 0.0},
                             nothing, settings));
  for (const Hypothesis &pair : greedy_pairs(problem, w, settings.pair_seeds))
    w.judged.push_back(judge(problem, pair, nothing, settings));
  decide(w, settings, int(problem.effects.size()));
  return w;
}

} // namespace calendem::diagnose
