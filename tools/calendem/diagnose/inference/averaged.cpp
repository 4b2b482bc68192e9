// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/averaged.h"
#include <algorithm>
#include <cmath>
#include <set>

namespace calendem::inference {
namespace {

constexpr double kSaysLess = 0.8; // of the prior's 95 %: a limit above it says little
constexpr double kBelongs = 0.05; // probability of an effect that belongs to a group
constexpr double kMoved = 0.25;   // of the length of the interval: half of what is on one side

struct WeightedValue {
  double value, weight;
};

double quantile(const std::vector<WeightedValue> &sorted, double share) {
  double total = 0.0, passed = 0.0;
  for (const WeightedValue &w : sorted)
    total += w.weight;
  for (const WeightedValue &w : sorted)
    if ((passed += w.weight) >= share * total)
      return w.value;
  return sorted.empty() ? std::nan("") : sorted.back().value;
}

void sort(std::vector<WeightedValue> &values) {
  std::stable_sort(
      values.begin(), values.end(),
      [](const WeightedValue &a, const WeightedValue &b) { return a.value < b.value; });
}

Range range_of(const std::vector<WeightedValue> &sorted) {
  return {quantile(sorted, 0.5), quantile(sorted, 0.05), quantile(sorted, 0.95),
          quantile(sorted, 0.025), quantile(sorted, 0.975)};
}

bool has(const Judged &j, int effect) {
  return std::find(j.hypothesis.on.begin(), j.hypothesis.on.end(), effect) != j.hypothesis.on.end();
}

/// The unknown counts with the place alone whose draws are kept.
double weight_of(const Judged &j) {
  const auto at = j.of_place.find(j.place);
  return at == j.of_place.end() ? j.probability : j.probability * (1.0 - j.by_misfit) * at->second;
}

/// Draws of one score, as values of its parameter.
void add_draws(const Matrix &draws, Eigen::Index score, const Prior &prior, double weight,
               std::vector<WeightedValue> &to) {
  for (Eigen::Index k = 0; k < draws.cols(); ++k)
    to.push_back({prior.value(draws(score, k)), weight / double(draws.cols())});
}

/// Number of the first amplitude among an effect's parameters.
int amplitude_of(const ModelledEffect &effect) {
  for (int j = 0; j < int(effect.parameters.size()); ++j)
    if (effect.parameters[std::size_t(j)].amplitude)
      return j;
  return 0;
}

const Matrix &base_draws(const Judged &j) {
  return j.base_draws.size() > 0 ? j.base_draws : j.evidence.draws;
}

/// Place of an effect's first parameter among the scores.
Eigen::Index score_of(const Problem &problem, const Judged &j, int effect) {
  Eigen::Index score = problem.base_parameters;
  for (const int e : j.hypothesis.on) {
    if (e == effect)
      break;
    score += Eigen::Index(problem.effects[std::size_t(e)].parameters.size());
  }
  return score;
}

/// Values of a parameter of an effect in all hypotheses in which it acts, sorted.
std::vector<WeightedValue> values_of(const Problem &problem, const Which &which, int effect,
                                     int parameter) {
  const Prior &prior =
      problem.effects[std::size_t(effect)].parameters[std::size_t(parameter)].prior;
  std::vector<WeightedValue> values;
  for (const Judged &j : which.judged)
    if (const Eigen::Index score = score_of(problem, j, effect) + parameter;
        has(j, effect) && j.evidence.draws.rows() > score)
      add_draws(j.evidence.draws, score, prior, weight_of(j), values);
  sort(values);
  return values;
}

EffectRange range_of(const Problem &problem, const Which &which, int effect) {
  const ModelledEffect &e = problem.effects[std::size_t(effect)];
  const Prior &prior = e.parameters[std::size_t(amplitude_of(e))].prior;
  const std::vector<WeightedValue> values = values_of(problem, which, effect, amplitude_of(e));
  EffectRange r;
  r.effect = e.name;
  const auto at = which.inclusion.find(e.name);
  r.inclusion = at == which.inclusion.end() ? 0.0 : at->second;
  r.amplitude = range_of(values);
  r.below95 = quantile(values, 0.95);
  const auto of_prior = [&](double share) { return prior.value(normal_quantile(share)); };
  r.two_sided = of_prior(0.025) < 0.0;
  r.limited = r.two_sided ? r.amplitude.high95 - r.amplitude.low95 <
                                kSaysLess * (of_prior(0.975) - of_prior(0.025))
                          : r.below95 < kSaysLess * of_prior(0.95);
  return r;
}

} // namespace

std::vector<EffectRange> effect_ranges(const Problem &problem, const Which &which) {
  std::vector<EffectRange> out;
  for (int e = 0; e < int(problem.effects.size()); ++e)
    out.push_back(range_of(problem, which, e));
  return out;
}

Range range_of(const Problem &problem, const Which &which, int effect, int parameter) {
  return range_of(values_of(problem, which, effect, parameter));
}

std::vector<ParameterRange> parameter_ranges(const std::vector<Parameter> &base,
                                             const Which &which) {
  std::vector<ParameterRange> out;
  for (std::size_t p = 0; p < base.size(); ++p) {
    std::vector<WeightedValue> all;
    for (const Judged &j : which.judged)
      add_draws(base_draws(j), Eigen::Index(p), base[p].prior, j.probability, all);
    sort(all);
    ParameterRange r;
    r.all = range_of(all);
    double farthest = kMoved * (r.all.high95 - r.all.low95);
    for (const Judged &j : which.judged) {
      if (!j.hypothesis.single() || j.adequacy_p < kBelongs)
        continue;
      std::vector<WeightedValue> here;
      add_draws(j.evidence.draws, Eigen::Index(p), base[p].prior, 1.0, here);
      sort(here);
      const Range moved = range_of(here);
      const double off = std::fabs(moved.median - r.all.median);
      if (off <= farthest)
        continue;
      farthest = off;
      r.moved_by = j.hypothesis.name;
      r.moved = moved;
    }
    out.push_back(r);
  }
  return out;
}

namespace {

/// Share of the unknown that acts like an effect, alone or in a pair.
double like(const Which &which, const std::set<std::string> &names) {
  double sum = 0.0;
  for (const Judged &j : which.judged)
    if (j.hypothesis.kind == Hypothesis::unknown)
      for (const Judged &known : which.judged)
        if (const auto at = j.of_place.find("like " + known.hypothesis.name);
            at != j.of_place.end() && names.count(known.hypothesis.name))
          sum += j.probability * (1.0 - j.by_misfit) * at->second;
  return sum;
}

EffectGroup group_of(const Which &which, const std::vector<std::string> &effects, bool with_none) {
  std::vector<int> members;
  for (const std::string &name : effects)
    members.push_back(which.of(name).hypothesis.on[0]);
  EffectGroup g{effects, with_none, 0.0, 0.0};
  std::set<std::string> sets;
  for (const Judged &j : which.judged) {
    const bool in = j.hypothesis.kind == Hypothesis::effects &&
                    std::any_of(members.begin(), members.end(), [&](int e) { return has(j, e); });
    if (in)
      sets.insert(j.hypothesis.name);
    if (in || (with_none && j.hypothesis.kind == Hypothesis::none))
      g.probability += j.probability;
  }
  g.acts_like = like(which, sets);
  g.probability += g.acts_like;
  return g;
}

bool counts(const Which &which, const std::string &name) {
  const auto at = which.inclusion.find(name);
  return at != which.inclusion.end() && at->second + like(which, {name}) >= kBelongs;
}

} // namespace

std::vector<EffectGroup> effect_groups(const Which &which, const Confounding &confounding) {
  std::vector<EffectGroup> out;
  std::set<std::string> grouped;
  for (const std::vector<std::string> &alike : confounding.indistinguishable) {
    std::vector<std::string> effects;
    for (const std::string &name : alike)
      if (counts(which, name))
        effects.push_back(name);
    if (effects.empty())
      continue;
    grouped.insert(effects.begin(), effects.end());
    const bool with_none = std::find(alike.begin(), alike.end(), "none") != alike.end();
    out.push_back(group_of(which, effects, with_none));
  }
  for (const auto &[name, probability] : which.inclusion)
    if (!grouped.count(name) && counts(which, name))
      out.push_back(group_of(which, {name}, false));
  std::stable_sort(out.begin(), out.end(), [](const EffectGroup &a, const EffectGroup &b) {
    return a.probability > b.probability;
  });
  return out;
}

} // namespace calendem::inference
