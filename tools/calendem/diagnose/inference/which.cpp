// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/which.h"
#include "base/messages.h"
#include "diagnose/inference/chances.h"
#include "diagnose/inference/unknown_places.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem::inference {
namespace {

Judged judge(const Problem &problem, const Hypothesis &hypothesis, const Matrix &unknown,
             const WhichSettings &settings) {
  Judged j;
  j.hypothesis = hypothesis;
  const Likelihood likelihood(problem, hypothesis, unknown);
  j.evidence = evidence(likelihood, settings.evidence);
  if (hypothesis.kind == Hypothesis::none || hypothesis.kind == Hypothesis::effects) {
    const auto square = [&](const Vector &s, Vector &gradient) {
      const double of_data = likelihood.square(s, gradient);
      gradient += 2.0 * s;
      return of_data + s.squaredNorm();
    };
    const Minimum least = minimise(square, j.evidence.mode);
    j.adequacy_p =
        chance_beyond(least.value, int(problem.observed.size()), problem.degrees_of_freedom);
  }
  return j;
}

/// The unknown with its evidence averaged over places; parameters are those of the best place.
Judged judge_unknown(const Problem &problem, const WhichSettings &settings,
                     const std::vector<int> &best_effects, Which &w) {
  Judged best;
  double sum = 0.0, top = -INFINITY;
  struct Term {
    std::string place;
    double share, log_evidence;
  };
  std::vector<Term> terms;
  for (const UnknownPlace &place : unknown_places(problem, w, best_effects, settings.priors)) {
    Judged here = judge(problem, place.hypothesis, place.unknown, settings);
    here.place = place.name;
    terms.push_back({place.name, place.share, here.evidence.log_evidence});
    const double mass = std::log(place.share) + here.evidence.log_evidence;
    if (!(mass > top))
      continue;
    top = mass;
    best = std::move(here);
    w.unknown = place.unknown;
  }
  for (const Term &t : terms)
    sum += std::exp(std::log(t.share) + t.log_evidence - top);
  for (const Term &t : terms)
    best.of_place[t.place] = std::exp(std::log(t.share) + t.log_evidence - top) / sum;
  const double shift = top + std::log(sum) - best.evidence.log_evidence;
  best.evidence.log_evidence += shift;
  best.evidence.laplace += shift;
  return best;
}

std::string joined(const Problem &problem, const std::vector<int> &on) {
  std::string name = problem.effects[on[0]].name;
  for (std::size_t k = 1; k < on.size(); ++k)
    name += " + " + problem.effects[on[k]].name;
  return name;
}

/// Effects by the evidence for them, the best first; none if the base model beats them all.
std::vector<int> ranked_effects(const Which &so_far) {
  std::vector<std::pair<double, int>> singles;
  for (const Judged &j : so_far.judged)
    if (j.hypothesis.single())
      singles.emplace_back(-j.evidence.log_evidence, j.hypothesis.on[0]);
  std::sort(singles.begin(), singles.end());
  std::vector<int> out;
  if (!singles.empty() && -singles[0].first >= so_far.of("none").evidence.log_evidence)
    for (const auto &[cost, effect] : singles)
      out.push_back(effect);
  return out;
}

/// The best effects joined with every other.
std::vector<Hypothesis> greedy_pairs(const Problem &problem, const std::vector<int> &ranked,
                                     int seeds) {
  std::vector<Hypothesis> pairs;
  for (int s = 0; s < std::min(seeds, int(ranked.size())); ++s)
    for (int o = s + 1; o < int(ranked.size()); ++o) {
      std::vector<int> on{ranked[s], ranked[o]};
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
  if (settings.noise)
    w.judged.push_back(judge(problem, {Hypothesis::noise, {}, "noise", 0.0}, nothing, settings));
  for (int e = 0; e < int(problem.effects.size()); ++e)
    w.judged.push_back(judge(problem, {Hypothesis::effects, {e}, problem.effects[e].name, 0.0},
                             nothing, settings));
  std::vector<int> ranked = ranked_effects(w);
  for (const Hypothesis &pair : greedy_pairs(problem, ranked, settings.pair_seeds))
    w.judged.push_back(judge(problem, pair, nothing, settings));
  ranked.resize(std::min(ranked.size(), std::size_t(settings.pair_seeds)));
  w.judged.push_back(judge_unknown(problem, settings, ranked, w));
  decide(w, settings, int(problem.effects.size()));
  return w;
}

} // namespace calendem::inference
