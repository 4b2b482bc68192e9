// SPDX-License-Identifier: GPL-2.0-or-later
// calendem withheld score: opens the truths and judges the answers.
#ifndef CALENDEM_WITHHELD_SCORE_H
#define CALENDEM_WITHHELD_SCORE_H

#include "withheld/metrics.h"
#include <nlohmann/json_fwd.hpp>

namespace calendem {

/// Truths and answers of a round. Throws Failure: 4 if a truth, what was handed out or an answer
/// is not what its hash says, 2 if files are missing.
std::vector<ScoredCase> open_round(const std::string &folder, const std::string &answers);

/// One case from its truth and its answer; `without`: the answer without its own effect, which
/// is a case of its own where that was the truth's only effect; `shrink`: of models run again, an
/// empty object where none was.
void add_cases(const nlohmann::json &truth, const nlohmann::json &gap,
               const nlohmann::json &without, const nlohmann::json &baselines,
               const nlohmann::json &shrink, std::vector<ScoredCase> &out);

/// Writes scores.json, scores.md and scores.html into `folder`.
void write_scores(const std::vector<ScoredCase> &cases, const std::string &round,
                  const std::string &folder);

void score_round(const std::string &round, const std::string &answers, const std::string &folder);

} // namespace calendem

#endif
