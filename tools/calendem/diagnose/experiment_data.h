// SPDX-License-Identifier: GPL-2.0-or-later
// An experiment file and a bank's table as what the inference works on.
#ifndef CALENDEM_DIAGNOSE_EXPERIMENT_DATA_H
#define CALENDEM_DIAGNOSE_EXPERIMENT_DATA_H

#include "diagnose/bank/bank_table.h"
#include "diagnose/error_model.h"
#include "diagnose/inference/model.h"

namespace calendem {

/// What pages call a number.
struct ValueLabel {
  std::string name, unit; ///< of a point of a curve: "displacement at 40 MPa"
  double pressure = 0.0;  ///< MPa: the point's, or the condition's largest
};

struct ExperimentData {
  inference::Bank bank; ///< what each run of the table would show of the experiment, and of `next`
  inference::ObservableVector experiment;
  std::vector<ValueLabel> labels;         ///< of the experiment's numbers
  std::vector<ErrorTerm> terms;           ///< of the experiment's covariance, beside its readings
  inference::Specimens specimens;         ///< of its conditions
  std::vector<inference::Candidate> next; ///< measurements to come that the bank can predict
  std::vector<std::string> not_said;      ///< what is left out or assumed, and why
};

/// The observables of the conditions named in `conditions` (all if it is empty), specimens that
/// were pressed alike as one. A run to a pressure between two of the bank's is interpolated; errors
/// that observables share are terms. Where the bank has runs on the full cell, all are shifted by what a
/// film as thick as the sample's differs from the bank's. What happens at the film's faces (effects
/// of the layer "boundary", instruments that show micrometres) counts by the ratio of the films'
/// solid columns. Throws Failure(2) if nothing is left to
/// compare.
ExperimentData data_of(const Experiment &experiment, const BankTable &table,
                       const std::vector<std::string> &conditions);
/// With the runs on the full cell of another table, for runs in that table's cell.
ExperimentData data_of(const Experiment &experiment, const BankTable &table,
                       const std::vector<std::string> &conditions, const BankTable &full_cell);

/// The effect's amplitude as a parameter of the inference.
inference::ModelledEffect inference_effect(const Effect &effect);

} // namespace calendem

#endif
