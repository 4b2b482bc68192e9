// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/which.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem::inference {

namespace {

constexpr double kCredible = 0.95;
constexpr double kCounts = 0.01; // probability of a hypothesis that bears on the claim
constexpr double kFewest = 30.0; // effective samples of its evidence

double weight_of(const Priors &priors, const std::string &name) {
  const auto at = priors.weight.find(name);
  return at == priors.weight.end() ? 1.0 : at->second;
}

void set_priors(std::vector<Judged> &judged, const Priors &priors, int effects) {
  const double rest = 1.0 - priors.none - priors.unknown;
  const double in_pairs = effects > 1 ? priors.pair_share : 0.0;
  const double pairs = 0.5 * effects * (effects - 1);
  double weights = 0.0;
  for (const Judged &j : judged)
    if (j.hypothesis.kind == Hypothesis::noise || j.hypothesis.single())
      weights += weight_of(priors, j.hypothesis.name);
  for (Judged &j : judged) {
    Hypothesis &h = j.hypothesis;
    if (h.kind == Hypothesis::none)
      h.prior = priors.none;
    else if (h.kind == Hypothesis::unknown)
      h.prior = priors.unknown;
    else if (h.on.size() > 1)
      h.prior = rest * in_pairs / pairs;
    else
      h.prior = rest * (1.0 - in_pairs) * weight_of(priors, h.name) / std::max(weights, 1e-300);
  }
}

void sort_by_probability(std::vector<Judged> &judged) {
  std::stable_sort(judged.begin(), judged.end(),
                   [](const Judged &a, const Judged &b) { return a.probability > b.probability; });
}

void set_probabilities(std::vector<Judged> &judged) {
  double top = -INFINITY, sum = 0.0;
  for (const Judged &j : judged)
    if (j.hypothesis.prior > 0.0)
      top = std::max(top, j.evidence.log_evidence);
  for (Judged &j : judged)
    sum += j.probability = j.hypothesis.prior * std::exp(j.evidence.log_evidence - top);
  for (Judged &j : judged)
    j.probability /= sum;
  sort_by_probability(judged);
}

bool predicts(const Hypothesis &h) {
  return h.kind == Hypothesis::none || h.kind == Hypothesis::effects;
}

double most_adequate(const std::vector<Judged> &judged) {
  double most = 0.0;
  for (const Judged &j : judged)
    if (predicts(j.hypothesis))
      most = std::max(most, j.adequacy_p);
  return most;
}

/// What no prediction fits is unknown: its probability is that of all predictions too.
void give_to_unknown(std::vector<Judged> &judged) {
  double given = 0.0;
  for (Judged &j : judged)
    if (predicts(j.hypothesis)) {
      given += j.probability;
      j.probability = 0.0;
    }
  for (Judged &j : judged)
    if (j.hypothesis.kind == Hypothesis::unknown)
      j.probability += given;
  sort_by_probability(judged);
}

/// Everything rests on the base model, named none.
bool rests_on_poor(const std::string &name, const std::vector<std::string> &poor) {
  const std::string padded = " + " + name + " + ";
  return std::any_of(poor.begin(), poor.end(), [&](const std::string &p) {
    return p == "none" || padded.find(" + " + p + " + ") != std::string::npos;
  });
}

/// A hypothesis that counts and whose integral few samples carry.
const Judged *unsettled(const std::vector<Judged> &judged) {
  for (const Judged &j : judged)
    if (j.probability > kCounts && j.evidence.samples > 1 && j.evidence.effective_samples < kFewest)
      return &j;
  return nullptr;
}

/// How probable it is that only something like the effects of that name acts.
std::string told_alike(const Which &w, const std::string &name) {
  for (const Judged &j : w.judged)
    if (const auto at = j.of_place.find("like " + name);
        at != j.of_place.end() && at->second * j.probability > kCounts)
      return fmt::format(" An effect outside the table that acts like it has {:.3g}.",
                         at->second * j.probability);
  return "";
}

/// Claim and its reason; hypotheses are sorted.
void claim(Which &w, const WhichSettings &settings) {
  const Judged &best = w.judged.front();
  const double adequate = most_adequate(w.judged);
  w.adequacy_p = 0.0;
  for (auto j = w.judged.rbegin(); j != w.judged.rend(); ++j)
    if (predicts(j->hypothesis))
      w.adequacy_p = j->adequacy_p; // of the first
  w.none_to_be_seen = 0.0;
  for (const Judged &j : w.judged)
    w.none_to_be_seen += j.probability * j.below_limits;
  const std::string &name = best.hypothesis.name;
  const Judged *few = unsettled(w.judged);
  w.claim = "undecided";
  if (best.hypothesis.kind == Hypothesis::noise && !few && !settings.noise_seen &&
      best.probability >= settings.claim_probability) {
    w.why = fmt::format(
        "Understated errors are the most probable ({:.3g}), but single "
        "measurements cannot distinguish them from an unknown effect: give a curve with "
        "its release.",
        best.probability);
  } else if (best.hypothesis.kind == Hypothesis::noise && !few &&
             best.probability >= settings.claim_probability) {
    w.claim = name;
    w.why = fmt::format("The errors of the measurement are understated, with probability {:.3g}.",
                        best.probability);
  } else if (adequate < settings.nothing_fits && best.hypothesis.kind == Hypothesis::unknown &&
             best.probability >= settings.claim_probability) {
    w.claim = name;
    w.why = fmt::format("No hypothesis fits: the best has p = {:.2g}, at least {:g} is asked for.",
                        adequate, settings.nothing_fits);
  } else if (best.probability < settings.claim_probability &&
             best.hypothesis.kind == Hypothesis::none && !few &&
             best.adequacy_p >= settings.adequacy &&
             w.none_to_be_seen >= settings.claim_probability &&
             !rests_on_poor(name, settings.poor)) {
    w.claim = name;
    w.why = fmt::format("None has probability {:.3g}; together with effects too small to be seen "
                        "on these data it is {:.3g}.",
                        best.probability, w.none_to_be_seen);
  } else if (best.probability < settings.claim_probability) {
    w.why = fmt::format("The most probable, {}, has {:.3g}; a claim needs {:g}.{}", name,
                        best.probability, settings.claim_probability, told_alike(w, name));
  } else if (few) {
    w.why = fmt::format("The evidence of {} rests on {:.0f} samples that count; at least {:g} are "
                        "asked for.",
                        few->hypothesis.name, few->evidence.effective_samples, kFewest);
  } else if (best.adequacy_p < settings.adequacy) {
    w.why = fmt::format("{} is the most probable, but does not fit (p = {:.2g}).", name,
                        best.adequacy_p);
  } else if (rests_on_poor(name, settings.poor)) {
    w.why =
        fmt::format("{} is the most probable, but its emulators are too poor: more runs.", name);
  } else {
    w.claim = name;
    w.why =
        fmt::format("Probability {:.3g}, adequacy p = {:.2g}.", best.probability, best.adequacy_p);
  }
}

void set_lists(Which &w) {
  double sum = 0.0;
  w.set95.clear();
  w.inclusion.clear();
  for (const Judged &j : w.judged) {
    if (sum < kCredible)
      w.set95.push_back(j.hypothesis.name);
    sum += j.probability;
    if (j.hypothesis.kind != Hypothesis::effects)
      continue;
    for (const Judged &single : w.judged)
      if (single.hypothesis.single())
        for (const int e : j.hypothesis.on)
          if (e == single.hypothesis.on[0])
            w.inclusion[single.hypothesis.name] += j.probability;
  }
}

void once(Which &w, const WhichSettings &settings, int effects) {
  set_priors(w.judged, settings.priors, effects);
  set_probabilities(w.judged);
  if (most_adequate(w.judged) < settings.nothing_fits)
    give_to_unknown(w.judged);
  claim(w, settings);
}

} // namespace

void decide(Which &w, const WhichSettings &settings, int effects) {
  struct Change {
    const char *what;
    double Priors::*which;
    double factor;
  };
  const Change changes[] = {{"none halved", &Priors::none, 0.5},
                            {"none 1.5 times", &Priors::none, 1.5},
                            {"unknown halved", &Priors::unknown, 0.5},
                            {"unknown doubled", &Priors::unknown, 2.0},
                            {"pairs a quarter", &Priors::pair_share, 0.25},
                            {"pairs doubled", &Priors::pair_share, 2.0}};
  w.sensitivity.clear();
  for (const Change &c : changes) {
    WhichSettings other = settings;
    other.priors.*c.which = std::min(0.9, settings.priors.*c.which * c.factor);
    if (other.priors.none + other.priors.unknown >= 1.0)
      continue;
    once(w, other, effects);
    w.sensitivity.push_back({c.what, w.claim, w.judged.front().probability});
  }
  once(w, settings, effects);
  set_lists(w);
}

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
