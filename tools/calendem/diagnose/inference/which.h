// SPDX-License-Identifier: GPL-2.0-or-later
// Which hypothesis explains the gap, and whether that may be claimed; where an effect that no table
// has may act, and how; which further measurement would distinguish the leading hypotheses.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_WHICH_H
#define CALENDEM_DIAGNOSE_INFERENCE_WHICH_H

#include "diagnose/inference/evidence.h"
#include "diagnose/inference/hypothesis.h"
#include <map>

namespace calendem::inference {

/// Prior probabilities. What none and unknown leave is shared: pairs get `pair_share` of it in
/// equal parts for all pairs there are, computed or not; single ones the rest by weight.
struct Priors {
  double none = 0.4, unknown = 0.25, pair_share = 0.1;
  std::map<std::string, double> weight; ///< of single effects and noise; 1 where not named
};

struct WhichSettings {
  Priors priors;
  bool noise = true; ///< "noise" (understated errors) is a hypothesis
  int pairs = 20;    ///< most promising pairs, which are computed; so are those of the best effect
  int beside = 2;    ///< best single effects beside which the unknown is sought
  double claim_probability = 0.8; ///< a name is claimed from here on
  double adequacy = 0.05;         ///< and only with at least this p
  /// Points of a curve show how large errors are; without them noise is not claimed: a single
  /// measurement cannot distinguish a large error from an unknown effect.
  bool noise_seen = true;
  std::vector<std::string> poor; ///< effects whose emulators are too poor to be claimed
  EvidenceSettings evidence;
};

/// An effect that looks like another one, and was not run as far as that is needed here.
struct ShortRuns {
  std::string effect, rival; ///< rival: whose runs end
  double cosine = 0.0;       ///< of the two signatures, beyond recalibration
  double reached = 0.0; ///< length of the rival's strongest signature over that of the effect's
};

struct Judged {
  Hypothesis hypothesis;
  Evidence evidence;
  double adequacy_p = 1.0; ///< of its best fit; 1 for unknown and noise, which fit anything
  double probability = 0.0;
  std::string place;                      ///< of unknown: the most probable of its places
  std::map<std::string, double> of_place; ///< of unknown: share of its posterior by place
  /// Share of its posterior in which all its effects are too small to be seen; 0: not known.
  double below_limits = 0.0;
  /// Share of the unknown's probability that rests on nothing known fitting the data.
  double by_misfit = 0.0;
  /// Scores of the base parameters beside the unknown, where it may move what they move, too; as
  /// many draws as of the evidence, over all places. Empty: those of the evidence.
  Matrix base_draws;
  std::vector<ShortRuns> short_runs; ///< of its effects, where it fits best
};

/// An effect that may act beside those that are claimed.
struct Companion {
  std::string effect;
  double probability = 0.0; ///< that it acts too, given that the claimed ones do
  double prior = 0.0;       ///< the same before the data
};

/// The claim, had the priors been others.
struct Sensitivity {
  std::string change, claim;
  double probability = 0.0; ///< of the most probable
};

struct Which {
  std::string claim;              ///< an effect, a pair "a + b", none, noise, unknown or undecided
  std::string why;                ///< one sentence
  double none_to_be_seen = 0.0;   ///< probability that no effect is above its limit
  double adequacy_p = 0.0;        ///< of the best hypothesis that makes a prediction
  std::vector<Judged> judged;     ///< most probable first
  std::vector<std::string> set95; ///< most probable first, until 95 %
  std::map<std::string, double> inclusion; ///< of each effect: alone or in a pair
  /// Where effects are claimed: others that these data do not exclude beside them, as the odds that
  /// they act too are at least a twentieth of what they were before the data. Most probable first.
  std::vector<Companion> beside;
  std::vector<Sensitivity> sensitivity;
  Linearised base; ///< about the recalibrated base model
  /// Covariance of the discrepancy of one standard deviation at its most probable place.
  Matrix unknown;

