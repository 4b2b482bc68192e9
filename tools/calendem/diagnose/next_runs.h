// SPDX-License-Identifier: GPL-2.0-or-later
// What further measurements would give, simulated: the leading explanations, each where it fits best,
// pressed as that measurement would be. A bank need not have such runs.
#ifndef CALENDEM_DIAGNOSE_NEXT_RUNS_H
#define CALENDEM_DIAGNOSE_NEXT_RUNS_H

#include "diagnose/rerun.h"

namespace calendem {

/// A measurement that runs can make.
struct NextRun {
  std::string name; ///< of MeasurementPrice
  std::string what; ///< how it is simulated
  std::string reading, unit;
  double sd = 0.0; ///< of the reading
  /// Changed for it: values of "case.…" and "recipe.…" keys. Empty: the run is the usual one.
  std::map<std::string, double> changed;
  /// Reads it from its run and the usual one of the same model and packing; NaN: it cannot be read.
  double (*read)(const std::string &folder, const std::string &usual_folder);
};

/// At this largest pressure, of the bank's electrode and case.
std::vector<NextRun> next_runs(const BankSpec &bank, double pressure_MPa);

/// Explanations worth telling apart: none and effects with a probability of 5 % or more, four at
/// most, and those that look like the leading one but were not run as far, each where it fits all
/// data best. Fewer than two: there is nothing to tell apart.
std::vector<RerunModel> models_to_part(const Diagnosed &diagnosed);

/// A reading under a model: mean over packings and its standard error.
struct SimulatedReading {
  double mean = 0.0, error = 0.0;
};

/// By how many standard deviations two readings differ, of measurement and means together.
double apart(const SimulatedReading &a, const SimulatedReading &b, double sd);

/// For each model the packings; for each packing the usual run, then one for each measurement that
/// has a run of its own. `film` as in model_values.
Study next_study(const BankSpec &bank, const std::vector<RerunModel> &models,
                 const std::vector<NextRun> &next, double pressure_MPa, int packings, double film);

/// Makes the runs and returns "next" of gap.json: of each measurement the reading under each model,
/// and how well each two models are parted. Throws Failure as make_study.
nlohmann::ordered_json simulate_next(const Experiment &experiment, const BankTable &table,
                                     const std::vector<RerunModel> &models,
                                     const RerunOptions &options);

} // namespace calendem

#endif
