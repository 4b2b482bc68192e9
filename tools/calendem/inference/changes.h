// SPDX-License-Identifier: GPL-2.0-or-later
// In what the world may differ from the user's model, read from the draws of a posterior; and what may
// be said of it: one rule.
#ifndef CALENDEM_INFERENCE_CHANGES_H
#define CALENDEM_INFERENCE_CHANGES_H

#include "inference/local_model.h"

namespace calendem::inference {

/// The model has the effects that act with a probability above one half before the data, and no other.
inline bool is_of_model(const EffectPrior &effect) { return effect.probability > 0.5; }

/// One way in which the world may differ from the model.
struct Change {
  enum Kind {
    added,       ///< an effect acts that the model lacks
    absent,      ///< one that the model has does not act
    fault,       ///< of the press or of a reading, in the film
    understated, ///< the film's errors are larger than stated
    something    ///< the discrepancy shows: something that no effect of the table does
  };
  Kind kind = added;
  int effect = -1;          ///< place in the problem, of the first three
  double prior = 0.0;       ///< probability before the data
  double probability = 0.0; ///< after them, whatever else changed
  double bayes_factor = 0.0;
};

/// Changes in the draws of a posterior: those of one film and its material.
struct Changes {
  std::vector<Change> all;
  Matrix on;      ///< draws x changes: 1 where it is so, else 0
  Vector weights; ///< of the draws; their sum is 1

  /// Odds that any of these is so, over those before the data.
  double bayes_factor(const std::vector<int> &of) const;
  /// Probability that any of these is so.
  double probability(const std::vector<int> &of) const;
};
/// `shows`: the size from which on the discrepancy counts as a change.
Changes changes_of(const PosteriorProblem &problem, const Posterior &posterior, int film,
                   double shows);

/// Changes that are so together, and no other of those that the data speak for.
struct ChangeSet {
  std::vector<int> changes; ///< places in Changes::all; empty: none
  double probability = 0.0;
};
/// Most probable first, until they reach `share`. Changes whose Bayes factor is 1 or less are summed
/// over: the data say nothing of them, or speak against them.
std::vector<ChangeSet> ranked_sets(const Changes &changes, double share = 0.95);

/// For each draw the place of its set among these; their number: none of them.
std::vector<int> sets_of_draws(const Changes &changes, const std::vector<ChangeSet> &sets);

/// The answer that a posterior allows.
struct Verdict {
  enum Kind {
    explained,      ///< by `changes`, each of which is so
    one_of,         ///< `changes`: which of them, these data do not say
    something_else, ///< that no effect of the table does
    nothing_seen    ///< nothing that these data could show
  };
  Kind kind = nothing_seen;
  std::vector<int> changes; ///< the most probable first
  double probability = 0.0; ///< least of those that explain; else that one of them is so
};

// A change, or a group of which one is so, is named from this probability on, ...
inline constexpr double kCertain = 0.8;
// ... if the data speak for it by this Bayes factor: "strong" (Kass and Raftery, J. Am. Stat. Assoc.
// 90 (1995) 773, table 1, from 20 on; Jeffreys from 10). A large group is probable before any data.
inline constexpr double kStrong = 10.0;
// What is below this Bayes factor is "not worth more than a bare mention" (the same).
inline constexpr double kMention = 3.0;
// A model that fits worse than this p-value, whatever acts, explains nothing.
inline constexpr double kFits = 0.01;

/// Changes that are certain and strong explain the gap. Else a group is named of which one is so: changes
/// that exclude each other in the draws. Else, if the model's own residuals are `significant` or the
/// changes together are worth a mention, those of the most probable sets. Else nothing is seen. Where
/// the discrepancy is alone in what is named, or nothing fits (`adequacy`), it is something else.
Verdict verdict_of(const Changes &changes, double adequacy, bool significant);

/// Posterior predictive p-value of all data (Gelman, Meng and Stern 1996): the probability of a
/// larger square of the residuals in their covariance, averaged over the draws.
double adequacy_of(const PosteriorProblem &problem, const Posterior &posterior);

} // namespace calendem::inference

#endif
