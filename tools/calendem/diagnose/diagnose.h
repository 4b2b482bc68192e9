// SPDX-License-Identifier: GPL-2.0-or-later
// The diagnosis of one experiment against a bank's table, as gap.json holds it.
#ifndef CALENDEM_DIAGNOSE_DIAGNOSE_H
#define CALENDEM_DIAGNOSE_DIAGNOSE_H

#include "diagnose/experiment_data.h"
#include "diagnose/inference/diagnosis.h"
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

namespace calendem {

/// The table without the effects that may not be named. Throws Failure(2) for names of no effect.
BankTable without_effects(BankTable table, const std::vector<std::string> &names);

/// In what the sample is not the bank's electrode, in words; empty: in nothing.
std::string other_than_bank(const Experiment &experiment, const BankSpec &bank);

/// How many of the bank's cells the sample is as large as. Throws Failure(2) if its size is not
/// known.
double cells_of(const Experiment &experiment, const BankSpec &bank);

/// What was learnt from a bank depends on observables and their covariance, not on measured values:
/// experiments of the same layout share it. May be used by several threads.
class SharedModels {
public:
  std::shared_ptr<const inference::Model> of(const ExperimentData &data,
                                             const inference::ModelSettings &settings);

private:
  std::mutex guard_;
  std::map<std::string, std::shared_ptr<const inference::Model>> models_;
};

struct Diagnosed {
  inference::Diagnosis diagnosis;
  std::shared_ptr<const inference::Model> model;
  ExperimentData data;
  nlohmann::ordered_json gap; ///< gap.json without the hashes of files
};

/// `cells`: 0: from the sample's size. Throws Failure(2) if nothing can be compared.
Diagnosed diagnosed(const Experiment &experiment, const BankTable &table, double cells,
                    SharedModels &models);

/// What changed from one experiment to the other, whose conditions have the same ids: an effect that
/// is on after it and was not before. Readings' and specimens' errors count twice, those of the
/// press and of the bank's numerics cancel. Throws Failure(2) if nothing was measured in both.
Diagnosed diagnosed_change(const Experiment &before, const Experiment &after,
                           const BankTable &table, double cells);

// What the inference says, in the words and units of the experiment.

/// Adds to gap.json: "unit" to the rows of "where"; "name", "unit", "pressure_MPa" to those of
/// "predictions"; to amplitudes the effect's "key" and its "value" in the key's unit; to
/// "which" what may be "said" of each effect, the measurements that the bank cannot predict, and the
/// claim in words, as claim_in_words gives it; to "said" where the gap is significant.
void put_in_words(const ExperimentData &data, const BankTable &bank, nlohmann::ordered_json &gap);

/// How far, with what noise alone would leave, in one sentence: of "before", "after", "noise_floor".
std::string shrinkage_in_words(const nlohmann::ordered_json &shrink);

/// {"answer", "headline", "meaning", "next": [""]} for a gap.json: what the claim means, what to do
/// next. Answers: "explained", "one of these", "something else" (that no model here has), "nothing
/// to see" (that these data could show).
nlohmann::ordered_json claim_in_words(const nlohmann::ordered_json &gap);

} // namespace calendem

#endif
