// SPDX-License-Identifier: GPL-2.0-or-later
// What the inference says, in the words and units of the experiment.
#ifndef CALENDEM_DIAGNOSE_WORDS_H
#define CALENDEM_DIAGNOSE_WORDS_H

#include "diagnose/experiment_data.h"
#include <nlohmann/json.hpp>

namespace calendem {

/// Adds to gap.json: "unit" to the rows of "where"; "name", "unit", "pressure_MPa" to those of
/// "predictions"; to amplitudes the effect's "key" and its "value" in the key's unit; to
/// "which.effects" what may be "said" of each; which
/// measurements the bank cannot predict; and "said", the claim in words.
void put_in_words(const ExperimentData &data, const BankTable &bank, nlohmann::ordered_json &gap);

/// How far, with what noise alone would leave, in one sentence: of "before", "after", "noise_floor".
std::string how_far_in_words(const nlohmann::ordered_json &shrink);

/// {"answer", "headline", "meaning", "next": [""]} for a gap.json: what the claim means, what to do
/// next. Answers: "explained", "one of these", "something else" (that no model here has), "nothing
/// to see" (that these data could show).
nlohmann::ordered_json claim_in_words(const nlohmann::ordered_json &gap);

} // namespace calendem

#endif
