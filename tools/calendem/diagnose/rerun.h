// SPDX-License-Identifier: GPL-2.0-or-later
// How far the gap shrinks once an effect is in: base model and effect, both recalibrated on the
// training conditions, are run again for the held-out ones on packings that nothing has seen.
#ifndef CALENDEM_DIAGNOSE_RERUN_H
#define CALENDEM_DIAGNOSE_RERUN_H

#include "diagnose/diagnose.h"
#include "diagnose/held_out.h"
#include "simulate/study.h"

namespace calendem {

/// One model that is run again.
struct RerunModel {
  std::string role; ///< before, after (the leading effect, claimed or not), runner-up, placebo
  std::string hypothesis;   ///< none, an effect, or "a + b"
  std::vector<double> base; ///< base parameters at their mode on the training conditions
  std::map<std::string, double> effect; ///< value of the effect's key, by name
  Estimate predicted;                   ///< gap on the held-out conditions by the emulators
};

/// Models worth running: always the base model; the leading effect unless the claim is none; with a
/// claimed effect its runner-up and, as placebo, the effect that the data speak against most.
/// `cells` as in diagnosed(). Empty if the experiment has no split or nothing held out can be
/// compared.
std::vector<RerunModel> models_to_rerun(const Experiment &experiment, const BankTable &table,
                                        const Diagnosed &diagnosed, double cells);

/// What was measured on the conditions of the data.
HeldOut held_out_of(const ExperimentData &data);

struct RerunOptions {
  StudyOptions study; ///< folder, program, jobs
  int packings = 4;
  double cells = 1.0; ///< of the bank's, that the measured sample is as large as
};

/// Runs them in the bank's cell and returns "shrink" of gap.json. Throws Failure as make_study.
nlohmann::ordered_json rerun(const Experiment &experiment, const BankTable &table,
                             const std::vector<RerunModel> &models, const RerunOptions &options);

} // namespace calendem

#endif
