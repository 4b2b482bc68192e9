// SPDX-License-Identifier: GPL-2.0-or-later
// A bank's table by points: what each point's runs give for the conditions of an experiment, and how
// rough a measured curve is beside them.
#ifndef CALENDEM_DIAGNOSE_BANK_POINTS_H
#define CALENDEM_DIAGNOSE_BANK_POINTS_H

#include "diagnose/bank/bank_table.h"
#include "compare/observables.h"
#include "diagnose/inference/problem.h"
#include "inference/numerics.h"
#include <cmath>
#include <functional>
#include <optional>

namespace calendem {

// The conditions of an experiment that a bank covers, and what could be measured on them beside
// what was.

struct CoveredCondition {
  Condition condition;
  double pressure; ///< MPa
  std::vector<Observable> observables;
  int specimens = 1; ///< of which these are means
  /// Where the bank's runs for it went [MPa]: to its pressure, or to one below and one above.
  std::vector<double> runs = {};
};

/// The run went to the condition's pressure, in its way of pressing.
inline bool pressed_as(const SimulatedRun &run, const Condition &c) {
  return run.pressing == c.pressing && c.max_pressure_MPa &&
         same_pressure(run.target, c.max_pressure_MPa->value);
}

/// Pressures to which enough points of the bank were run, pressed in that way, to learn from them
/// [MPa]: of the base model and of every effect, or if not `with_effects` of the base model. Enough
/// are as many as can be learnt from, or all there are.
std::vector<double> pressures_learnt(const BankTable &table, bool with_effects,
                                     const std::string &pressing = "");

/// The pressure itself if it is one of `pressures` (increasing), or those next to it on either
/// side; none outside.
std::vector<double> beside(double pressure, const std::vector<double> &pressures);

/// The conditions named in `wanted` (all if it is empty) whose pressure the bank reaches, by runs to
/// pressures that every effect can be learnt at, if there are such on either side. What is
/// left out, and why, is reported in `not_said`. A sample of unknown loading has the recipe's
/// within 3 % where the bank's film carries another: micrometres of one film say nothing of
/// another.
std::vector<CoveredCondition> covered_conditions(const Experiment &experiment,
                                                 const BankTable &table,
                                                 const std::vector<std::string> &wanted,
                                                 std::vector<std::string> &not_said);

/// A measurement that was not made: what it would give, without measured values.
struct Further {
  std::string what;
  double hours = 0.0; ///< of work, for all its samples
  std::vector<CoveredCondition> of;
};

/// Measurements that the table can predict: each kind on the covered conditions that lack it, and
/// porosities after the bank's other pressures with effects, whose uncertainty is that of the
/// others. The pressure's error counts as independent of that in what was measured already.
std::vector<Further> further_measurements(const Experiment &experiment, const BankTable &table,
                                          const std::vector<CoveredCondition> &covered);

/// The runs of one point, by target.
using PointRuns = std::vector<const BankRow *>;

/// How a press shows a run.
using Shows = std::function<SimulatedRun(const SimulatedRun &)>;

/// A press that shows a run as it is.
SimulatedRun as_it_is(const SimulatedRun &run);

/// What a condition needs a run to: a pressure [MPa], in that way of pressing.
struct PressedTo {
  double pressure = 0.0;
  std::string pressing = {};
};

/// Points that were run to all of `wanted`, beside a base point that was, with all their runs.
/// The number left out is reported in `not_said`. The rows stay the table's.
std::vector<PointRuns> points_of(const BankTable &table, const std::vector<PressedTo> &wanted,
                                 std::vector<std::string> &not_said);

/// The run to that pressure; null: there is none.
const BankRow *run_to(const PressedTo &wanted, const PointRuns &runs);

/// The runs that the conditions need, each once.
std::vector<PressedTo> runs_for(const std::vector<CoveredCondition> &all);

/// To which points of the effect were run in that way, increasing.
std::vector<double> pressures_of(const std::string &effect, const BankTable &table,
                                 const std::string &pressing = "");

/// The point's run to a condition's pressure, as a press shows it; none: it has not the runs.
std::optional<SimulatedRun> run_at(const PointRuns &runs, const CoveredCondition &condition,
                                   const Shows &see);

/// Values of all observables at one point; NaN where it has no run for the condition, or the run
/// does not have it. A pressure between two runs' is interpolated.
inference::Vector values_of(const std::vector<CoveredCondition> &all, const PointRuns &runs,
                            const Shows &see);

/// A derivative of each observable, mean of the base model's points; 0 where it has none.
inference::Vector mean_of_base(const std::vector<CoveredCondition> &all,
                               const std::vector<PointRuns> &points,
                               const std::function<const Derivative &(const Observable &)> &of);

/// Change of each observable by one standard deviation of the press's pressure, mean of the base
/// model's points.
inference::Vector by_pressure(const std::vector<CoveredCondition> &all,
                              const std::vector<PointRuns> &points);

/// Noise in the release of every covered curve of eight rows and more: second differences, less
/// their mean over the bank, squared in the covariance of stated errors and bank. There the part
/// that base parameters and effects move (a linear fit of all points) counts whole, the rest, the
/// packings' scatter, by 1 / `cells`. Not of the loading: small films yield in steps, far from
/// normal (its score had a standard deviation of 2 on 480 curves whose errors were as stated, that
/// of the release 0.99). Rows that the bank's runs do not reach, at the beginning of the release,
/// are left out; a release of which too few are left is reported in `not_said`.
std::vector<inference::PointNoise> point_noise_of(const Experiment &experiment,
                                                  const BankTable &table, double cells,
                                                  std::vector<std::string> &not_said);

} // namespace calendem

#endif
