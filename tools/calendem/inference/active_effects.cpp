// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/active_effects.h"
#include <algorithm>
#include <map>
#include <numeric>

namespace calendem::inference {
namespace {

using Eigen::Index;

double odds(double probability, double least) {
  const double p = std::clamp(probability, least, 1.0 - least);
  return p / (1.0 - p);
}

} // namespace

CredibleRange credible_range(const std::vector<double> &values,
                             const std::vector<double> &weights) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  const auto at = [&](double share) {
    double passed = 0.0;
    for (const std::size_t k : order)
      if ((passed += weights[k]) >= share * total)
        return values[k];
    return std::nan("");
  };
  return {at(0.5), at(0.05), at(0.95)};
}

std::vector<ActiveEffect> active_effects(const PosteriorProblem &problem,
                                         const Posterior &posterior, int material) {
  std::vector<ActiveEffect> out;
  for (const Switch &s : switches_of(problem, material)) {
    ActiveEffect effect;
    effect.at = s;
    std::vector<double> scores, weights;
    for (const Draw &d : posterior.draws)
      if (const double score = score_of(d, material, s); acts(score)) {
        scores.push_back(score);
        weights.push_back(d.weight);
        effect.probability += d.weight;
      }
    const double prior = problem.effects[std::size_t(s.effect)].probability,
                 least = 0.5 / double(posterior.draws.size());
    if (prior < 1.0)
      effect.bayes_factor = odds(effect.probability, least) / odds(prior, 0.0);
    effect.score = credible_range(scores, weights);
    out.push_back(effect);
  }
  return out;
}

std::vector<RankedHypothesis> ranked_hypotheses(const PosteriorProblem &problem,
                                                const Posterior &posterior, int material,
                                                double share) {
  const std::vector<Switch> switches = switches_of(problem, material);
  std::map<std::vector<int>, double> sets;
  for (const Draw &d : posterior.draws) {
    std::vector<int> set;
    for (int s = 0; s < int(switches.size()); ++s)
      if (problem.effects[std::size_t(switches[std::size_t(s)].effect)].probability < 1.0 &&
          acts(score_of(d, material, switches[std::size_t(s)])))
        set.push_back(s);
    sets[set] += d.weight;
  }
  std::vector<RankedHypothesis> all;
  for (const auto &[set, probability] : sets) {
    all.push_back({{}, probability});
    for (const int s : set)
      all.back().effects.push_back(switches[std::size_t(s)]);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const RankedHypothesis &a, const RankedHypothesis &b) {
                     return a.probability > b.probability;
                   });
  double sum = 0.0;
  std::size_t count = 0;
  while (count < all.size() && sum < share)
    sum += all[count++].probability;
  all.resize(count);
  return all;
}

CredibleRange parameter_range(const Posterior &posterior, int parameter, int material) {
  std::vector<double> values, weights;
  for (const Draw &d : posterior.draws) {
    values.push_back(d.scores(parameter, material));
    weights.push_back(d.weight);
  }
  return credible_range(values, weights);
}

} // namespace calendem::inference
