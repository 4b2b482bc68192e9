// SPDX-License-Identifier: GPL-2.0-or-later
// The user's model and the leading explanation, simulated: how far the gap really closes.
#ifndef CALENDEM_DIAGNOSE_RUN_AGAIN_H
#define CALENDEM_DIAGNOSE_RUN_AGAIN_H

#include "diagnose/diagnosis.h"
#include "simulate/study.h"

namespace calendem {

/// "runs" of "shrink" of gap.json: each model at `runs` of its draws, each on a packing of its own,
/// beside what was measured. Throws Failure as make_study, and Failure(3) where a model has no runs.
nlohmann::ordered_json run_again(const Diagnosis &diagnosis, const FilmBank &bank,
                                 const Recipe &recipe, int runs, const StudyOptions &options);

/// What one run reads of each of the film's readings: NaN of those that went to another pressure.
inference::Vector readings_of_run(const Diagnosis &diagnosis, const PressInstruments &press,
                                  const SimulatedRun &run);

} // namespace calendem

#endif
