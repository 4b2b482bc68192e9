// SPDX-License-Identifier: GPL-2.0-or-later
// What the inference says, in the words and units of the experiment.
#ifndef CALENDEM_DIAGNOSE_WORDS_H
#define CALENDEM_DIAGNOSE_WORDS_H

#include "diagnose/experiment_data.h"
#include <nlohmann/json.hpp>

namespace calendem {

/// Adds to gap.json: "unit" to the rows of "where"; "name", "unit", "pressure_MPa" to those of
/// "predictions"; to amplitudes the effect's "key" and its "value" in the key's unit; which
/// measurements the bank cannot predict, and the claim in words, as claim_in_words gives it; to
/// "said" where the gap is significant.
void put_in_words(const ExperimentData &data, const BankTable &bank, nlohmann::ordered_json &gap);

/// {"headline", "meaning", "next": [""]} for a gap.json: what the claim means, what to do next.
nlohmann::ordered_json claim_in_words(const nlohmann::ordered_json &gap);

} // namespace calendem

#endif
