// SPDX-License-Identifier: GPL-2.0-or-later
// sealed answer: a diagnosis of every case that was handed out.
#ifndef CALENDEM_TESTS_VALIDATION_SEALED_ANSWER_H
#define CALENDEM_TESTS_VALIDATION_SEALED_ANSWER_H

#include "diagnose/inference/diagnosis.h"
#include <map>
#include <string>
#include <vector>

namespace calendem {

struct AnswerOptions {
  std::string handed_out, folder, bank, table;
  int jobs = 1;
  int rerun_packings = 0; ///< of every model that is run again; 0: none is
  std::string liggghts;   ///< for that
};

/// Throws Failure(2) if truths lie in the folder or beside it, or if its files lead out of it.
void check_handed_out(const std::string &folder);

/// Writes for every case NNN/gap.json, NNN/gap_without.json (the same without the effect that was
/// the most probable) and NNN/baselines.json, and last answers.json with their hashes: without
/// each case's own effect the right answer is "unknown", and leaving out what the diagnosis itself
/// names gives nothing away. With reruns also NNN/shrink.json where an effect is claimed: base
/// model, effect and placebo, run again on the highest pressure. Of an intervention gap.json is the
/// diagnosis of what changed; nothing is left out, run again or answered by baselines. Reads nothing but `handed_out`,
/// the bank and its table. Cases that are answered from the same files are not answered again.
void answer_round(const AnswerOptions &options);

// Simple ways to name an effect from the same emulators, which a diagnosis must beat.

/// What each baseline names:
/// - always none;
/// - largest residual: if a block is beyond the threshold, the effect that puts the largest share
///   of its signature into the largest block;
/// - cosine match: if the residual is beyond the 95 % point of chi-squared, the effect whose
///   signature has the largest cosine with it;
/// - history matching: none if its best fit lies within three standard deviations of every feature,
///   else the effect whose largest such distance is least (Vernon, Goldstein, Bower, Bayesian Anal.
///   5 (2010) 619);
/// - BIC: the least -2 ln L + k ln n (Schwarz, Ann. Stat. 6 (1978) 461) of none and each effect,
///   with L at the mode of likelihood times prior.
/// Residuals are those of the recalibrated base model, signatures those of amplitudes one standard
/// score to either side of the prior's middle, in the metric in which recalibration is free.
std::map<std::string, std::string> baselines(const inference::Problem &problem,
                                             const inference::Diagnosis &diagnosis);

} // namespace calendem

#endif