  const Judged &of(const std::string &name) const;
};

/// Adequacy: (observed - predicted)^2 / covariance + scores^2 at the scores where that and ln of the
/// covariance's determinant are least is chi-squared with as many degrees of freedom as features in
/// the linear-Gaussian case, n F(n, nu) with an estimated covariance; p is the chance of more.
/// Without the determinant an amplitude whose emulators are uncertain would grow until anything
/// fits. Nothing is lost to recalibration because the priors count as data. Claim: see `why`; effects by how probable it is that they act,
/// alone or in pairs.
/// The unknown acts like a known effect or pair, but for half of the signature's length (0.48 of its
/// prior, shared as among the known); or is too small to be seen (0.4); or sits everywhere (0.048),
/// in one stage, one observable of it, one block or one truncation residual (0.048 in equal parts),
/// or beside a known effect (0.024 in equal parts for all effects, the best of which are computed). Its evidence is the mean over
/// these (3/4), and (1/4) that of the known ones times 0.1 p^-0.9, p of the best that predicts:
/// where something unknown acts that is how p is distributed, where not it is uniform.
Which which(const Problem &problem, const WhichSettings &settings);

/// The rule alone, on hypotheses that have evidence and adequacy: sets probabilities and sorts.
/// Once limits are set, none is claimed too where it is the most probable and fits, and no effect
/// above its limit is as probable as a claim asks for: what is too small to be seen can never be
/// excluded. `effects`: how many single effects there are.
void decide(Which &which, const WhichSettings &settings, int effects);

/// How much of every effect and pair lies below `limits` (amplitudes, by effect; NaN: it cannot be
/// seen at all), for another decide.
void set_limits(Which &which, const Problem &problem, const std::vector<double> &limits);

/// Finds the rivals whose cosine with an effect of the hypothesis is 0.85 or more and whose runs end
/// before half the length of its signature, for another decide: where it is named because nothing
/// like it was run so far, it is not named. Instruments' effects are computed for any amplitude and
/// are no rivals, nor can others stand in for them.
void set_short_runs(Which &which, const Problem &problem);

struct UnknownPlace {
  std::string name;
  double share = 1.0; ///< of the unknown's prior
  Matrix unknown;     ///< covariance of the discrepancy, off what recalibration can do
  Hypothesis hypothesis;
  Matrix anywhere; ///< the same with what recalibration can do
};

/// The place of an unknown that these data do not show; its evidence is that of none.
extern const char *const kUnseenPlace;

/// All that are worth computing: their shares sum to less than 1 where others cannot matter.
/// `best`: the effects beside which the unknown is sought; `so_far`: hypotheses with their
/// evidence.
std::vector<UnknownPlace> unknown_places(const Problem &problem, const Which &so_far,
                                         const std::vector<int> &best, const Priors &priors);

/// A measurement that could be made. In `extended` the features are those of the diagnosis followed
/// by the new ones, `observed` holds the former only, and effects are the same.
struct Extension {
  std::string what;
  double cost = 0.0; ///< in any one unit
  Problem extended;
};

struct NextMeasurement {
  std::string what;
  double cost = 0.0;
  double now = 0.0;                  ///< expected probability of the right hypothesis as it is
  double expected_probability = 0.0; ///< and with the measurement
  double per_cost = 0.0;             ///< gain over cost; 0 where no cost is given
};

struct NextSettings {
  int leading = 5;       ///< hypotheses at most
  double covered = 0.99; ///< of probability, by those
  int simulations = 400; ///< of the new data, for each of them
  unsigned long long seed = 1;
};

/// Largest expected probability first. Under each leading hypothesis the new features are normal
/// with the moments of its posterior draws, given what was observed; new data are drawn from each
/// hypothesis in turn and judged by all (expected posterior probability of the true model, Lindley,
/// Ann. Math. Stat. 27 (1956) 986 with another utility).
std::vector<NextMeasurement> next_measurements(const Which &which,
                                               const std::vector<Extension> &candidates,
                                               const NextSettings &settings);

} // namespace calendem::inference

#endif
