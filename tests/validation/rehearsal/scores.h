// SPDX-License-Identifier: GPL-2.0-or-later
// How good answers are: counts by kind of truth and method, and how probabilities and ranges hold.
#ifndef CALENDEM_TESTS_REHEARSAL_SCORES_H
#define CALENDEM_TESTS_REHEARSAL_SCORES_H

#include "baselines.h"
#include "laboratory.h"
#include <map>

namespace calendem {

/// Length of the gap in the errors, beyond what noise leaves.
double signal_of(const Diagnosis &d);
/// The diagnosis' own.
Answer answer_of(const Diagnosis &d);

class Scores {
public:
  void add(const Truth &truth, double signal, const Answer &answer, const Diagnosis &d);
  void add_probabilities(const Truth &truth, const Diagnosis &d);
  /// Whether 90 % ranges hold the amplitudes of effects that are named.
  void add_ranges(const Truth &truth, const Diagnosis &d, const bank::Bank &spec,
                  const bank::Run &run);
  void print() const;

private:
  struct Count {
    int all = 0;
    int right = 0;   ///< sure, and all that is named is so
    int wrong = 0;   ///< sure, and none of it is
    int in_list = 0; ///< one of several, the right one among them
    int claimed = 0; ///< sure of anything
    int nothing = 0;
  };
  std::map<std::string, std::map<int, Count>> by_method_; ///< by kind of truth
  // Single effects of which nothing is named, but that may be in the sets that reach 95 %.
  int strong_ = 0, strong_first_ = 0, middling_ = 0, middling_found_ = 0;
  int seen_ = 0, unseen_ = 0; ///< changes with a signal of 3 or more; of these, "nothing to see"
  int ranges_ = 0, held_ = 0;
  double hits_[10] = {}, sums_[10] = {}, all_[10] = {}; ///< of probabilities by tenths
};

} // namespace calendem

#endif
