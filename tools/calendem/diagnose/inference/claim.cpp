// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/which.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem::inference {

namespace {

constexpr double kCredible = 0.95;
constexpr double kBears = 0.01;         // probability of a hypothesis that bears on the claim
constexpr double kFewestSamples = 30.0; // effective samples of its evidence
// Bayes factor below which an effect beside others is excluded: of those that act, drawn from the
// prior, at most 5 % get so little (Royall, J. Am. Stat. Assoc. 95 (2000) 760); of weak ones more.
constexpr double kExcluded = 0.05;
// Share of the unknown's prior that shows by nothing but that no prediction fits: the p of the best
// is then distributed as p^kMisfit.
constexpr double kByMisfit = 0.25, kMisfit = 0.1;

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

/// Density of the best p where nothing known acts, over 1, that where something does.
double density_of_p(double p) { return kMisfit * std::pow(std::max(p, 1e-300), kMisfit - 1.0); }

/// What no prediction fits speaks for the unknown as much as its p is unlikely otherwise.
void add_misfit(std::vector<Judged> &judged) {
  double prior = 0.0, known = 0.0;
  for (const Judged &j : judged)
    if (predicts(j.hypothesis)) {
      prior += j.hypothesis.prior;
      known += j.probability;
    }
  if (!(prior > 0.0))
    return;
  const double odds = density_of_p(most_adequate(judged)) * known / prior;
  for (Judged &j : judged)
    if (j.hypothesis.kind == Hypothesis::unknown) {
      const double by_misfit = kByMisfit * j.hypothesis.prior * odds;
      j.probability = (1.0 - kByMisfit) * j.probability + by_misfit;
      j.by_misfit = j.probability > 0.0 ? by_misfit / j.probability : 0.0;
    }
}

void set_probabilities(std::vector<Judged> &judged) {
  double top = -INFINITY, sum = 0.0;
  for (const Judged &j : judged)
    if (j.hypothesis.prior > 0.0)
      top = std::max(top, j.evidence.log_evidence);
  for (Judged &j : judged)
    j.probability = j.hypothesis.prior * std::exp(j.evidence.log_evidence - top);
  add_misfit(judged);
  for (const Judged &j : judged)
    sum += j.probability;
  for (Judged &j : judged)
    j.probability /= sum;
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
    if (j.probability > kBears && j.evidence.samples > 1 &&
        j.evidence.effective_samples < kFewestSamples)
      return &j;
  return nullptr;
}

/// How probable it is that only something like the effects of that name acts.
std::string what_acts_alike(const Which &w, const std::string &name) {
  for (const Judged &j : w.judged)
    if (const auto at = j.of_place.find("like " + name);
        at != j.of_place.end() && at->second * j.probability > kBears)
      return fmt::format(" An effect outside the table that acts like it has {:.3g}.",
                         at->second * j.probability);
  return "";
}

bool includes(const Hypothesis &h, const std::vector<int> &effects) {
  return h.kind == Hypothesis::effects && std::all_of(effects.begin(), effects.end(), [&](int e) {
           return std::find(h.on.begin(), h.on.end(), e) != h.on.end();
         });
}

/// What could be claimed.
struct Lead {
  std::string name;
  double probability = 0.0;     ///< that it acts, alone or with something else
  const Judged *best = nullptr; ///< the most probable hypothesis in which it does
};

Lead lead_of(const Which &w, const std::vector<int> &effects) {
  Lead lead;
  for (const Judged &j : w.judged)
    if (includes(j.hypothesis, effects)) {
      lead.probability += j.probability;
      if (!lead.best)
        lead.best = &j;
    }
  for (const Judged &j : w.judged)
    if (j.hypothesis.on == effects && includes(j.hypothesis, effects))
      lead.name = j.hypothesis.name;
  return lead;
}

/// The effects that act whatever acts with them, or the most probable effect or hypothesis.
Lead leading(const Which &w, double enough) {
  std::vector<int> sure;
  Lead most;
  for (const Judged &j : w.judged)
    if (j.hypothesis.single()) {
      const Lead one = lead_of(w, j.hypothesis.on);
      if (one.probability >= enough)
        sure.push_back(j.hypothesis.on[0]);
      if (one.probability > most.probability)
        most = one;
    }
  std::sort(sure.begin(), sure.end());
  const Lead all = sure.empty() ? Lead{} : lead_of(w, sure);
  if (all.best && all.probability >= enough)
    return all;
  if (!sure.empty())
    return most;
  const Judged &best = w.judged.front();
  return best.probability > most.probability ? Lead{best.hypothesis.name, best.probability, &best}
                                             : most;
}

/// Why what leads may not be claimed; empty: it may.
std::string objection(const Which &w, const Lead &lead, const WhichSettings &settings) {
  if (lead.probability < settings.claim_probability)
    return fmt::format("The most probable, {}, has {:.3g}; a claim needs {:g}.{}", lead.name,
                       lead.probability, settings.claim_probability, what_acts_alike(w, lead.name));
  if (const Judged *few = unsettled(w.judged))
    return fmt::format("The evidence of {} rests on {:.0f} samples that count; at least {:g} are "
                       "asked for.",
                       few->hypothesis.name, few->evidence.effective_samples, kFewestSamples);
  if (lead.best->hypothesis.kind == Hypothesis::noise && !settings.noise_seen)
    return fmt::format("Understated errors are the most probable ({:.3g}), but single measurements "
                       "cannot distinguish them from an unknown effect: give a curve with its "
                       "release.",
                       lead.probability);
  if (!predicts(lead.best->hypothesis))
    return "";
  if (lead.best->adequacy_p < settings.adequacy)
    return fmt::format("{} is the most probable, but does not fit (p = {:.2g}).", lead.name,
                       lead.best->adequacy_p);
  if (rests_on_poor(lead.name, settings.poor))
    return fmt::format("{} is the most probable, but its emulators are too poor: more runs.",
                       lead.name);
  for (const ShortRuns &s : lead.best->short_runs)
    return fmt::format("{} has {:.3g}, but only because nothing like it was run so far: {}, which "
                       "looks like it (cosine {:.2f}), reaches {:.2g} of this gap at the end of "
                       "its range.",
                       lead.name, lead.probability, s.rival, s.cosine, s.reached);
  return "";
}

std::string reason(const Which &w, const Lead &lead) {
  const Hypothesis &h = lead.best->hypothesis;
  if (h.kind == Hypothesis::noise)
    return fmt::format("The errors of the measurement are understated, with probability {:.3g}.",
                       lead.probability);
  if (h.kind == Hypothesis::unknown)
    return fmt::format("Probability {:.3g}; the best of what is known fits with p = {:.2g}.",
                       lead.probability, most_adequate(w.judged));
  const double alone = w.of(lead.name).probability;
  if (lead.probability - alone < kBears)
    return fmt::format("Probability {:.3g}, adequacy p = {:.2g}.", lead.probability,
                       lead.best->adequacy_p);
  return fmt::format("Probability {:.3g}: {:.3g} alone, the rest together with something else. "
                     "Adequacy p = {:.2g}.",
                     lead.probability, alone, lead.best->adequacy_p);
}

/// Nothing leads but none, and it has what it lacks with effects that are too small to be seen.
bool nothing_to_be_seen(const Which &w, const WhichSettings &settings) {
  const Judged &best = w.judged.front();
  return best.hypothesis.kind == Hypothesis::none && best.adequacy_p >= settings.adequacy &&
         w.none_to_be_seen >= settings.claim_probability && !unsettled(w.judged) &&
         !rests_on_poor("none", settings.poor);
}

/// Claim and its reason; hypotheses are sorted.
void claim(Which &w, const WhichSettings &settings) {
  w.adequacy_p = 0.0;
  for (auto j = w.judged.rbegin(); j != w.judged.rend(); ++j)
    if (predicts(j->hypothesis))
      w.adequacy_p = j->adequacy_p; // of the first
  w.none_to_be_seen = 0.0;
  for (const Judged &j : w.judged)
    w.none_to_be_seen += j.probability * (1.0 - j.by_misfit) * j.below_limits;
  const Lead lead = leading(w, settings.claim_probability);
  const std::string against = objection(w, lead, settings);
  w.claim = against.empty() ? lead.name : "undecided";
  w.why = against.empty() ? reason(w, lead) : against;
  if (!against.empty() && nothing_to_be_seen(w, settings)) {
    w.claim = "none";
    w.why = fmt::format("None has probability {:.3g}; together with effects too small to be seen "
                        "on these data it is {:.3g}.",
                        w.judged.front().probability, w.none_to_be_seen);
  }
}

void set_inclusion(Which &w) {
  w.inclusion.clear();
  for (const Judged &j : w.judged)
    if (j.hypothesis.single())
      w.inclusion[j.hypothesis.name] = lead_of(w, j.hypothesis.on).probability;
}

/// The effects of what is claimed; empty where none is.
std::vector<int> claimed_effects(const Which &w) {
  for (const Judged &j : w.judged)
    if (j.hypothesis.kind == Hypothesis::effects && j.hypothesis.name == w.claim)
      return j.hypothesis.on;
  return {};
}

/// Prior that these effects act, alone or with others, of hypotheses that were computed.
double prior_of(const Which &w, const std::vector<int> &effects) {
  double sum = 0.0;
  for (const Judged &j : w.judged)
    if (includes(j.hypothesis, effects))
      sum += j.hypothesis.prior;
  return sum;
}

double odds(double probability) { return probability / (1.0 - probability); }

void set_beside(Which &w) {
  w.beside.clear();
  const std::vector<int> claimed = claimed_effects(w);
  if (claimed.empty())
    return;
  const double acts = lead_of(w, claimed).probability, prior = prior_of(w, claimed);
  for (const Judged &j : w.judged) {
    if (!j.hypothesis.single() ||
        includes({Hypothesis::effects, claimed, "", 0.0}, j.hypothesis.on))
      continue;
    std::vector<int> both = claimed;
    both.push_back(j.hypothesis.on[0]);
    const Companion c{j.hypothesis.name, lead_of(w, both).probability / acts,
                      prior_of(w, both) / prior};
    if (c.prior > 0.0 && odds(c.probability) >= kExcluded * odds(c.prior))
      w.beside.push_back(c);
  }
  std::stable_sort(w.beside.begin(), w.beside.end(), [](const Companion &a, const Companion &b) {
    return a.probability > b.probability;
  });
}

void set_credible(Which &w) {
  double sum = 0.0;
  w.set95.clear();
  for (const Judged &j : w.judged) {
    if (sum < kCredible)
      w.set95.push_back(j.hypothesis.name);
    sum += j.probability;
  }
}

void once(Which &w, const WhichSettings &settings, int effects) {
  set_priors(w.judged, settings.priors, effects);
  set_probabilities(w.judged);
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
  set_inclusion(w);
  set_beside(w);
  set_credible(w);
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
      const auto unseen = j.of_place.find(kUnseenPlace);
      j.below_limits = unseen == j.of_place.end() ? 0.0 : unseen->second;
      for (const Judged &known : w.judged)
        if (const auto at = j.of_place.find("like " + known.hypothesis.name);
            at != j.of_place.end())
          j.below_limits += at->second * known.below_limits;
    }
}

} // namespace calendem::inference
