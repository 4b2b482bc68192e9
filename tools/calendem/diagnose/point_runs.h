// SPDX-License-Identifier: GPL-2.0-or-later
// A bank's table by points, and what each point's runs give for the conditions of an experiment.
#ifndef CALENDEM_DIAGNOSE_POINT_RUNS_H
#define CALENDEM_DIAGNOSE_POINT_RUNS_H

#include "diagnose/covered.h"
#include "diagnose/inference/linear.h"

namespace calendem {

/// The runs of one point, by target.
using PointRuns = std::vector<const BankRow *>;

/// How a press shows a run.
using Shows = std::function<SimulatedRun(const SimulatedRun &)>;

/// Points that have all their runs, beside a base point that has. How many are left out is told in
/// `not_said`. The rows stay the table's.
std::vector<PointRuns> points_of(const BankTable &table, std::vector<std::string> &not_said);

/// Values of all observables at one point; NaN where a run does not have it. A pressure between
/// two runs' is interpolated.
inference::Vector values_of(const std::vector<Covered> &all, const PointRuns &runs,
                            const Shows &see);

/// How thick the bank's films are beside the experiment's, without pores: mean of the base points.
/// What a run's loading differs from that is a base parameter, not a film of another recipe. NaN
/// without base points.
double film_ratio(const Experiment &experiment, const BankTable &bank);

/// Change of each observable by one standard deviation of the press's pressure, mean of the base
/// model's points.
inference::Vector by_pressure(const std::vector<Covered> &all,
                              const std::vector<PointRuns> &points);

} // namespace calendem

#endif
